using System;
using System.IO;
using System.Text;

namespace Mua.SelfTest
{
    /// <summary>One dispatch and what it must leave behind; names of fields are those of the file.</summary>
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

        /// <summary>InvalidDataException unless the case can run and all it speaks of lies in `size` bytes.</summary>
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
