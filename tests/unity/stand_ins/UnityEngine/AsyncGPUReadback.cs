// Stand-in. Source: facts 4.6, Unity 6000.0, AsyncGPUReadback; NativeArray as far as a readback needs it.
using System;

namespace Unity.Collections
{
    public struct NativeArray<T> where T : struct
    {
        internal T[] Content;

        public int Length { get { return Content.Length; } }
        public T this[int index] { get { return Content[index]; } }
        public void CopyTo(T[] array)
        {
            if (array.Length != Content.Length)
                throw new ArgumentException("array.Length does not match the length of this instance");
            Content.CopyTo(array, 0);
        }
        public T[] ToArray() { return (T[])Content.Clone(); }
    }
}

namespace UnityEngine.Rendering
{
    using Unity.Collections;

    public struct AsyncGPUReadbackRequest
    {
        private const int Frames = 2; // that pass until it is done

        internal GraphicsBuffer Buffer;
        internal byte[] Content;
        internal int Asked;

        public bool done { get { return !StandIns.Readbacks.Stuck && Time.frameCount >= Asked + Frames; } }
        public bool hasError { get { return Content == null; } }
        public int layerDataSize { get { return Content.Length; } }
        public NativeArray<T> GetData<T>(int layer = 0) where T : struct
        {
            if (!done || hasError)
                throw new InvalidOperationException("Cannot access the data as it is not available");
            Buffer.CheckUsable("AsyncGPUReadback");
            T[] elements = new T[Content.Length / System.Runtime.InteropServices.Marshal.SizeOf(typeof(T))];
            System.Buffer.BlockCopy(Content, 0, elements, 0, Content.Length);
            return new NativeArray<T> { Content = elements };
        }
    }

    public static class AsyncGPUReadback
    {
        public static AsyncGPUReadbackRequest Request(GraphicsBuffer src, Action<AsyncGPUReadbackRequest> callback = null)
        {
            src.CheckUsable("AsyncGPUReadback");
            return new AsyncGPUReadbackRequest { Buffer = src, Content = StandIns.Readbacks.Of(src), Asked = Time.frameCount };
        }
    }
}

namespace StandIns
{
    using System.Collections.Generic;
    using System.IO;
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

        /// <summary>Whether requests are never done.</summary>
        public static bool Stuck { get; set; }

        /// <summary>Whether requests fail.</summary>
        public static bool Broken { get; set; }

        internal static byte[] Of(GraphicsBuffer buffer)
        {
            string label = "readback " + asked++;
            Recorder.Keep(buffer, label);
            if (Broken)
                return null;
            return Folder == null ? new byte[buffer.count * buffer.stride] : File.ReadAllBytes(Path.Combine(Folder, label + ".bin"));
        }
    }
}
