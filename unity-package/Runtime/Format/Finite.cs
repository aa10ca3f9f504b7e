using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>Whether a tensor's values are finite and within bounds, eight bytes at a step.</summary>
    internal static class Finite
    {
        // An exponent of all ones is an infinity or a NaN: adding its lowest bit to the exponent alone carries into the
        // sign bit then, and only then; the lanes of a word do not touch each other.
        private const ulong Exponents32 = 0x7F8000007F800000, Lowest32 = 0x0080000000800000, Signs32 = 0x8000000080000000;
        private const ulong Exponents16 = 0x7C007C007C007C00, Lowest16 = 0x0400040004000400, Signs16 = 0x8000800080008000;

        // Likewise, what is to be added to a magnitude above Largest, and to no smaller one, to reach the sign bit.
        private const ulong Magnitudes32 = 0x7FFFFFFF7FFFFFFF, Beyond32 = 0x38801FFF38801FFF;

        private const float LargestFactor = float.MaxValue / 128; // times any i8 stays finite

        /// <summary>Of any real: f16's largest, so that what is decoded from a file is finite too.</summary>
        public const float Largest = 65504;

        public static bool All(Tensor tensor)
        {
            switch (tensor.Type)
            {
                case ElementType.F32:
                    return All(tensor.Bytes, Exponents32, Lowest32, Signs32);
                case ElementType.F16:
                    return All(tensor.Bytes, Exponents16, Lowest16, Signs16);
                default:
                    return AllScaled(tensor);
            }
        }

        /// <summary>Whether finite values are at most Largest in magnitude.</summary>
        public static bool Within(Tensor tensor)
        {
            switch (tensor.Type)
            {
                case ElementType.F32:
                    return All(tensor.Bytes, Magnitudes32, Beyond32, Signs32);
                case ElementType.F16:
                    return true;
                default:
                    return WithinScaled(tensor);
            }
        }

        private static bool All(ReadOnlySpan<byte> bytes, ulong exponents, ulong lowest, ulong signs)
        {
            ReadOnlySpan<ulong> words = MemoryMarshal.Cast<byte, ulong>(bytes);
            ulong found = 0;
            for (int i = 0; i < words.Length; i++)
            {
                found |= (words[i] & exponents) + lowest;
            }
            ulong last = 0;
            for (int i = 8 * words.Length; i < bytes.Length; i++)
            {
                last |= (ulong)bytes[i] << 8 * (i % 8);
            }
            found |= (last & exponents) + lowest;
            return (found & signs) == 0;
        }

        private static bool AllScaled(Tensor tensor)
        {
            int row = tensor.Count / tensor.Scale.Length;
            for (int i = 0; i < tensor.Scale.Length; i++)
            {
                float scale = tensor.Scale[i];
                if (float.IsNaN(scale) || float.IsInfinity(scale))
                {
                    return false;
                }
                for (int at = i * row; Math.Abs(scale) > LargestFactor && at < (i + 1) * row; at++)
                {
                    if (float.IsInfinity((float)((sbyte)tensor.Bytes[at] * scale)))
                    {
                        return false;
                    }
                }
            }
            return true;
        }

        private static bool WithinScaled(Tensor tensor)
        {
            int row = tensor.Count / tensor.Scale.Length;
            for (int i = 0; i < tensor.Scale.Length; i++)
            {
                float scale = Math.Abs(tensor.Scale[i]);
                for (int at = i * row; scale > Largest / 128 && at < (i + 1) * row; at++)
                {
                    if (Math.Abs((float)((sbyte)tensor.Bytes[at] * scale)) > Largest)
                    {
                        return false;
                    }
                }
            }
            return true;
        }
    }
}
