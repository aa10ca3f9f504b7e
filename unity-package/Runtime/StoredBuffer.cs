using System;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>A tensor as the kernels' `stored()` reads it (python/mua/gpu/stored.py).</summary>
    internal sealed class StoredBuffer
    {
        private readonly Upload upload;

        public StoredBuffer(Tensor tensor, Upload upload)
        {
            this.upload = upload;
            int rows = tensor.Scale == null ? 0 : tensor.Scale.Length;
            int perScale = rows == 0 ? 1 : Math.Max(tensor.Count / rows, 1);
            Layout = new[] { (int)tensor.Type, perScale, rows == 0 ? 0 : upload.StoredWords };
        }

        public GraphicsBuffer Words => upload.Buffer;

        /// <summary>Element type, elements for each scale, index of the first scale's word.</summary>
        public int[] Layout { get; }
    }
}
