using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>Makes tensors of parsed tables and checks them, as python/mua/asset/tensors.py does.</summary>
    internal sealed class Tensors
    {
        /// <summary>A side of any length.</summary>
        public const long Any = -1;

        private readonly byte[] content;

        public Tensors(byte[] content)
        {
            this.content = content;
        }

        /// <summary>Integers of `shape` within low &lt;= i &lt; high.</summary>
        public Tensor Indices(Table table, string path, long low, long high, params long[] shape)
        {
            Tensor tensor = Stored(table, path);
            RequireShape(tensor, path, shape);
            if (tensor.Type != ElementType.I32)
            {
                throw Fault("type", path, "element type " + tensor.Type + ", expected I32");
            }
            foreach (int index in tensor.Integers)
            {
                if (index < low || index >= high)
                {
                    throw Fault("range", path, "index " + index + " lies outside " + low + " to " + (high - 1));
                }
            }
            return tensor;
        }

        /// <summary>Finite reals of `shape` within Limits.Largest, stored as f32, f16 or i8.</summary>
        public Tensor Reals(Table table, string path, params long[] shape)
        {
            Tensor tensor = Stored(table, path);
            RequireShape(tensor, path, shape);
            if (tensor.Type == ElementType.I32)
            {
                throw Fault("type", path, "element type I32, expected F32, F16 or I8");
            }
            if (Finite.Within(tensor))
            {
                return tensor;
            }
            throw Finite.All(tensor)
                ? Fault("value", path, "a value lies outside -" + Limits.Largest + " to " + Limits.Largest)
                : Fault("finite", path, "a value is not finite");
        }

        /// <summary>Refuses a tensor without a component or rank along a side.</summary>
        public static void RequireSome(Tensor tensor, int side, string path)
        {
            if (tensor.Shape[side] == 0)
            {
                throw Fault("shape", path + ".shape", "side " + side + " is 0, expected 1 or more");
            }
        }

        /// <summary>A tensor whose shape, bytes and scales agree.</summary>
        private Tensor Stored(Table table, string path)
        {
            Block data = table.Block("data"), scale = table.Block("scale");
            var type = (ElementType)table.Number("type");
            int[] shape = Sides(table, path);
            int count = 1;
            foreach (int side in shape)
            {
                count *= side;
            }
            if ((long)count * Width(type) != data.Count)
            {
                throw Fault("shape", path + ".data", data.Count + " bytes do not fill " + type + Describe(shape));
            }
            int rows = scale == null ? 0 : scale.Count;
            if ((type == ElementType.I8) != (rows > 0) || (rows > 0 && count % rows != 0))
            {
                throw Unfit(rows, type, shape, path);
            }
            return new Tensor
            {
                Type = type, Shape = shape, Count = count, Content = data.Content ?? content, Offset = data.Offset,
                ByteLength = data.Count,
                Scale = rows == 0 ? null : View<float>(scale.Offset, 4 * rows).ToArray(),
            };
        }

        /// <summary>The fault of a tensor of another number of scales than it has equal rows.</summary>
        public static AvatarFormatException Unfit(int rows, ElementType type, int[] shape, string path)
        {
            return Fault("shape", path + ".scale", rows + " scales do not fit " + type + Describe(shape));
        }

        /// <summary>The sides of a shape that a file could hold: an empty tensor's sides are bounded, too.</summary>
        public int[] Sides(Table table, string path)
        {
            Block sides = table.Block("shape");
            if (sides.Count < 1 || sides.Count > Limits.MaxRank)
            {
                throw Fault("shape", path + ".shape", sides.Count + " dimensions, expected 1 to " + Limits.MaxRank);
            }
            ReadOnlySpan<uint> stored = View<uint>(sides.Offset, 4 * sides.Count);
            var shape = new int[stored.Length];
            long product = 1;
            for (int i = 0; i < shape.Length; i++)
            {
                product *= Math.Max(stored[i], 1);
                if (product > int.MaxValue)
                {
                    throw Fault("shape", path + ".shape", "the sides multiply to more than a file can hold");
                }
                shape[i] = (int)stored[i];
            }
            return shape;
        }

        public ReadOnlySpan<T> View<T>(int offset, int length) where T : struct
        {
            return MemoryMarshal.Cast<byte, T>(new ReadOnlySpan<byte>(content, offset, length));
        }

        private static void RequireShape(Tensor tensor, string path, long[] expected)
        {
            bool fits = tensor.Shape.Length == expected.Length;
            for (int i = 0; fits && i < expected.Length; i++)
            {
                fits = expected[i] == Any || expected[i] == tensor.Shape[i];
            }
            if (!fits)
            {
                string wanted = string.Join(", ", expected).Replace("-1", "any");
                throw Fault("shape", path + ".shape", Describe(tensor.Shape).Trim() + ", expected [" + wanted + "]");
            }
        }

        public static int Width(ElementType type)
        {
            return type == ElementType.I8 ? 1 : type == ElementType.F16 ? 2 : 4;
        }

        private static string Describe(int[] shape)
        {
            return " [" + string.Join(", ", shape) + "]";
        }

        private static AvatarFormatException Fault(string code, string field, string sentence)
        {
            return new AvatarFormatException(code, field, sentence);
        }
    }
}
