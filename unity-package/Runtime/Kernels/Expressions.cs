using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Vertices that expressions move, and the texels that follow: ComputeShaders/expressions.compute.</summary>
    internal sealed class Expressions
    {
        private const string File = "expressions.compute";
        private const int Expressed = 64; // vertices, triangles or texels of a group

        private static readonly int Vertices = Shader.PropertyToID("vertices");
        private static readonly int Starts = Shader.PropertyToID("starts");
        private static readonly int EntryExpressions = Shader.PropertyToID("expressions");
        private static readonly int Offsets = Shader.PropertyToID("offsets");
        private static readonly int Weights = Shader.PropertyToID("weights");
        private static readonly int Triangles = Shader.PropertyToID("triangles");
        private static readonly int Faces = Shader.PropertyToID("faces");
        private static readonly int Reached = Shader.PropertyToID("reached");
        private static readonly int Moved = Shader.PropertyToID("moved");
        private static readonly int Mesh = Shader.PropertyToID("mesh");
        private static readonly int Bends = Shader.PropertyToID("bends");
        private static readonly int TexelChannels = Shader.PropertyToID("texel_channels");
        private static readonly int VertexCount = Shader.PropertyToID("vertex_count");
        private static readonly int TriangleCount = Shader.PropertyToID("triangle_count");
        private static readonly int TexelCount = Shader.PropertyToID("texel_count");
        private static readonly int SplatCount = Shader.PropertyToID("splat_count");

        private readonly Kernel sumTargets, bendTriangles, bendTexels;

        public Expressions(ComputeShader shader)
        {
            sumTargets = new Kernel(shader, File, "SumTargets");
            bendTriangles = new Kernel(shader, File, "BendTriangles");
            bendTexels = new Kernel(shader, File, "BendTexels");
        }

        /// <summary>How far the weights move the vertices, which they are moved by.</summary>
        public void Sum(
            CommandBuffer commands, ExpressionBuffers targets, GraphicsBuffer weights, GraphicsBuffer moved, GraphicsBuffer mesh)
        {
            sumTargets.Set(commands, Vertices, targets.Vertices);
            sumTargets.Set(commands, Starts, targets.Starts);
            sumTargets.Set(commands, EntryExpressions, targets.Expressions);
            sumTargets.Set(commands, Offsets, targets.Offsets);
            sumTargets.Set(commands, Weights, weights);
            sumTargets.Set(commands, Moved, moved);
            sumTargets.Set(commands, Mesh, mesh);
            sumTargets.Set(commands, VertexCount, targets.VertexCount);
            Dispatch(commands, sumTargets, targets.VertexCount);
        }

        /// <summary>How the triangles in reach bend.</summary>
        public void Bend(
            CommandBuffer commands, AvatarBuffers avatar, GraphicsBuffer moved, GraphicsBuffer mesh, GraphicsBuffer bends)
        {
            bendTriangles.Set(commands, Triangles, avatar.Expressions.Triangles);
            bendTriangles.Set(commands, Faces, avatar.Faces);
            bendTriangles.Set(commands, Moved, moved);
            bendTriangles.Set(commands, Mesh, mesh);
            bendTriangles.Set(commands, Bends, bends);
            bendTriangles.Set(commands, TriangleCount, avatar.Expressions.TriangleCount);
            Dispatch(commands, bendTriangles, avatar.Expressions.TriangleCount);
        }

        /// <summary>The texels of a level on these triangles.</summary>
        public void Bend(CommandBuffer commands, LevelBuffers level, GraphicsBuffer bends, GraphicsBuffer texelChannels)
        {
            bendTexels.Set(commands, Reached, level.Reached);
            bendTexels.Set(commands, Bends, bends);
            bendTexels.Set(commands, TexelChannels, texelChannels);
            bendTexels.Set(commands, TexelCount, level.ReachedCount);
            bendTexels.Set(commands, SplatCount, level.SplatCount);
            Dispatch(commands, bendTexels, level.ReachedCount);
        }

        /// <summary>An engine refuses a dispatch of no groups: an expression may move nothing, or nothing that is drawn.</summary>
        private static void Dispatch(CommandBuffer commands, Kernel kernel, int count)
        {
            if (count > 0)
            {
                kernel.Dispatch(commands, Kernel.Groups(count, Expressed), 1, 1);
            }
        }
    }
}
