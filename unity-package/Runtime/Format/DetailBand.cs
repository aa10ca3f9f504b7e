namespace Mua.Format
{
    /// <summary>The three detail subbands of one level: mean + sum over r of alpha(r, c) h (x) w.</summary>
    public sealed class DetailBand
    {
        /// <summary>[3, C, n, n].</summary>
        public Tensor Mean { get; internal set; }

        /// <summary>[3, C, R, n] along rows.</summary>
        public Tensor H { get; internal set; }

        /// <summary>[3, C, R, n] along columns.</summary>
        public Tensor W { get; internal set; }

        /// <summary>R.</summary>
        public int Rank => H.Shape[2];

        /// <summary>n, coefficients along a side.</summary>
        public int Size => H.Shape[3];
    }
}
