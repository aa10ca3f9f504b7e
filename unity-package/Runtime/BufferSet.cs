using System;
using System.Collections.Generic;
using UnityEngine;

namespace Mua
{
    /// <summary>GPU memory that is given back together.</summary>
    internal sealed class BufferSet : IDisposable
    {
        private readonly List<GraphicsBuffer> buffers = new List<GraphicsBuffer>();

        /// <summary>A structured buffer of at least one element; InvalidOperationException where it is too large.</summary>
        public GraphicsBuffer Structured(string name, long count, int stride)
        {
            return Add(GraphicsBuffer.Target.Structured, name, count, stride);
        }

        /// <summary>Corners of triangles.</summary>
        public GraphicsBuffer Indices(string name, int count)
        {
            return Add(GraphicsBuffer.Target.Index, name, count, sizeof(uint));
        }

        /// <summary>Words that kernels write and read, and that are copied to others.</summary>
        public GraphicsBuffer Copied(string name, int count)
        {
            return Add(
                GraphicsBuffer.Target.Structured | GraphicsBuffer.Target.CopySource, name, count, sizeof(uint));
        }

        /// <summary>
        /// Words that are copied from others and that draws and dispatches take their counts from. No kernel binds them:
        /// Direct3D 11 refuses one buffer to be both structured and of arguments.
        /// </summary>
        public GraphicsBuffer Arguments(string name, int count)
        {
            return Add(
                GraphicsBuffer.Target.IndirectArguments | GraphicsBuffer.Target.CopyDestination, name, count,
                sizeof(uint));
        }

        public void Dispose()
        {
            foreach (GraphicsBuffer buffer in buffers)
            {
                buffer.Dispose();
            }
            buffers.Clear();
        }

        private GraphicsBuffer Add(GraphicsBuffer.Target target, string name, long count, int stride)
        {
            long held = Math.Max(count, 1), bytes = held * stride, most = SystemInfo.maxGraphicsBufferSize;
            if (bytes > most)
            {
                throw new InvalidOperationException(
                    "the buffer " + name + " needs " + bytes + " bytes; " + SystemInfo.graphicsDeviceName
                    + " allows at most " + most + " in a buffer.");
            }
            var buffer = new GraphicsBuffer(target, (int)held, stride) { name = "MUA " + name };
            buffers.Add(buffer);
            return buffer;
        }
    }
}
