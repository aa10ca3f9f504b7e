using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Fully connected layers: ComputeShaders/mlp_matmul.compute.</summary>
    internal sealed class MlpMatmul
    {
        private const string File = "mlp_matmul.compute";
        private const int LayerRows = 8; // outputs of a group of MlpMatmul
        private const int MeshColumns = 64; // outputs of a group of MlpMatmulTransposed

        private static readonly int Weight = Shader.PropertyToID("weight");
        private static readonly int WeightLayout = Shader.PropertyToID("weight_layout");
        private static readonly int Bias = Shader.PropertyToID("bias");
        private static readonly int BiasLayout = Shader.PropertyToID("bias_layout");
        private static readonly int X = Shader.PropertyToID("x");
        private static readonly int Y = Shader.PropertyToID("y");
        private static readonly int Inputs = Shader.PropertyToID("inputs");
        private static readonly int Outputs = Shader.PropertyToID("outputs");
        private static readonly int Relu = Shader.PropertyToID("relu");

        private readonly Kernel rows;
        private readonly Kernel columns;

        public MlpMatmul(ComputeShader shader)
        {
            rows = new Kernel(shader, File, "MlpMatmul");
            columns = new Kernel(shader, File, "MlpMatmulTransposed");
        }

        /// <summary>y = weight x + bias, negative values cut off with `relu`; weight [outputs, inputs].</summary>
        public void Layer(CommandBuffer commands, LayerBuffers layer, GraphicsBuffer x, GraphicsBuffer y, bool relu)
        {
            Bind(commands, rows, layer, x, y);
            rows.Set(commands, Relu, relu ? 1 : 0);
            rows.Dispatch(commands, Kernel.Groups(layer.Outputs, LayerRows), 1, 1);
        }

        /// <summary>y = x weight + bias; weight [inputs, outputs].</summary>
        public void Transposed(CommandBuffer commands, LayerBuffers layer, GraphicsBuffer x, GraphicsBuffer y)
        {
            Bind(commands, columns, layer, x, y);
            columns.Set(commands, Relu, 0);
            columns.Dispatch(commands, Kernel.Groups(layer.Outputs, MeshColumns), 1, 1);
        }

        private static void Bind(
            CommandBuffer commands, Kernel kernel, LayerBuffers layer, GraphicsBuffer x, GraphicsBuffer y)
        {
            kernel.Set(commands, Weight, WeightLayout, layer.Weight);
            kernel.Set(commands, Bias, BiasLayout, layer.Bias);
            kernel.Set(commands, X, x);
            kernel.Set(commands, Y, y);
            kernel.Set(commands, Inputs, layer.Inputs);
            kernel.Set(commands, Outputs, layer.Outputs);
        }
    }
}
