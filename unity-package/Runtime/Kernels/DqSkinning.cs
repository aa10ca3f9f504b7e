using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Vertices posed by dual quaternions: ComputeShaders/dq_skinning.compute.</summary>
    internal sealed class DqSkinning
    {
        private const string File = "dq_skinning.compute";
        private const int Skinned = 64; // vertices of a group

        private static readonly int Joints = Shader.PropertyToID("joints");
        private static readonly int Indices = Shader.PropertyToID("indices");
        private static readonly int Weights = Shader.PropertyToID("weights");
        private static readonly int VertexDq = Shader.PropertyToID("vertex_dq");
        private static readonly int VertexCount = Shader.PropertyToID("vertex_count");

        private readonly Kernel blendVertices;

        public DqSkinning(ComputeShader shader)
        {
            blendVertices = new Kernel(shader, File, "BlendVertices");
        }

        /// <summary>Joints' dual quaternions blended at every vertex.</summary>
        public void BlendVertices(
            CommandBuffer commands, AvatarBuffers avatar, GraphicsBuffer joints, GraphicsBuffer vertexDq)
        {
            blendVertices.Set(commands, Joints, joints);
            blendVertices.Set(commands, Indices, avatar.SkinIndices);
            blendVertices.Set(commands, Weights, avatar.SkinWeights);
            blendVertices.Set(commands, VertexDq, vertexDq);
            blendVertices.Set(commands, VertexCount, avatar.VertexCount);
            blendVertices.Dispatch(commands, Kernel.Groups(avatar.VertexCount, Skinned), 1, 1);
        }
    }
}
