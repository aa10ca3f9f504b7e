using System;
using System.Runtime.InteropServices;
using System.Threading;

namespace Mua.Format
{
    /// <summary>
    /// Halves from the steps that a packed tensor holds: small whole numbers, 0, -1, 1, -2, 2 as 0, 1, 2, 3, 4, in a plane of their
    /// low bytes and one of their high bytes, times a power of two for each row. Reference: python/mua/asset/packing.py.
    /// </summary>
    internal sealed class Steps
    {
        private const int Bytes = 1 << 8; // numbers of one byte
        private const int Numbers = 1 << 16;

        private readonly ushort[][] halves = new ushort[25][]; // of the first numbers, or of all, by how often 1 is halved

        [StructLayout(LayoutKind.Explicit)]
        private struct Bits
        {
            [FieldOffset(0)] public float Value;
            [FieldOffset(0)] public uint Word;
        }

        /// <summary>Whether rows may have such a scale: a power of two from 2^-24 to 1.</summary>
        public static bool IsScale(float scale)
        {
            var bits = new Bits { Value = scale };
            return scale >= Limits.LeastStep && scale <= Limits.LargestStep && (bits.Word & 0x7FFFFF) == 0;
        }

        /// <summary>Writes the halves of two planes, one row for each scale.</summary>
        public void Expand(byte[] planes, ReadOnlySpan<float> scales, byte[] data)
        {
            Span<ushort> found = MemoryMarshal.Cast<byte, ushort>(data);
            var low = new ReadOnlySpan<byte>(planes, 0, found.Length);
            var high = new ReadOnlySpan<byte>(planes, found.Length, found.Length);
            int row = found.Length / scales.Length;
            for (int i = 0; i < scales.Length; i++)
            {
                Expand(low.Slice(i * row, row), high.Slice(i * row, row), scales[i], found.Slice(i * row, row));
            }
        }

        /// <summary>One row; what is known of a scale is made where the row has as many numbers as that.</summary>
        private void Expand(ReadOnlySpan<byte> low, ReadOnlySpan<byte> high, float scale, Span<ushort> found)
        {
            int numbers = IsZero(high) ? Bytes : Numbers, halvings = 127 - (int)(new Bits { Value = scale }.Word >> 23);
            ushort[] known = Volatile.Read(ref halves[halvings]);
            if ((known?.Length ?? 0) < numbers && (numbers == Bytes || found.Length >= numbers))
            {
                known = Known(scale, numbers);
                Volatile.Write(ref halves[halvings], known); // other threads may make the same
            }
            if ((known?.Length ?? 0) >= numbers)
            {
                Expand(low, high, known, found);
                return;
            }
            for (int at = 0; at < found.Length; at++)
            {
                found[at] = HalfOf(low[at] | high[at] << 8, scale);
            }
        }

        private static bool IsZero(ReadOnlySpan<byte> bytes)
        {
            foreach (byte one in bytes)
            {
                if (one != 0)
                {
                    return false;
                }
            }
            return true;
        }

        /// <summary>One row, four numbers at a step.</summary>
        private static void Expand(ReadOnlySpan<byte> low, ReadOnlySpan<byte> high, ushort[] known, Span<ushort> found)
        {
            ReadOnlySpan<uint> lows = MemoryMarshal.Cast<byte, uint>(low), highs = MemoryMarshal.Cast<byte, uint>(high);
            Span<ulong> words = MemoryMarshal.Cast<ushort, ulong>(found);
            for (int i = 0; i < words.Length; i++)
            {
                uint l = lows[i], h = highs[i];
                words[i] = (l | h) == 0 ? 0 : known[l & 0xFF | (h & 0xFF) << 8]
                    | (ulong)known[l >> 8 & 0xFF | h & 0xFF00] << 16
                    | (ulong)known[l >> 16 & 0xFF | h >> 8 & 0xFF00] << 32 | (ulong)known[l >> 24 | h >> 16 & 0xFF00] << 48;
            }
            for (int at = 4 * words.Length; at < found.Length; at++)
            {
                found[at] = known[low[at] | high[at] << 8];
            }
        }

        private static ushort[] Known(float scale, int numbers)
        {
            var known = new ushort[numbers];
            for (int number = 0; number < numbers; number++)
            {
                known[number] = HalfOf(number, scale);
            }
            return known;
        }

        private static ushort HalfOf(int number, float scale)
        {
            return Half.FromSingle((number % 2 == 0 ? number / 2 : -(number / 2) - 1) * scale);
        }
    }
}
