using System;
using System.IO;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;

namespace Mua.Samples.VrPlayer.Editor
{
    /// <summary>
    /// Writes, before each build, which avatars lie in StreamingAssets: inside an Android package nothing can be listed.
    /// </summary>
    internal sealed class StreamingIndex : IPreprocessBuildWithReport
    {
        public int callbackOrder => 0;

        public void OnPreprocessBuild(BuildReport report)
        {
            Write(Path.Combine(Application.dataPath, "StreamingAssets"));
        }

        /// <summary>Writes the index of a folder, or takes it away where there is nothing to list.</summary>
        internal static void Write(string folder)
        {
            if (!Directory.Exists(folder))
            {
                return;
            }
            string[] paths = Directory.GetFiles(folder, AvatarShelf.Pattern, SearchOption.AllDirectories);
            Array.Sort(paths, string.CompareOrdinal);
            string index = Path.Combine(folder, AvatarShelf.Index);
            if (paths.Length == 0)
            {
                File.Delete(index);
                return;
            }
            string[] lines = Array.ConvertAll(paths, path => path.Substring(folder.Length + 1).Replace('\\', '/'));
            File.WriteAllText(index, string.Join("\n", lines) + "\n");
        }
    }
}
