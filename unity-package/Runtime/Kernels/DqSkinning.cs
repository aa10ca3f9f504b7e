using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Vertices and texels posed by dual quaternions: ComputeShaders/dq_skinning.compute.</summary>
    internal sealed class DqSkinning
    {
        private const string File = "dq_skinning.compute";
        private const int Skinned = 64; // vertices or texels of a group

        private static readonly int Joints = Shader.PropertyToID("joints");
        private static readonly int Indices = Shader.PropertyToID("indices");
        private static readonly int Weights = Shader.PropertyToID("weights");
        private static readonly int VertexDq = Shader.PropertyToID("vertex_dq");
        private static readonly int VertexCount = Shader.PropertyToID("vertex_count");
        private static readonly int Mesh = Shader.PropertyToID("mesh");
        private static readonly int Faces = Shader.PropertyToID("faces");
        private static readonly int Triangles = Shader.PropertyToID("triangles");
        private static readonly int Barycentrics = Shader.PropertyToID("barycentrics");
        private static readonly int TexelChannels = Shader.PropertyToID("texel_channels");
        private static readonly int Splats = Shader.PropertyToID("splats");
        private static readonly int TexelCount = Shader.PropertyToID("texel_count");
        private static readonly int FirstSplat = Shader.PropertyToID("first_splat");

        private readonly Kernel blendVertices;
        private readonly Kernel skinSplats;

        public DqSkinning(ComputeShader shader)
        {
            blendVertices = new Kernel(shader, File, "BlendVertices");
            skinSplats = new Kernel(shader, File, "SkinSplats");
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

        /// <summary>Posed splats of every texel, from `firstSplat` on.</summary>
        public void SkinSplats(
            CommandBuffer commands, AvatarBuffers avatar, GraphicsBuffer vertexDq, GraphicsBuffer mesh,
            GraphicsBuffer texelChannels, GraphicsBuffer splats, int firstSplat)
        {
            skinSplats.Set(commands, VertexDq, vertexDq);
            skinSplats.Set(commands, Mesh, mesh);
            skinSplats.Set(commands, Faces, avatar.Faces);
            skinSplats.Set(commands, Triangles, avatar.Triangles);
            skinSplats.Set(commands, Barycentrics, avatar.Barycentrics);
            skinSplats.Set(commands, TexelChannels, texelChannels);
            skinSplats.Set(commands, Splats, splats);
            skinSplats.Set(commands, TexelCount, avatar.SplatCount);
            skinSplats.Set(commands, FirstSplat, firstSplat);
            skinSplats.Dispatch(commands, Kernel.Groups(avatar.SplatCount, Skinned), 1, 1);
        }
    }
}
