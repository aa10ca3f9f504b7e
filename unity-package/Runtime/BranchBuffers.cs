using System;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// A tensor of the file as the kernels read it: words of packed elements, and how to unpack them
    /// (python/mua/gpu/tensor_words.py).
    /// </summary>
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

        /// <summary>A buffer of f32 numbers that are not in the file.</summary>
        public StoredBuffer(Upload floats)
        {
            upload = floats;
            Layout = new[] { (int)ElementType.F32, 1, 0 };
        }

        public GraphicsBuffer Words => upload.Buffer;

        /// <summary>Element type, elements for each scale, index of the first scale's word.</summary>
        public int[] Layout { get; }
    }

    /// <summary>One fully connected layer, or the PCA mesh as one.</summary>
    internal sealed class LayerBuffers
    {
        public StoredBuffer Weight;
        public StoredBuffer Bias;
        public int Inputs;
        public int Outputs;
    }

    /// <summary>The three detail subbands of one level.</summary>
    internal sealed class BandBuffers
    {
        public StoredBuffer Mean;
        public StoredBuffer H;
        public StoredBuffer W;
        public int Rank;
        public int Size; // texels along a side
    }

    /// <summary>Geometry or appearance on the device.</summary>
    internal sealed class BranchBuffers
    {
        public LayerBuffers[] Mlp;
        public StoredBuffer LlMean;
        public StoredBuffer LlBasis;
        public BandBuffers[] Details; // coarse first
        public int Channels;
        public int Rank; // of LL
    }
}
