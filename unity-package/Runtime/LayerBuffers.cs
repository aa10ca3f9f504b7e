namespace Mua
{
    /// <summary>One fully connected layer, or the PCA mesh as one.</summary>
    internal sealed class LayerBuffers
    {
        public readonly StoredBuffer Weight;
        public readonly StoredBuffer Bias;
        public readonly int Inputs;
        public readonly int Outputs;

        public LayerBuffers(StoredBuffer weight, StoredBuffer bias, int inputs, int outputs)
        {
            Weight = weight;
            Bias = bias;
            Inputs = inputs;
            Outputs = outputs;
        }
    }
}
