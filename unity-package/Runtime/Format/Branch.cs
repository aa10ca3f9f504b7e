namespace Mua.Format
{
    /// <summary>Synthesis filters of a wavelet in periodization mode.</summary>
    public sealed class Wavelet
    {
        /// <summary>`spline3`, or as in PyWavelets, such as `bior4.4`.</summary>
        public string Name { get; internal set; }

        /// <summary>Levels from LL to the texture: size = LL size * 2^Levels.</summary>
        public int Levels { get; internal set; }

        public double[] RecLo { get; internal set; }

        public double[] RecHi { get; internal set; }
    }

    /// <summary>y = W x + b; ReLU on every layer but the last of its MLP.</summary>
    public sealed class Layer
    {
        /// <summary>[outputs, inputs].</summary>
        public Tensor Weight { get; internal set; }

        /// <summary>[outputs].</summary>
        public Tensor Bias { get; internal set; }

        public int Outputs => Weight.Shape[0];

        public int Inputs => Weight.Shape[1];
    }

    /// <summary>The coarse mesh: canonical vertices = mean + sum over k of z(k) basis(k), z from an MLP.</summary>
    public sealed class Coarse
    {
        public Layer[] Mlp { get; internal set; }

        /// <summary>[V, 3] metres.</summary>
        public Tensor Mean { get; internal set; }

        /// <summary>[K, V, 3] metres.</summary>
        public Tensor Basis { get; internal set; }
    }

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
