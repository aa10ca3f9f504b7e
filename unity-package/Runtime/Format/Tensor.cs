using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>How a tensor's elements are stored; the values are those of the file.</summary>
    public enum ElementType : byte
    {
        F32,
        F16,
        I8,
        I32,
    }

    /// <summary>How a tensor's bytes stand in the file.</summary>
    internal enum Packing : byte
    {
        Plain,
        Deflate,
        Steps,
    }

    /// <summary>A view of one tensor's bytes, row-major and in its stored type.</summary>
    public sealed class Tensor
    {
        /// <summary>How the elements are stored.</summary>
        public ElementType Type { get; internal set; }

        /// <summary>One to four sides.</summary>
        public int[] Shape { get; internal set; }

        /// <summary>Number of elements.</summary>
        public int Count { get; internal set; }

        /// <summary>What holds the elements: the file, or the bytes that a packed tensor has given.</summary>
        public byte[] Content { get; internal set; }

        /// <summary>First byte of the elements in Content, a multiple of 16.</summary>
        public int Offset { get; internal set; }

        /// <summary>Bytes that the elements fill.</summary>
        public int ByteLength { get; internal set; }

        /// <summary>Scales of I8, one for each of as many equal rows; null for other types.</summary>
        public float[] Scale { get; internal set; }

        /// <summary>A tensor of values that are not in the file.</summary>
        internal static Tensor Of(float[] values, params int[] shape)
        {
            var bytes = new byte[4 * values.Length];
            Buffer.BlockCopy(values, 0, bytes, 0, bytes.Length);
            return new Tensor { Shape = shape, Count = values.Length, Content = bytes, ByteLength = bytes.Length };
        }

        /// <summary>The stored bytes.</summary>
        public ReadOnlySpan<byte> Bytes => new ReadOnlySpan<byte>(Content, Offset, ByteLength);

        /// <summary>The integers of a tensor of type I32.</summary>
        public ReadOnlySpan<int> Integers => MemoryMarshal.Cast<byte, int>(Bytes);

        /// <summary>One element as a float, expanded from f16 or i8.</summary>
        public float Read(int index)
        {
            switch (Type)
            {
                case ElementType.F32:
                    return MemoryMarshal.Cast<byte, float>(Bytes)[index];
                case ElementType.F16:
                    return Half.ToSingle(MemoryMarshal.Cast<byte, ushort>(Bytes)[index]);
                case ElementType.I8:
                    return (sbyte)Bytes[index] * Scale[index / (Count / Scale.Length)];
                default:
                    return Integers[index];
            }
        }

        /// <summary>All elements as floats.</summary>
        public float[] ToFloats()
        {
            if (Type == ElementType.F32)
            {
                return MemoryMarshal.Cast<byte, float>(Bytes).ToArray();
            }
            var values = new float[Count];
            if (Type == ElementType.F16)
            {
                ReadOnlySpan<ushort> halves = MemoryMarshal.Cast<byte, ushort>(Bytes);
                for (int i = 0; i < values.Length; i++)
                {
                    values[i] = Half.ToSingle(halves[i]);
                }
                return values;
            }
            for (int i = 0; i < values.Length; i++)
            {
                values[i] = Read(i);
            }
            return values;
        }
    }
}
