namespace Mua.Format
{
    /// <summary>Topology, texture coordinates and skin of the mesh of V vertices and F faces.</summary>
    public sealed class Template
    {
        /// <summary>[F, 3] into the vertices, counter-clockwise from outside.</summary>
        public Tensor Faces { get; internal set; }

        /// <summary>[T, 2] u right, v down.</summary>
        public Tensor Uv { get; internal set; }

        /// <summary>[F, 3] into Uv.</summary>
        public Tensor UvFaces { get; internal set; }

        /// <summary>[V, 8] joints, largest weight first.</summary>
        public Tensor SkinIndices { get; internal set; }

        /// <summary>[V, 8] rows that sum to 1.</summary>
        public Tensor SkinWeights { get; internal set; }
    }

    /// <summary>The N valid texels of the square texture; each is one splat.</summary>
    public sealed class Texels
    {
        /// <summary>Texels along a side of the texture.</summary>
        public int Size { get; internal set; }

        /// <summary>[N] row * size + column, ascending.</summary>
        public Tensor Indices { get; internal set; }

        /// <summary>[N] into the faces.</summary>
        public Tensor Triangles { get; internal set; }

        /// <summary>[N, 2] the first two; the third is 1 - a - b.</summary>
        public Tensor Barycentrics { get; internal set; }

        /// <summary>A bit for each texel, the lowest of a byte first: not drawn from behind. Null where the file has none.</summary>
        public byte[] OneSided { get; internal set; }

        /// <summary>Side of a texel on the mean mesh, metres.</summary>
        public float Length { get; internal set; }

        /// <summary>Coarser levels, the finest of them first.</summary>
        public BlockLevel[] Levels { get; internal set; }

        /// <summary>N.</summary>
        public int Count => Indices.Count;

        public bool IsOneSided(int texel)
        {
            return OneSided != null && (OneSided[texel / 8] >> texel % 8 & 1) != 0;
        }
    }
}
