using System;
using Mua.Format;

namespace Mua.SelfTest
{
    /// <summary>What stands in some words of a buffer afterwards; names of fields are those of the file.</summary>
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

        /// <summary>Whether a value is as near as it must be; no number is not.</summary>
        public bool Allows(double found, double wanted)
        {
            return Math.Abs(found - wanted) - absolute - relative * Math.Abs(wanted) <= 0;
        }

        private double Number(uint word)
        {
            return kind == "uint" ? word : BitConverter.ToSingle(BitConverter.GetBytes(word), 0);
        }
    }
}
