using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Wavelet synthesis: ComputeShaders/inverse_dwt.compute.</summary>
    internal sealed class InverseDwt
    {
        private const string File = "inverse_dwt.compute";
        private const int CoarseTile = 16; // samples along a side that a group doubles
        private const int ChannelBatch = 4; // of a group of UpsampleTexels

        private static readonly int Ll = Shader.PropertyToID("ll");
        private static readonly int Details = Shader.PropertyToID("details");
        private static readonly int RecLo = Shader.PropertyToID("rec_lo");
        private static readonly int RecHi = Shader.PropertyToID("rec_hi");
        private static readonly int Fine = Shader.PropertyToID("fine");
        private static readonly int Channels = Shader.PropertyToID("channels");
        private static readonly int Size = Shader.PropertyToID("size");
        private static readonly int Taps = Shader.PropertyToID("taps");
        private static readonly int UpsamplingTaps = Shader.PropertyToID("upsampling");
        private static readonly int Factor = Shader.PropertyToID("factor");
        private static readonly int Reach = Shader.PropertyToID("reach");
        private static readonly int Delay = Shader.PropertyToID("delay");
        private static readonly int Tiles = Shader.PropertyToID("tiles");
        private static readonly int StaticOffset = Shader.PropertyToID("static_offset");
        private static readonly int StaticOffsetLayout = Shader.PropertyToID("static_offset_layout");
        private static readonly int TexelChannels = Shader.PropertyToID("texel_channels");
        private static readonly int TexelCount = Shader.PropertyToID("texel_count");
        private static readonly int FirstRow = Shader.PropertyToID("first_row");

        private readonly Kernel full, upsampleTexels;

        public InverseDwt(ComputeShader shader)
        {
            full = new Kernel(shader, File, "InverseDwt");
            upsampleTexels = new Kernel(shader, File, "UpsampleTexels");
        }

        /// <summary>One level, from planes of `size` to twice that.</summary>
        public void Full(
            CommandBuffer commands, AvatarBuffers avatar, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer details, GraphicsBuffer fine)
        {
            int tiles = Kernel.Groups(size, CoarseTile);
            full.Set(commands, Ll, ll);
            full.Set(commands, Details, details);
            full.Set(commands, RecLo, avatar.RecLo);
            full.Set(commands, RecHi, avatar.RecHi);
            full.Set(commands, Fine, fine);
            full.Set(commands, Channels, channels);
            full.Set(commands, Size, size);
            full.Set(commands, Taps, avatar.Taps);
            full.Dispatch(commands, tiles, tiles, channels);
        }

        /// <summary>
        /// All levels without details, from planes of `size`, plus the static offset, at the valid texels, to rows from
        /// `firstRow` on.
        /// </summary>
        public void UpsampleTexels(
            CommandBuffer commands, LevelBuffers level, BranchLevel shown, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer texelChannels, int firstRow)
        {
            SetUpsampling(commands, upsampleTexels, level, shown, channels, size, ll, texelChannels);
            upsampleTexels.Set(commands, FirstRow, firstRow);
            upsampleTexels.Dispatch(commands, level.TileCount, 1, Kernel.Groups(channels, ChannelBatch));
        }

        /// <summary>What a kernel that makes texels needs of a branch, from planes of `size`.</summary>
        public static void SetUpsampling(
            CommandBuffer commands, Kernel kernel, LevelBuffers level, BranchLevel shown, int channels, int size,
            GraphicsBuffer ll, GraphicsBuffer texelChannels)
        {
            kernel.Set(commands, Ll, ll);
            kernel.Set(commands, UpsamplingTaps, shown.Upsampling.Taps.Buffer);
            kernel.Set(commands, Tiles, level.Tiles);
            kernel.Set(commands, StaticOffset, StaticOffsetLayout, shown.StaticOffset);
            kernel.Set(commands, TexelChannels, texelChannels);
            kernel.Set(commands, Channels, channels);
            kernel.Set(commands, Size, size);
            kernel.Set(commands, Factor, shown.Upsampling.Factor);
            kernel.Set(commands, Reach, shown.Upsampling.Reach);
            kernel.Set(commands, Delay, shown.Upsampling.Delay);
            kernel.Set(commands, TexelCount, level.SplatCount);
        }
    }
}
