namespace Mua.Format
{
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

        /// <summary>N.</summary>
        public int Count => Indices.Count;
    }
}
