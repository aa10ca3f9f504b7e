using System;
using System.Collections;
using System.IO;
using System.Text;
using UnityEngine;
using UnityEngine.Networking;

namespace Mua.SelfTest
{
    /// <summary>The golden cases of one kernel file (tests/parity/golden/README.md).</summary>
    [Serializable]
    internal sealed class GoldenFile
    {
        /// <summary>Stems of the kernels' files, each of which has golden cases.</summary>
        public static readonly string[] Stems =
        {
            "mlp_matmul", "blend_subbands", "inverse_dwt", "dq_skinning", "expressions", "splat_project", "splat_sort",
        };

        public string kernel = "";
        public GoldenCase[] cases = new GoldenCase[0];

        [NonSerialized] private string stem;

        /// <summary>Bytes that the cases' offsets point into.</summary>
        public byte[] Binary { get; private set; }

        /// <summary>Stem of the kernel's file.</summary>
        public string Stem => stem;

        /// <summary>The content of STEM.json and STEM.bin; InvalidDataException says what is wrong with them.</summary>
        public static GoldenFile Parse(string stem, byte[] text, byte[] binary)
        {
            GoldenFile file;
            try
            {
                file = JsonUtility.FromJson<GoldenFile>(Encoding.UTF8.GetString(text));
            }
            catch (ArgumentException error)
            {
                throw new InvalidDataException(stem + ".json is no JSON: " + error.Message);
            }
            if (file == null || file.kernel != stem + ".compute" || file.cases.Length == 0)
            {
                throw new InvalidDataException(stem + ".json holds no cases of " + stem + ".compute");
            }
            file.stem = stem;
            file.Binary = binary;
            try
            {
                foreach (GoldenCase golden in file.cases)
                {
                    golden.Check(binary.Length);
                }
            }
            catch (InvalidDataException error)
            {
                throw new InvalidDataException(
                    stem + ".json with " + binary.Length + " bytes of .bin: " + error.Message);
            }
            return file;
        }
    }

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
