using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Wavelet synthesis, level by level: ComputeShaders/inverse_dwt.compute.</summary>
    internal sealed class InverseDwt
    {
        private const string File = "inverse_dwt.compute";
        private const int CoarseTile = 16; // samples along a side that a group doubles
        private const int StaticTexels = 256; // of a group of AddStatic

        private static readonly int Ll = Shader.PropertyToID("ll");
        private static readonly int Details = Shader.PropertyToID("details");
        private static readonly int RecLo = Shader.PropertyToID("rec_lo");
        private static readonly int RecHi = Shader.PropertyToID("rec_hi");
        private static readonly int Fine = Shader.PropertyToID("fine");
        private static readonly int Channels = Shader.PropertyToID("channels");
        private static readonly int Size = Shader.PropertyToID("size");
        private static readonly int Taps = Shader.PropertyToID("taps");
        private static readonly int Texels = Shader.PropertyToID("texels");
        private static readonly int StaticOffset = Shader.PropertyToID("static_offset");
        private static readonly int StaticOffsetLayout = Shader.PropertyToID("static_offset_layout");
        private static readonly int TexelChannels = Shader.PropertyToID("texel_channels");
        private static readonly int TexelCount = Shader.PropertyToID("texel_count");
        private static readonly int FirstChannel = Shader.PropertyToID("first_channel");

        private readonly Kernel full;
        private readonly Kernel lowPass;
        private readonly Kernel addStatic;

        public InverseDwt(ComputeShader shader)
        {
            full = new Kernel(shader, File, "InverseDwt");
            lowPass = new Kernel(shader, File, "InverseDwtLowPass");
            addStatic = new Kernel(shader, File, "AddStatic");
        }

        /// <summary>One level, from planes of `size` to twice that.</summary>
        public void Full(
            CommandBuffer commands, AvatarBuffers avatar, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer details, GraphicsBuffer fine)
        {
            full.Set(commands, Details, details);
            full.Set(commands, RecHi, avatar.RecHi);
            Synthesise(commands, full, avatar, channels, size, ll, fine);
        }

        /// <summary>The same, all details zero.</summary>
        public void LowPass(
            CommandBuffer commands, AvatarBuffers avatar, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer fine)
        {
            Synthesise(commands, lowPass, avatar, channels, size, ll, fine);
        }

        /// <summary>Valid texels of planes of `size`, plus the static offset, to rows from `firstChannel` on.</summary>
        public void AddStatic(
            CommandBuffer commands, AvatarBuffers avatar, BranchBuffers branch, int size, GraphicsBuffer fine,
            GraphicsBuffer texelChannels, int firstChannel)
        {
            addStatic.Set(commands, Fine, fine);
            addStatic.Set(commands, Texels, avatar.Texels);
            addStatic.Set(commands, StaticOffset, StaticOffsetLayout, branch.StaticOffset);
            addStatic.Set(commands, TexelChannels, texelChannels);
            addStatic.Set(commands, Channels, branch.Channels);
            addStatic.Set(commands, Size, size);
            addStatic.Set(commands, TexelCount, avatar.SplatCount);
            addStatic.Set(commands, FirstChannel, firstChannel);
            addStatic.Dispatch(commands, Kernel.Groups(avatar.SplatCount, StaticTexels), 1, 1);
        }

        private static void Synthesise(
            CommandBuffer commands, Kernel kernel, AvatarBuffers avatar, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer fine)
        {
            int tiles = Kernel.Groups(size, CoarseTile);
            kernel.Set(commands, Ll, ll);
            kernel.Set(commands, RecLo, avatar.RecLo);
            kernel.Set(commands, Fine, fine);
            kernel.Set(commands, Channels, channels);
            kernel.Set(commands, Size, size);
            kernel.Set(commands, Taps, avatar.Taps);
            kernel.Dispatch(commands, tiles, tiles, channels);
        }
    }
}
