using System;
using System.Collections;
using System.IO;
using UnityEngine.Networking;

namespace Mua.SelfTest
{
    /// <summary>Reads the golden files of a folder, or of one inside an Android package, whose path is a URL.</summary>
    internal sealed class GoldenReader
    {
        private readonly string folder;

        public GoldenReader(string folder)
        {
            this.folder = folder;
        }

        /// <summary>What the last Read found; null where Problem says why.</summary>
        public GoldenFile File { get; private set; }

        public string Problem { get; private set; }

        /// <summary>A coroutine.</summary>
        public IEnumerator Read(string stem)
        {
            File = null;
            Problem = null;
            byte[][] contents = new byte[2][];
            for (int i = 0; i < contents.Length; i++)
            {
                string path = folder + "/" + stem + (i == 0 ? ".json" : ".bin");
                if (!path.Contains("://"))
                {
                    contents[i] = ReadFile(path);
                    continue;
                }
                using (UnityWebRequest request = UnityWebRequest.Get(path))
                {
                    request.SendWebRequest();
                    while (!request.isDone)
                    {
                        yield return null;
                    }
                    contents[i] = Finished(request, path);
                }
            }
            if (Problem == null)
            {
                Parse(stem, contents);
            }
        }

        private byte[] ReadFile(string path)
        {
            try
            {
                return System.IO.File.ReadAllBytes(path);
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                Problem = Problem ?? error.Message;
                return null;
            }
        }

        private byte[] Finished(UnityWebRequest request, string path)
        {
            if (request.result == UnityWebRequest.Result.Success && request.downloadHandler.data != null)
            {
                return request.downloadHandler.data;
            }
            Problem = Problem ?? path + ": " + request.error;
            return null;
        }

        private void Parse(string stem, byte[][] contents)
        {
            try
            {
                File = GoldenFile.Parse(stem, contents[0], contents[1]);
            }
            catch (InvalidDataException error)
            {
                Problem = error.Message;
            }
        }
    }
}
