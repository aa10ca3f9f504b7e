using System;
using UnityEngine;

namespace Mua
{
    /// <summary>Constant data on its way to a buffer, a chunk at a time; it is made on any thread, uploaded on Unity's.</summary>
    internal sealed class Upload
    {
        private const int StagingWords = 1 << 16;
        private const int WordBytes = 4;

        private static readonly uint[] Staging = new uint[StagingWords]; // of Unity's thread

        private readonly string field;
        private readonly int stride;
        private readonly Array elements; // of the type that the kernels read; null where the file's own bytes will do
        private readonly ArraySegment<byte> stored;
        private readonly float[] scales;
        private int done; // elements

        /// <summary>Elements as the kernels read them, `stride` bytes each.</summary>
        public Upload(string field, Array elements, int stride)
        {
            this.field = field;
            this.elements = elements;
            this.stride = stride;
            Count = elements.Length;
        }

        /// <summary>Bytes of a file as words, then the scales as words.</summary>
        public Upload(string field, ArraySegment<byte> stored, float[] scales)
        {
            this.field = field;
            this.stored = stored;
            this.scales = scales;
            stride = WordBytes;
            Count = StoredWords + (scales == null ? 0 : scales.Length);
        }

        /// <summary>Filled once Continue has returned true.</summary>
        public GraphicsBuffer Buffer { get; private set; }

        public int Count { get; }

        public long Bytes => (long)Count * stride;

        /// <summary>Words that the stored bytes fill; the scales follow them.</summary>
        public int StoredWords => (stored.Count + WordBytes - 1) / WordBytes;

        /// <summary>Uploads up to `budget` bytes and takes them off; whether all is there.</summary>
        public bool Continue(BufferSet buffers, ref int budget)
        {
            if (Buffer == null)
            {
                Buffer = buffers.Structured(field, Count, stride);
            }
            while (done < Count && budget > 0)
            {
                int most = Math.Max(budget / stride, 1);
                int sent = elements != null ? SendElements(most) : done < StoredWords ? SendWords(most) : SendScales(most);
                done += sent;
                budget -= sent * stride;
            }
            return done == Count;
        }

        private int SendElements(int most)
        {
            int count = Math.Min(most, Count - done);
            Buffer.SetData(elements, done, done, count);
            return count;
        }

        private int SendWords(int most)
        {
            int count = Math.Min(Math.Min(most, StagingWords), StoredWords - done), first = WordBytes * done;
            Staging[count - 1] = 0; // the last word may be filled in part
            int bytes = Math.Min(WordBytes * count, stored.Count - first);
            System.Buffer.BlockCopy(stored.Array, stored.Offset + first, Staging, 0, bytes);
            Buffer.SetData(Staging, 0, done, count);
            return count;
        }

        private int SendScales(int most)
        {
            int first = done - StoredWords, count = Math.Min(most, scales.Length - first);
            Buffer.SetData(scales, first, done, count);
            return count;
        }
    }
}
