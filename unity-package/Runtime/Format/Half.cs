using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>IEEE 754 half precision, expanded exactly.</summary>
    public static class Half
    {
        private const int MantissaBits = 10;
        private const uint ExponentMask = 0x1F;
        private const uint MantissaMask = 0x3FF;
        private const int BiasDifference = 127 - 15;
        private const float SmallestSubnormal = 1f / (1 << 24);

        [StructLayout(LayoutKind.Explicit)]
        private struct Bits
        {
            [FieldOffset(0)] public uint Word;
            [FieldOffset(0)] public float Value;
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
