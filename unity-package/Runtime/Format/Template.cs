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
}
