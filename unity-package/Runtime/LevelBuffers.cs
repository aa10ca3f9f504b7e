using System;
using UnityEngine;

namespace Mua
{
    /// <summary>What a level of detail needs of one branch, geometry or appearance.</summary>
    internal sealed class BranchLevel
    {
        public Upsampling Upsampling; // of the wavelet levels without details
        public StoredBuffer StaticOffset;
    }

    /// <summary>The texels of one level of detail on the device (python/mua/player/buffers.py).</summary>
    internal sealed class LevelBuffers
    {
        private const int OneSided = 1 << 31; // beside the triangle

        private readonly Upload tiles, texels;

        /// <param name="level">What it is made of.</param>
        /// <param name="targets">What may bend its texels.</param>
        /// <param name="add">Takes what is to be uploaded.</param>
        public LevelBuffers(DetailLevel level, ExpressionTargets targets, Func<Upload, Upload> add)
        {
            Number = level.Number;
            Size = level.Size;
            SplatCount = level.Count;
            var held = new TexelTiles(level.Texels, level.Size, Array.ConvertAll(level.Triangles, targets.IsReached));
            TileCount = held.Count;
            tiles = add(new Upload("texels.texels", held.Rows, 2 * sizeof(int)));
            texels = add(new Upload("texels", Places(level), 2 * sizeof(int)));
        }

        /// <summary>0 is the finest.</summary>
        public int Number { get; }

        /// <summary>Texels along a side of the texture.</summary>
        public int Size { get; }

        public int SplatCount { get; }

        public BranchLevel Geometry { get; set; }

        public BranchLevel Appearance { get; set; }

        /// <summary>How many tiles of the texture hold a valid texel.</summary>
        public int TileCount { get; }

        /// <summary>[T, 17, 2] as texel_tiles of python/mua/kernels/inverse_dwt.py has them.</summary>
        public GraphicsBuffer Tiles => tiles.Buffer;

        /// <summary>[N] triangle and whether it is one-sided, and its first two barycentrics in 16 bits each.</summary>
        public GraphicsBuffer Texels => texels.Buffer;

        /// <summary>[N, 2] as pack_texels of python/mua/kernels/splat_project.py has them.</summary>
        private static int[] Places(DetailLevel level)
        {
            var places = new int[2 * level.Count];
            for (int i = 0; i < level.Count; i++)
            {
                places[2 * i] = level.Triangles[i] | (level.OneSided[i] ? OneSided : 0);
                places[2 * i + 1] = Steps(level.Barycentrics[2 * i]) | Steps(level.Barycentrics[2 * i + 1]) << 16;
            }
            return places;
        }

        private static int Steps(float barycentric)
        {
            return (int)Math.Round((double)barycentric * ushort.MaxValue);
        }
    }
}
