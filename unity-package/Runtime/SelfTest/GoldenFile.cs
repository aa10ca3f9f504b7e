using System;
using System.IO;
using System.Text;
using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>The golden cases of one kernel file (tests/parity/golden/README.md).</summary>
    [Serializable]
    internal sealed class GoldenFile
    {
        /// <summary>Stems of the kernels' files, each of which has golden cases.</summary>
        public static readonly string[] Stems =
        {
            "mlp_matmul", "blend_subbands", "inverse_dwt", "dq_skinning", "splat_project", "splat_sort",
        };

        public string kernel = "";
        public GoldenCase[] cases = new GoldenCase[0];

        [NonSerialized] private string stem;

        /// <summary>Bytes that the cases' offsets point into.</summary>
        public byte[] Binary { get; private set; }

        /// <summary>Of the kernel's file.</summary>
        public string Stem => stem;

        /// <summary>What STEM.json and STEM.bin hold; InvalidDataException says what is wrong with them.</summary>
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
}
