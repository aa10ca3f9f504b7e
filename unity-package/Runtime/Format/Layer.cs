namespace Mua.Format
{
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
}
