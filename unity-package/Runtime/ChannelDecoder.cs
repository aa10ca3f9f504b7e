using System;
using Mua.Format;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// From a window of poses to channels: the dispatches of a decode, in parts that displayed frames can share, in the order
    /// of python/mua/player/channels.py. The buffers between the kernels are made once: parts read what the one before left in them.
    /// </summary>
    internal sealed class ChannelDecoder : IDisposable
    {
        /// <summary>Parts of a decode, which take about as long each.</summary>
        public const int Parts = 4;

        private const int AppearanceRow = 3; // first row of appearance in the channels; a row has four half floats

        private readonly AvatarBuffers avatar;
        private readonly MlpMatmul mlpMatmul;
        private readonly BlendSubbands blendSubbands;
        private readonly InverseDwt inverseDwt;
        private readonly Expressions expressions;
        private readonly BufferSet buffers = new BufferSet();
        private readonly GraphicsBuffer[] activations = new GraphicsBuffer[2];
        private readonly GraphicsBuffer[] textures = new GraphicsBuffer[2]; // finest detailed, its ll
        private GraphicsBuffer details;
        private GraphicsBuffer moved; // [V] and how much brighter colours become; 0 where no expression moves a vertex
        private GraphicsBuffer triangleBends; // [3 T]
        private GraphicsBuffer vertexBends; // [3 V], of those in reach

        /// <summary>
        /// InvalidOperationException where a kernel is missing or a buffer is too large for the device.
        /// </summary>
        public ChannelDecoder(AvatarResources resources, AvatarBuffers avatar)
        {
            this.avatar = avatar;
            mlpMatmul = new MlpMatmul(resources.MlpMatmul);
            blendSubbands = new BlendSubbands(resources.BlendSubbands);
            inverseDwt = new InverseDwt(resources.InverseDwt);
            expressions = new Expressions(resources.Expressions);
            try
            {
                CreateBuffers();
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        /// <summary>Appends one of Parts, in their order: from the components in `channels` to their results there.</summary>
        public void Part(CommandBuffer commands, ChannelSet channels, int part)
        {
            bool isGeometry = part < Parts / 2;
            BranchBuffers branch = isGeometry ? avatar.Geometry : avatar.Appearance;
            BranchLevel shown = isGeometry ? channels.Level.Geometry : channels.Level.Appearance;
            if (part == 1)
            {
                Coarse(commands, channels);
            }
            commands.BeginSample(AvatarStages.Texture);
            if (part % 2 == 0)
            {
                Blend(commands, branch, channels);
            }
            else
            {
                Texels(commands, branch, shown, channels, isGeometry);
            }
            commands.EndSample(AvatarStages.Texture);
        }

        public void Dispose()
        {
            buffers.Dispose();
        }

        private void CreateBuffers()
        {
            int layers = Math.Max(Widest(avatar.CoarseMlp), 1);
            layers = Math.Max(layers, Math.Max(Widest(avatar.Geometry.Mlp), Widest(avatar.Appearance.Mlp)));
            long bands = Math.Max(LargestBand(avatar.Geometry), LargestBand(avatar.Appearance));
            details = buffers.Structured("details", bands, sizeof(uint));
            int vertices = avatar.Expressions.VertexCount == 0 ? 1 : avatar.VertexCount;
            moved = buffers.Structured("moved", vertices, 4 * sizeof(float));
            moved.SetData(new float[4 * vertices]);
            triangleBends = buffers.Structured("triangle_bends", 3L * avatar.Expressions.TriangleCount, 2 * sizeof(uint));
            vertexBends = buffers.Structured("vertex_bends", 3L * vertices, 2 * sizeof(uint));
            for (int i = 0; i < 2; i++)
            {
                activations[i] = buffers.Structured("activations", layers, sizeof(float));
                long texture = Math.Max(Detailed(avatar.Geometry, i), Detailed(avatar.Appearance, i));
                textures[i] = buffers.Structured("texture", texture, sizeof(uint));
            }
        }

        /// <summary>Output of the MLP for the components; the next MLP overwrites it.</summary>
        private GraphicsBuffer Mlp(CommandBuffer commands, LayerBuffers[] mlp, GraphicsBuffer components)
        {
            GraphicsBuffer x = components;
            for (int i = 0; i < mlp.Length; i++)
            {
                GraphicsBuffer y = activations[i % 2];
                mlpMatmul.Layer(commands, mlp[i], x, y, i < mlp.Length - 1);
                x = y;
            }
            return x;
        }

        /// <summary>The mesh; vertices of expressions move, and those in reach bend.</summary>
        private void Coarse(CommandBuffer commands, ChannelSet channels)
        {
            commands.BeginSample(AvatarStages.CoarseMesh);
            GraphicsBuffer coefficients = Mlp(commands, avatar.CoarseMlp, channels.Components);
            mlpMatmul.Transposed(commands, avatar.Mesh, coefficients, channels.Mesh);
            if (channels.IsExpressive)
            {
                expressions.Sum(commands, avatar.Expressions, channels.Weights, moved, channels.Mesh);
                expressions.Bend(commands, avatar.Expressions, moved, channels.Mesh, triangleBends, vertexBends);
            }
            commands.EndSample(AvatarStages.CoarseMesh);
        }

        /// <summary>Coefficients, LL, and level by level up to the finest details.</summary>
        private void Blend(CommandBuffer commands, BranchBuffers branch, ChannelSet channels)
        {
            GraphicsBuffer alpha = Mlp(commands, branch.Mlp, channels.Components);
            int levels = branch.Details.Length;
            blendSubbands.Low(commands, branch, alpha, Size(0), textures[levels % 2]);
            int offset = branch.Channels * branch.Rank;
            for (int level = 0; level < levels; level++)
            {
                if (level > 0)
                {
                    Synthesise(commands, branch, level - 1);
                }
                BandBuffers band = branch.Details[level];
                blendSubbands.Detail(commands, band, branch.Channels, alpha, offset, details);
                offset += branch.Channels * band.Rank;
            }
        }

        /// <summary>The finest level with details; then the valid texels to the channels.</summary>
        private void Texels(
            CommandBuffer commands, BranchBuffers branch, BranchLevel shown, ChannelSet channels, bool isGeometry)
        {
            int levels = branch.Details.Length;
            if (levels > 0)
            {
                Synthesise(commands, branch, levels - 1);
            }
            LevelBuffers level = channels.Level;
            GraphicsBuffer ll = textures[0], texels = channels.TexelChannels;
            if (!channels.IsExpressive)
            {
                int firstRow = isGeometry ? 0 : AppearanceRow;
                inverseDwt.UpsampleTexels(commands, level, shown, branch.Channels, Size(levels), ll, texels, firstRow);
            }
            else if (isGeometry)
            {
                expressions.BendTexels(
                    commands, level, shown, branch.Channels, Size(levels), ll, texels, avatar.Faces, vertexBends);
            }
            else
            {
                expressions.LightTexels(commands, level, shown, branch.Channels, Size(levels), ll, texels);
            }
        }

        /// <summary>One level with its details, to planes of twice the size.</summary>
        private void Synthesise(CommandBuffer commands, BranchBuffers branch, int level)
        {
            int finest = branch.Details.Length;
            GraphicsBuffer ll = textures[(finest - level) % 2], fine = textures[(finest - level - 1) % 2];
            inverseDwt.Full(commands, avatar, branch.Channels, Size(level), ll, details, fine);
        }

        /// <summary>Samples along a side of LL, or of what so many levels made of it.</summary>
        private int Size(int level)
        {
            return avatar.Avatar.Texels.Size >> avatar.Avatar.Wavelet.Levels << level;
        }

        private static int Widest(LayerBuffers[] mlp)
        {
            int widest = 0;
            foreach (LayerBuffers layer in mlp)
            {
                widest = Math.Max(widest, layer.Outputs);
            }
            return widest;
        }

        /// <summary>Words of a branch's texture where its details end, or a level before.</summary>
        private long Detailed(BranchBuffers branch, int before)
        {
            int low = avatar.Avatar.Texels.Size >> avatar.Avatar.Wavelet.Levels;
            return branch.Channels * PlaneWords(low << branch.Details.Length >> before);
        }

        /// <summary>Words of a plane of half floats; each row fills whole words.</summary>
        private static long PlaneWords(int size)
        {
            return (long)size * Kernel.Groups(size, 2);
        }

        private static long LargestBand(BranchBuffers branch)
        {
            long largest = 0;
            foreach (BandBuffers band in branch.Details)
            {
                largest = Math.Max(largest, 3L * branch.Channels * PlaneWords(band.Size));
            }
            return largest;
        }
    }
}
