using System;
using System.Collections.Generic;
using System.IO;
using System.IO.Compression;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;

namespace Mua.Format
{
    /// <summary>
    /// Unpacks the packed tensors of a parsed tree in place, as python/mua/asset/packing.py does: what a tensor gives is
    /// known from its shape, and refused before anything is allocated for it. Each is a stream of its own, so that several
    /// threads unpack a large file; the fault of a bad one is that of its first tensor in the schema's order.
    /// </summary>
    internal sealed class Unpacking
    {
        private const int MostThreads = 4; // each keeps planes of the largest tensor that it has met
        private const long Alone = 1 << 20; // bytes that one thread unpacks before another has begun

        private readonly byte[] content;
        private readonly Tensors tensors;
        private readonly Steps steps = new Steps();
        private readonly List<Packed> found = new List<Packed>();
        private long claimed;
        private int taken; // of the tensors, largest first
        private int faulty = int.MaxValue; // the first tensor found to be bad
        private ExceptionDispatchInfo fault;

        private struct Packed
        {
            public Table Tensor;
            public string Path;
            public int Place; // in the schema's order
        }

        /// <summary>Bytes that all packed tensors may give.</summary>
        private long Most => (long)Limits.UnpackedTimes * content.Length + Limits.UnpackedRoom;

        private Unpacking(byte[] content)
        {
            this.content = content;
            tensors = new Tensors(content);
        }

        public static void Of(Table tree, byte[] content)
        {
            var unpacking = new Unpacking(content);
            Walk(tree, "", unpacking.Claim);
            unpacking.UnpackAll();
        }

        public static bool IsPacked(Table tree)
        {
            bool found = false;
            Walk(tree, "", (tensor, path) => found = true);
            return found;
        }

        /// <summary>Visits every packed tensor below a table, in the schema's order.</summary>
        private static void Walk(Table table, string path, Action<Table, string> visit)
        {
            if (table.Is(Layouts.Tensor))
            {
                if ((Packing)table.Number("packing") != Packing.Plain)
                {
                    visit(table, path);
                }
                return;
            }
            foreach (Field field in table.Fields)
            {
                string name = path.Length == 0 ? field.Name : path + "." + field.Name;
                if (field.Kind == Kind.Table && !field.Vector && table.Child(field.Name) != null)
                {
                    Walk(table.Child(field.Name), name, visit);
                }
                if (field.Kind == Kind.Table && field.Vector && table.Children(field.Name) != null)
                {
                    Table[] children = table.Children(field.Name);
                    for (int i = 0; i < children.Length; i++)
                    {
                        Walk(children[i], name + "[" + i + "]", visit);
                    }
                }
            }
        }

        private void Claim(Table tensor, string path)
        {
            claimed += Claimed(tensor, path);
            if (claimed > Most)
            {
                throw Refusal.Of(
                    path + ".data", "the file's packed tensors claim more than {0} bytes, too many for {1} bytes",
                    Most, content.Length);
            }
            found.Add(new Packed { Tensor = tensor, Path = path, Place = found.Count });
        }

        private void UnpackAll()
        {
            int threads = claimed < Alone ? 1 : Math.Min(Math.Min(Environment.ProcessorCount, MostThreads), found.Count);
            found.Sort((one, other) => other.Tensor.Block("data").Count.CompareTo(one.Tensor.Block("data").Count));
            if (threads > 1)
            {
                Parallel.For(0, threads, thread => UnpackOthers());
            }
            else
            {
                UnpackOthers();
            }
            fault?.Throw();
        }

        /// <summary>Unpacks what no other thread has taken; after a fault only tensors before that one.</summary>
        private void UnpackOthers()
        {
            byte[] planes = new byte[0];
            for (int i = Interlocked.Increment(ref taken) - 1; i < found.Count; i = Interlocked.Increment(ref taken) - 1)
            {
                Packed packed = found[i];
                if (packed.Place > Volatile.Read(ref faulty))
                {
                    continue;
                }
                try
                {
                    Unpack(packed.Tensor, packed.Path, ref planes);
                }
                catch (Exception error)
                {
                    Keep(packed.Place, error);
                }
            }
        }

        private void Keep(int place, Exception error)
        {
            lock (found)
            {
                if (place < faulty)
                {
                    faulty = place;
                    fault = ExceptionDispatchInfo.Capture(error);
                }
            }
        }

        /// <summary>Bytes of the elements, by the shape.</summary>
        private long Claimed(Table tensor, string path)
        {
            long count = Tensors.Width((ElementType)tensor.Number("type"));
            foreach (int side in tensors.Sides(tensor, path))
            {
                count *= side;
            }
            return count;
        }

        private void Unpack(Table tensor, string path, ref byte[] planes)
        {
            bool inSteps = (Packing)tensor.Number("packing") == Packing.Steps;
            ReadOnlySpan<float> scales = inSteps ? Scales(tensor, path) : default(ReadOnlySpan<float>);
            int width = Tensors.Width((ElementType)tensor.Number("type"));
            var data = new byte[Claimed(tensor, path)];
            byte[] inflated = width == 1 ? data : Planes(ref planes, data.Length);
            Inflate(tensor.Block("data"), inflated, data.Length, path);
            if (inSteps)
            {
                steps.Expand(inflated, scales, data);
                tensor.Replace("scale", null);
            }
            else if (width > 1)
            {
                Interleave(inflated, data, width);
            }
            tensor.Replace("data", new Block { Content = data, Offset = 0, Count = data.Length });
        }

        /// <summary>Of halves that are packed as steps: powers of two, one for each of as many equal rows.</summary>
        private ReadOnlySpan<float> Scales(Table tensor, string path)
        {
            var type = (ElementType)tensor.Number("type");
            if (type != ElementType.F16)
            {
                throw new AvatarFormatException(
                    "type", path, "element type " + type + ", expected F16 of what is packed as steps");
            }
            Block scale = tensor.Block("scale");
            int rows = scale == null ? 0 : scale.Count;
            if (rows == 0 || Claimed(tensor, path) / 2 % rows != 0)
            {
                throw Tensors.Unfit(rows, type, tensors.Sides(tensor, path), path);
            }
            ReadOnlySpan<float> scales = tensors.View<float>(scale.Offset, 4 * rows);
            foreach (float one in scales)
            {
                if (!Steps.IsScale(one))
                {
                    throw Refusal.Of(path + ".scale", "{0:g6}, expected a power of two from 2^-24 to 1", one);
                }
            }
            return scales;
        }

        /// <summary>Room for planes, which the tensors of a thread use one after the other.</summary>
        private static byte[] Planes(ref byte[] planes, int count)
        {
            if (planes.Length < count)
            {
                planes = new byte[count];
            }
            return planes;
        }

        /// <summary>The `count` bytes of a stream, and not one more.</summary>
        private void Inflate(Block packed, byte[] inflated, int count, string path)
        {
            if (count == 0)
            {
                return; // not every language can distinguish a damaged empty stream from a sound one
            }
            int found = 0;
            bool ends;
            var source = new StreamSource(content, packed.Offset, packed.Count);
            try
            {
                using (var stream = new DeflateStream(source, CompressionMode.Decompress))
                {
                    int read = count;
                    while (found < count && read > 0)
                    {
                        read = stream.Read(inflated, found, count - found);
                        found += read;
                    }
                    ends = found < count || stream.ReadByte() < 0;
                }
            }
            catch (Exception error) when (error is IOException || error is InvalidDataException)
            {
                throw Fault(path, "the bytes are no deflate stream: the file is damaged");
            }
            if (found < count || !ends)
            {
                string given = ends ? found.ToString() : "more than " + count;
                throw Fault(path, "the stream gives " + given + " bytes, expected " + count);
            }
            if (!source.IsUsedUp)
            {
                throw Fault(path, "the stream does not end with its bytes: the file is damaged");
            }
        }

        /// <summary>Elements of two or four bytes from planes of their first bytes, their second ones and so on.</summary>
        private static void Interleave(byte[] planes, byte[] data, int width)
        {
            if (width == 2)
            {
                Span<ushort> halves = MemoryMarshal.Cast<byte, ushort>(data);
                for (int i = 0, second = halves.Length; i < halves.Length; i++, second++)
                {
                    halves[i] = (ushort)(planes[i] | planes[second] << 8);
                }
                return;
            }
            Span<uint> words = MemoryMarshal.Cast<byte, uint>(data);
            int count = words.Length;
            for (int i = 0; i < count; i++)
            {
                words[i] = planes[i] | (uint)planes[i + count] << 8 | (uint)planes[i + 2 * count] << 16
                    | (uint)planes[i + 3 * count] << 24;
            }
        }

        private static AvatarFormatException Fault(string path, string sentence)
        {
            return new AvatarFormatException("packed", path + ".data", sentence);
        }
    }
}
