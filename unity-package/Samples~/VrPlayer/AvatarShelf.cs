using System;
using System.Collections;
using System.Collections.Generic;
using System.IO;
using UnityEngine;
using UnityEngine.Networking;

namespace Mua.Samples.VrPlayer
{
    /// <summary>
    /// The avatars that the player finds: files in the folder of avatars first, then files that came with the app, both by
    /// name, then those of the scene.
    /// </summary>
    internal sealed class AvatarShelf
    {
        public const string Pattern = "*.muaavatar";

        /// <summary>Lists what StreamingAssets holds, one path a line, where a folder cannot be listed.</summary>
        public const string Index = "avatars.txt";

        private readonly List<AvatarEntry> entries = new List<AvatarEntry>();

        /// <summary>Where a user puts avatars.</summary>
        public static string Folder => Path.Combine(Application.persistentDataPath, "avatars");

        public int Count => entries.Count;

        /// <summary>Index of the avatar that is shown.</summary>
        public int Position { get; private set; }

        /// <summary>The avatar that is shown, or null while there is none.</summary>
        public AvatarEntry Current => entries.Count == 0 ? null : entries[Position];

        /// <summary>Looks everywhere; a coroutine, since inside an Android package a file has to be asked for.</summary>
        public IEnumerator Fill(AvatarAsset[] assets)
        {
            entries.Clear();
            Position = 0;
            Directory.CreateDirectory(Folder); // for people who look for it
            AddFolder(Folder, SearchOption.TopDirectoryOnly);
            string streaming = Application.streamingAssetsPath;
            if (streaming.Contains("://"))
            {
                using (UnityWebRequest request = UnityWebRequest.Get(streaming + "/" + Index))
                {
                    yield return request.SendWebRequest();
                    if (request.result == UnityWebRequest.Result.Success)
                    {
                        AddLines(streaming, System.Text.Encoding.UTF8.GetString(request.downloadHandler.data));
                    }
                }
            }
            else
            {
                AddFolder(streaming, SearchOption.AllDirectories);
            }
            AddAssets(assets);
        }

        /// <summary>Moves on by 1 or -1, round the ends, past avatars that cannot be shown.</summary>
        public void Step(int by)
        {
            for (int i = 0; i < entries.Count; i++)
            {
                Position = (Position + by + entries.Count) % entries.Count;
                if (!Current.HasFailed)
                {
                    return;
                }
            }
        }

        /// <summary>Moves to the avatar with this name; returns whether there is one.</summary>
        public bool Find(string name)
        {
            int found = entries.FindIndex(entry => entry.Name == name);
            Position = found < 0 ? Position : found;
            return found >= 0;
        }

        /// <summary>Marks the present avatar as failed and moves on; returns whether another one is left.</summary>
        public bool Skip()
        {
            Current.HasFailed = true;
            Step(1);
            return !Current.HasFailed;
        }

        private void AddFolder(string folder, SearchOption option)
        {
            if (!Directory.Exists(folder))
            {
                return;
            }
            string[] paths = Directory.GetFiles(folder, Pattern, option);
            Array.Sort(paths, string.CompareOrdinal);
            foreach (string path in paths)
            {
                entries.Add(new AvatarEntry { Name = Path.GetFileNameWithoutExtension(path), Path = path });
            }
        }

        private void AddLines(string folder, string lines)
        {
            foreach (string line in lines.Split('\n'))
            {
                string path = line.Trim();
                if (path.Length > 0)
                {
                    string name = Path.GetFileNameWithoutExtension(path);
                    entries.Add(new AvatarEntry { Name = name, Path = folder + "/" + path });
                }
            }
        }

        private void AddAssets(AvatarAsset[] assets)
        {
            foreach (AvatarAsset asset in assets)
            {
                if (asset != null)
                {
                    entries.Add(new AvatarEntry { Name = asset.name, Asset = asset });
                }
            }
        }
    }

    /// <summary>An avatar that can be shown.</summary>
    internal sealed class AvatarEntry
    {
        public string Name { get; set; }

        /// <summary>Path of the avatar's file; null where Asset is set.</summary>
        public string Path { get; set; }

        /// <summary>An imported avatar; null where Path is set.</summary>
        public AvatarAsset Asset { get; set; }

        /// <summary>Whether it was tried and cannot be shown.</summary>
        public bool HasFailed { get; set; }
    }
}
