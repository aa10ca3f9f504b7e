using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua.SelfTest
{
    /// <summary>The words of a buffer, some frames after they were asked for.</summary>
    internal sealed class Readback
    {
        private const float Patience = 10; // seconds

        private readonly GraphicsBuffer buffer;
        private readonly float begun = Time.realtimeSinceStartup;
        private readonly bool isAsync;
        private readonly AsyncGPUReadbackRequest request;
        private uint[] words;

        /// <summary>`waits`: at once, for an editor that runs no frames.</summary>
        public Readback(GraphicsBuffer buffer, bool waits)
        {
            this.buffer = buffer;
            isAsync = SystemInfo.supportsAsyncGPUReadback && !waits;
            if (isAsync)
            {
                request = AsyncGPUReadback.Request(buffer);
            }
        }

        /// <summary>Why there are no words; empty where there are, or will be.</summary>
        public string Problem { get; private set; } = "";

        /// <summary>Null where Problem says why.</summary>
        public uint[] Words => words;

        /// <summary>Whether Words or Problem is there.</summary>
        public bool Continue()
        {
            if (words != null || Problem.Length > 0)
            {
                return true;
            }
            try
            {
                Read();
            }
            catch (Exception error) // whatever the engine refuses, the case fails and the run goes on
            {
                Problem = "could not be read back: " + error.Message;
            }
            return words != null || Problem.Length > 0;
        }

        private void Read()
        {
            if (!isAsync)
            {
                var found = new uint[Count];
                buffer.GetData(found);
                words = found;
            }
            else if (!request.done)
            {
                Problem = Time.realtimeSinceStartup - begun > Patience ? "was not read back in 10 seconds" : "";
            }
            else if (request.hasError)
            {
                Problem = "could not be read back";
            }
            else
            {
                var found = new uint[Count];
                request.GetData<uint>().CopyTo(found);
                words = found;
            }
        }

        private int Count => buffer.count * (buffer.stride / sizeof(uint));
    }
}
