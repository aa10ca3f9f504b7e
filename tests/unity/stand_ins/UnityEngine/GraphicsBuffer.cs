// Stand-in. Source: Unity 6000.0, GraphicsBuffer.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    public sealed class GraphicsBuffer : IDisposable
    {
        [Flags]
        public enum Target
        {
            Vertex = 1, Index = 2, CopySource = 4, CopyDestination = 8, Structured = 16, Raw = 32, Append = 64, Counter = 128,
            IndirectArguments = 256, Constant = 512
        }

        [Flags]
        public enum UsageFlags { None = 0, LockBufferForWrite = 1 }

        private const Target Computed = Target.Structured | Target.Raw | Target.Append | Target.Counter | Target.IndirectArguments;
        private const Target AnyStride = Target.Vertex | Target.Index | Target.CopySource | Target.CopyDestination;
        private static int lastId;
        internal readonly int Id = ++lastId;
        private bool released;

        public GraphicsBuffer(Target target, int count, int stride) : this(target, UsageFlags.None, count, stride) { }
        public GraphicsBuffer(Target target, UsageFlags usageFlags, int count, int stride)
        {
            if ((target & Computed) != 0 && !SystemInfo.supportsComputeShaders)
                throw new ArgumentException("Attempting to create a GraphicsBuffer of a compute target when compute shaders are not supported");
            if (count <= 0)
                throw new ArgumentException("Attempting to create a zero length graphics buffer", "count");
            if (stride <= 0)
                throw new ArgumentException("Attempting to create a graphics buffer with a negative or null stride", "stride");
            if ((target & Target.Index) != 0 && stride != 2 && stride != 4)
                throw new ArgumentException("Attempting to create an index buffer with an invalid stride: " + stride, "stride");
            if (stride % 4 != 0 && (target & ~AnyStride) != 0)
                throw new ArgumentException("Stride must be a multiple of 4 unless the buffer is only used as a vertex buffer and/or index buffer", "stride");
            if ((long)count * stride > SystemInfo.maxGraphicsBufferSize)
                throw new ArgumentException("The total size of the graphics buffer (" + (long)count * stride + " bytes) exceeds the maximum buffer size. Maximum supported buffer size: " + SystemInfo.maxGraphicsBufferSize + " bytes.");
            if ((usageFlags & UsageFlags.LockBufferForWrite) != 0 && (target & Target.CopyDestination) != 0)
                throw new ArgumentException("LockBufferForWrite cannot be combined with CopyDestination");
            this.target = target;
            this.count = count;
            this.stride = stride;
            this.usageFlags = usageFlags;
            StandIns.Recorder.Created(this);
        }

        public int count { get; private set; }
        public int stride { get; private set; }
        public Target target { get; private set; }
        public UsageFlags usageFlags { get; private set; }
        public string name { set { StandIns.Recorder.Named(this, value); } }

        public bool IsValid() { return !released; }
        public void Release() { Dispose(); }
        public void Dispose()
        {
            if (released)
                return;
            released = true;
            StandIns.Recorder.Released(this);
        }

        public void SetData(Array data) { SetData(data, 0, 0, Length(data)); }
        public void SetData(Array data, int managedBufferStartIndex, int graphicsBufferStartIndex, int count)
        {
            int element = Checked(data, managedBufferStartIndex, graphicsBufferStartIndex, count);
            StandIns.Recorder.Uploaded(this, data, managedBufferStartIndex * element, graphicsBufferStartIndex * element, count * element);
        }

        /// <summary>Stops the device in Unity.</summary>
        public void GetData(Array data)
        {
            CheckUsable("GetData");
            byte[] content = StandIns.Readbacks.Of(this);
            if (Buffer.ByteLength(data) > content.Length)
                throw new ArgumentException("GetData(): Accessing " + Buffer.ByteLength(data) + " bytes of " + content.Length);
            Buffer.BlockCopy(content, 0, data, 0, Buffer.ByteLength(data));
        }

        internal void CheckUsable(string use)
        {
            if (released)
                throw new ObjectDisposedException("GraphicsBuffer", "used for " + use + " after Dispose");
        }

        /// <summary>Bytes of an element of `data`, if that much fits.</summary>
        internal int Checked(Array data, int from, int to, int count)
        {
            CheckUsable("SetData");
            int element = Marshal.SizeOf(data.GetType().GetElementType());
            if (from < 0 || to < 0 || count < 0 || from + count > data.Length)
                throw new ArgumentOutOfRangeException("Bad indices/count arguments (managedBufferStartIndex:" + from + " graphicsBufferStartIndex:" + to + " count:" + count + ")");
            if ((long)(to + count) * element > (long)this.count * stride)
                throw new ArgumentException("SetData(): Accessing " + (long)(to + count) * element + " bytes of " + (long)this.count * stride);
            return element;
        }

        internal static int Length(Array data)
        {
            if (data == null)
                throw new ArgumentNullException("data");
            return data.Length;
        }
    }
}

namespace StandIns
{
    using UnityEngine;

    /// <summary>
    /// Answers reads of buffers in two runs: the first marks them in the recording and answers zeros, the second answers
    /// with the files that the replay made of the marks. Not part of Unity's API.
    /// </summary>
    public static class Readbacks
    {
        private static int asked;

        /// <summary>Holds `readback N.bin`; null in the first run.</summary>
        public static string Folder { get; set; }

        /// <summary>Whether reads fail.</summary>
        public static bool Broken { get; set; }

        internal static byte[] Of(GraphicsBuffer buffer)
        {
            string label = "readback " + asked++;
            Recorder.Keep(buffer, label);
            if (Broken)
                throw new InvalidOperationException("stand-in: broken");
            return Folder == null ? new byte[buffer.count * buffer.stride] : System.IO.File.ReadAllBytes(System.IO.Path.Combine(Folder, label + ".bin"));
        }
    }
}
