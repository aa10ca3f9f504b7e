using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Dynamic subbands from coefficients: ComputeShaders/blend_subbands.compute.</summary>
    internal sealed class BlendSubbands
    {
        private const string File = "blend_subbands.compute";
        private const int LlPairs = 64; // texels that share a word, of a group of BlendLl
        private const int DetailTile = 24; // texels along a side of a group of BlendDetail
        private const int Bands = 3;

        private static readonly int Mean = Shader.PropertyToID("mean");
        private static readonly int MeanLayout = Shader.PropertyToID("mean_layout");
        private static readonly int Basis = Shader.PropertyToID("basis");
        private static readonly int BasisLayout = Shader.PropertyToID("basis_layout");
        private static readonly int H = Shader.PropertyToID("h");
        private static readonly int HLayout = Shader.PropertyToID("h_layout");
        private static readonly int W = Shader.PropertyToID("w");
        private static readonly int WLayout = Shader.PropertyToID("w_layout");
        private static readonly int Alpha = Shader.PropertyToID("alpha");
        private static readonly int AlphaOffset = Shader.PropertyToID("alpha_offset");
        private static readonly int Blended = Shader.PropertyToID("blended");
        private static readonly int Channels = Shader.PropertyToID("channels");
        private static readonly int Rank = Shader.PropertyToID("rank");
        private static readonly int Size = Shader.PropertyToID("size");

        private readonly Kernel low;
        private readonly Kernel detail;

        public BlendSubbands(ComputeShader shader)
        {
            low = new Kernel(shader, File, "BlendLl");
            detail = new Kernel(shader, File, "BlendDetail");
        }

        /// <summary>LL planes of `size`; its coefficients are the first of `alpha`.</summary>
        public void Low(
            CommandBuffer commands, BranchBuffers branch, GraphicsBuffer alpha, int size, GraphicsBuffer blended)
        {
            low.Set(commands, Mean, MeanLayout, branch.LlMean);
            low.Set(commands, Basis, BasisLayout, branch.LlBasis);
            low.Set(commands, Alpha, alpha);
            low.Set(commands, Blended, blended);
            low.Set(commands, Channels, branch.Channels);
            low.Set(commands, Rank, branch.Rank);
            low.Set(commands, Size, size);
            low.Set(commands, AlphaOffset, 0);
            low.Dispatch(commands, Kernel.Groups(size * Kernel.Groups(size, 2), LlPairs), branch.Channels, 1);
        }

        /// <summary>The three detail subbands of a level, with coefficients from `alphaOffset` on.</summary>
        public void Detail(
            CommandBuffer commands, BandBuffers band, int channels, GraphicsBuffer alpha, int alphaOffset,
            GraphicsBuffer blended)
        {
            int tiles = Kernel.Groups(band.Size, DetailTile);
            detail.Set(commands, Mean, MeanLayout, band.Mean);
            detail.Set(commands, H, HLayout, band.H);
            detail.Set(commands, W, WLayout, band.W);
            detail.Set(commands, Alpha, alpha);
            detail.Set(commands, Blended, blended);
            detail.Set(commands, Channels, channels);
            detail.Set(commands, Rank, band.Rank);
            detail.Set(commands, Size, band.Size);
            detail.Set(commands, AlphaOffset, alphaOffset);
            detail.Dispatch(commands, tiles, tiles, Bands * channels);
        }
    }
}
