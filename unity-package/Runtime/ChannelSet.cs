using System;
using UnityEngine;

namespace Mua
{
    /// <summary>What a decode makes, the window of poses that it is made from, and the level of detail at which.</summary>
    internal sealed class ChannelSet : IDisposable
    {
        private const int ChannelRows = 6; // of four half floats each

        private readonly BufferSet buffers = new BufferSet();

        /// <summary>InvalidOperationException where a buffer is too large for the device.</summary>
        public ChannelSet(AvatarBuffers avatar, int componentCount)
        {
            Level = avatar.Levels[0];
            try
            {
                Components = buffers.Structured("components", componentCount, sizeof(float));
                Mesh = buffers.Structured("mesh", 3L * avatar.VertexCount, sizeof(float));
                Weights = buffers.Structured("weights", avatar.Avatar.ExpressionCount, sizeof(float));
                TexelChannels = buffers.Structured("texel_channels", (long)ChannelRows * Level.SplatCount, 2 * sizeof(uint));
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        /// <summary>The buffers have room for the finest.</summary>
        public LevelBuffers Level { get; set; }

        /// <summary>[K] of the descriptor, as the networks read them.</summary>
        public GraphicsBuffer Components { get; }

        /// <summary>Share of the pose that training did not show, 0 to 1.</summary>
        public double Outside { get; set; }

        /// <summary>[E] of expressions, where IsExpressive.</summary>
        public GraphicsBuffer Weights { get; }

        /// <summary>Whether one of them is not 0.</summary>
        public bool IsExpressive { get; set; }

        /// <summary>[V, 3] canonical vertices, metres.</summary>
        public GraphicsBuffer Mesh { get; }

        /// <summary>[6, N] of four half floats.</summary>
        public GraphicsBuffer TexelChannels { get; }

        public void Dispose()
        {
            buffers.Dispose();
        }
    }
}
