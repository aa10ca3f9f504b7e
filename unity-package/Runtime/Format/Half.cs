using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>IEEE 754 half precision.</summary>
    public static class Half
    {
        private const int MantissaBits = 10;
        private const uint ExponentMask = 0x1F;
        private const uint MantissaMask = 0x3FF;
        private const int BiasDifference = 127 - 15;
        private const float SmallestSubnormal = 1f / (1 << 24);
        private const uint LeastNormal = (BiasDifference + 1) << 23; // bits of 2^-14
        private const int DroppedBits = 23 - MantissaBits;
        private const uint StepOfSubnormals = 0x3F000000; // bits of 0.5, whose last bit is a subnormal's

        [StructLayout(LayoutKind.Explicit)]
        private struct Bits
        {
            [FieldOffset(0)] public uint Word;
            [FieldOffset(0)] public float Value;
        }

        /// <summary>The nearest half, ties to even, of a number of at most 65,504 in magnitude.</summary>
        public static ushort FromSingle(float value)
        {
            var bits = new Bits { Value = value };
            uint sign = bits.Word >> 31 << 15;
            bits.Word &= 0x7FFFFFFF;
            if (bits.Word < LeastNormal)
            {
                bits.Value += 0.5f;
                return (ushort)(sign | (bits.Word - StepOfSubnormals));
            }
            uint half = (1u << (DroppedBits - 1)) - 1 + ((bits.Word >> DroppedBits) & 1);
            return (ushort)(sign | (((bits.Word + half) >> DroppedBits) - ((uint)BiasDifference << MantissaBits)));
        }

        /// <summary>The value of half-precision bits, signed zeros, subnormals, infinities and NaNs included.</summary>
        public static float ToSingle(ushort half)
        {
            uint sign = (uint)half >> 15, exponent = ((uint)half >> MantissaBits) & ExponentMask;
            uint mantissa = half & MantissaMask;
            var bits = new Bits();
            if (exponent == 0)
            {
                bits.Value = mantissa * SmallestSubnormal;
                bits.Word |= sign << 31;
                return bits.Value;
            }
            uint widened = exponent == ExponentMask ? 0xFF : exponent + BiasDifference;
            bits.Word = (sign << 31) | (widened << 23) | (mantissa << (23 - MantissaBits));
            return bits.Value;
        }
    }
}
