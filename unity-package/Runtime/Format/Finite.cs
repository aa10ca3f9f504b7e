using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>Whether a tensor's values are finite and within bounds.</summary>
    internal static class Finite
    {
        // What is to be added to a magnitude above Limits.Largest, to an infinity or a NaN, and to no other number, to reach the sign
        // bit; the numbers of a word do not touch each other.
        private const ulong Magnitudes32 = 0x7FFFFFFF7FFFFFFF, Beyond32 = 0x38801FFF38801FFF;
        private const ulong Magnitudes16 = 0x7FFF7FFF7FFF7FFF, Beyond16 = 0x0400040004000400;

        /// <summary>Whether all values are finite and at most Limits.Largest in magnitude; f32 and f16 eight bytes at a step.</summary>
        public static bool Within(Tensor tensor)
        {
            switch (tensor.Type)
            {
                case ElementType.F32:
                    return Within(tensor.Bytes, Magnitudes32, Beyond32);
                case ElementType.F16:
                    return Within(tensor.Bytes, Magnitudes16, Beyond16);
                default:
                    return WithinScaled(tensor);
            }
        }

        /// <summary>Whether all values and their scales are finite, one by one.</summary>
        public static bool All(Tensor tensor)
        {
            bool isFinite = tensor.Scale == null || Array.TrueForAll(tensor.Scale, IsFinite);
            for (int i = 0; isFinite && i < tensor.Count; i++)
            {
                isFinite = IsFinite(tensor.Read(i));
            }
            return isFinite;
        }

        /// <summary>The largest magnitude of finite values; 0 of none.</summary>
        public static float Magnitude(Tensor tensor)
        {
            if (tensor.Type == ElementType.F16)
            {
                return Half.ToSingle(Largest(tensor.Bytes));
            }
            float largest = 0;
            for (int i = 0; i < tensor.Count; i++)
            {
                largest = Math.Max(largest, Math.Abs(tensor.Read(i)));
            }
            return largest;
        }

        /// <summary>The largest of halves without their signs, four at a step.</summary>
        private static ushort Largest(ReadOnlySpan<byte> halves)
        {
            ulong most = 0;
            foreach (ulong word in MemoryMarshal.Cast<byte, ulong>(halves))
            {
                ulong magnitudes = word & Magnitudes16;
                ulong isMore = ((magnitudes | ~Magnitudes16) - most & ~Magnitudes16) >> 15; // 1 where it is no less
                ulong taken = isMore * 0xFFFF;
                most = magnitudes & taken | most & ~taken;
            }
            int largest = 0;
            for (int part = 0; part < 4; part++)
            {
                largest = Math.Max(largest, (int)(most >> 16 * part & 0x7FFF));
            }
            for (int i = halves.Length / 8 * 8; i < halves.Length; i += 2)
            {
                largest = Math.Max(largest, (halves[i] | halves[i + 1] << 8) & 0x7FFF);
            }
            return (ushort)largest;
        }

        private static bool Within(ReadOnlySpan<byte> bytes, ulong magnitudes, ulong beyond)
        {
            ReadOnlySpan<ulong> words = MemoryMarshal.Cast<byte, ulong>(bytes);
            ulong found = 0;
            for (int i = 0; i < words.Length; i++)
            {
                found |= (words[i] & magnitudes) + beyond;
            }
            ulong last = 0;
            for (int i = 8 * words.Length; i < bytes.Length; i++)
            {
                last |= (ulong)bytes[i] << 8 * (i % 8);
            }
            found |= (last & magnitudes) + beyond;
            return (found & ~magnitudes) == 0;
        }

        private static bool WithinScaled(Tensor tensor)
        {
            int row = tensor.Count / tensor.Scale.Length;
            for (int i = 0; i < tensor.Scale.Length; i++)
            {
                float scale = Math.Abs(tensor.Scale[i]);
                if (!IsFinite(scale))
                {
                    return false;
                }
                for (int at = i * row; scale > Limits.Largest / 128 && at < (i + 1) * row; at++)
                {
                    if (Math.Abs((float)((sbyte)tensor.Bytes[at] * scale)) > Limits.Largest)
                    {
                        return false;
                    }
                }
            }
            return true;
        }

        private static bool IsFinite(float value)
        {
            return !float.IsNaN(value) && !float.IsInfinity(value);
        }
    }
}
