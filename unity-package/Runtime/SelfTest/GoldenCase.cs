using System;
using System.IO;
using System.Text;
using Mua.Format;

namespace Mua.SelfTest
{
    /// <summary>A constant of a golden case; names of fields are those of the file.</summary>
    [Serializable]
    internal sealed class GoldenConstant
    {
        public string name = "";
        public string scalar = "";
        public int[] shape = new int[0];
        public double[] values = new double[0];

        /// <summary>Whether SelfTest can set it.</summary>
        public bool IsKnown()
        {
            switch (scalar + " " + shape.Length)
            {
                case "uint 0":
                case "float 0":
                    return values.Length == 1;
                case "uint 1":
                case "float 1":
                    return values.Length == shape[0] && shape[0] >= 2 && shape[0] <= 4;
                case "float 3":
                    return shape[1] == 4 && shape[2] == 4 && values.Length > 0 && values.Length == shape[0] * 16L;
                default:
                    return false;
            }
        }
    }

    /// <summary>The content of a buffer before the dispatch; names of fields are those of the file.</summary>
    [Serializable]
    internal sealed class GoldenBuffer
    {
        public string name = "";
        public string element = "";
        public int count = 0;
        public int offset = 0;

        /// <summary>Words (4 bytes) of one element; 0 for an unknown type.</summary>
        public int Words
        {
            get
            {
                switch (element)
                {
                    case "uint":
                    case "float":
                        return 1;
                    case "uint2":
                    case "float2":
                        return 2;
                    case "uint4":
                    case "float4":
                        return 4;
                    default:
                        return 0;
                }
            }
        }
    }

    /// <summary>
    /// The expected content of some words of a buffer after the dispatch; names of fields are those of the file.
    /// </summary>
    [Serializable]
    internal sealed class GoldenExpected
    {
        public string buffer = "";
        public string kind = "";
        public int first = 0;
        public int length = 0;
        public int period = 0;
        public int count = 0;
        public int offset = 0;
        public double absolute = 0;
        public double relative = 0;

        /// <summary>Values in a word; 0 where the kind is not known.</summary>
        public int PerWord => kind == "half" ? 2 : kind == "uint" || kind == "float" ? 1 : 0;

        /// <summary>Index of the buffer's word in which a value lies.</summary>
        public long Word(int value)
        {
            long word = value / PerWord;
            return first + word / length * period + word % length;
        }

        /// <summary>The value that stands in its word of a buffer.</summary>
        public double Found(uint[] words, int value)
        {
            uint word = words[Word(value)];
            if (kind == "half")
            {
                return Half.ToSingle((ushort)(word >> (16 * (value % 2))));
            }
            return Number(word);
        }

        /// <summary>A value of the file, which holds no halves.</summary>
        public double Wanted(byte[] binary, int value)
        {
            return Number(BitConverter.ToUInt32(binary, offset + sizeof(uint) * value));
        }

        /// <summary>Whether a value is within its tolerance; NaN never is.</summary>
        public bool Allows(double found, double wanted)
        {
            return Math.Abs(found - wanted) - absolute - relative * Math.Abs(wanted) <= 0;
        }

        private double Number(uint word)
        {
            return kind == "uint" ? word : BitConverter.ToSingle(BitConverter.GetBytes(word), 0);
        }
    }

    /// <summary>One dispatch and its expected results; names of fields are those of the file.</summary>
    [Serializable]
    internal sealed class GoldenCase
    {
        private const int MostGroups = 65535;

        public string name = "";
        public string entry = "";
        public int[] groups = new int[0];
        public GoldenConstant[] constants = new GoldenConstant[0];
        public GoldenBuffer[] buffers = new GoldenBuffer[0];
        public GoldenExpected[] expected = new GoldenExpected[0];

        /// <summary>Entry point and name as one word, for the log.</summary>
        public string Word
        {
            get
            {
                var word = new StringBuilder(entry);
                bool wasLetter = false;
                foreach (char letter in name)
                {
                    bool isLetter = char.IsLetterOrDigit(letter) || letter == '.';
                    if (isLetter && !wasLetter)
                    {
                        word.Append('-');
                    }
                    if (isLetter)
                    {
                        word.Append(letter);
                    }
                    wasLetter = isLetter;
                }
                return word.ToString();
            }
        }

        /// <summary>Index in `buffers`; -1 where no buffer has the name.</summary>
        public int IndexOf(string buffer)
        {
            return Array.FindIndex(buffers, found => found.name == buffer);
        }

        /// <summary>
        /// Throws InvalidDataException unless the case can run and everything that it names lies within `size` bytes.
        /// </summary>
        public void Check(int size)
        {
            Require(entry.Length > 0 && char.IsLetter(entry[0]), "entry");
            Require(groups.Length == 3 && Array.TrueForAll(groups, n => n > 0 && n <= MostGroups), "groups");
            foreach (GoldenConstant constant in constants)
            {
                Require(constant.IsKnown(), "constant " + constant.name);
            }
            foreach (GoldenBuffer buffer in buffers)
            {
                long words = (long)buffer.count * buffer.Words;
                Require(words > 0 && Holds(size, buffer.offset, words), "buffer " + buffer.name);
            }
            Require(expected.Length > 0, "expected");
            foreach (GoldenExpected part in expected)
            {
                Require(IsReadable(part, size), "expected " + part.buffer);
            }
        }

        private bool IsReadable(GoldenExpected part, int size)
        {
            int held = IndexOf(part.buffer);
            return held >= 0 && part.PerWord > 0 && part.first >= 0 && part.length > 0 && part.period >= part.length
                && part.count > 0 && part.count % part.PerWord == 0 && Holds(size, part.offset, part.count)
                && part.Word(part.count - 1) < (long)buffers[held].count * buffers[held].Words
                && part.absolute >= 0 && part.relative >= 0;
        }

        private static bool Holds(int size, int offset, long words)
        {
            return offset >= 0 && offset % sizeof(uint) == 0 && offset + sizeof(uint) * words <= size;
        }

        private void Require(bool isRight, string what)
        {
            if (!isRight)
            {
                throw new InvalidDataException(
                    "case " + Word + ": its " + what + " is not as tests/parity/golden/README.md says");
            }
        }
    }
}
