namespace Mua.Format
{
    /// <summary>The coarse mesh: canonical vertices = mean + sum over k of z(k) basis(k), z from an MLP.</summary>
    public sealed class Coarse
    {
        public Layer[] Mlp { get; internal set; }

        /// <summary>[V, 3] metres.</summary>
        public Tensor Mean { get; internal set; }

        /// <summary>[K, V, 3] metres.</summary>
        public Tensor Basis { get; internal set; }
    }
}
