namespace Mua.Format
{
    /// <summary>Geometry (C = 11) or appearance (C = 12): an MLP and the subbands that its output drives.</summary>
    public sealed class Branch
    {
        public Layer[] Mlp { get; internal set; }

        /// <summary>[C, n, n].</summary>
        public Tensor LlMean { get; internal set; }

        /// <summary>[C, R, n, n].</summary>
        public Tensor LlBasis { get; internal set; }

        /// <summary>Coarse level first.</summary>
        public DetailBand[] Details { get; internal set; }

        /// <summary>[C, N] added at the valid texels.</summary>
        public Tensor StaticOffset { get; internal set; }

        /// <summary>C.</summary>
        public int Channels => LlBasis.Shape[0];

        /// <summary>R of LL.</summary>
        public int Rank => LlBasis.Shape[1];
    }
}
