using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Vertices that expressions move, and the texels that bend with them: ComputeShaders/expressions.compute.</summary>
    internal sealed class Expressions
    {
        private const string File = "expressions.compute";
        private const int Expressed = 64; // vertices or triangles of a group

        private static readonly int Vertices = Shader.PropertyToID("vertices");
        private static readonly int Starts = Shader.PropertyToID("starts");
        private static readonly int EntryExpressions = Shader.PropertyToID("expressions");
        private static readonly int Changes = Shader.PropertyToID("changes");
        private static readonly int Weights = Shader.PropertyToID("weights");
        private static readonly int Corners = Shader.PropertyToID("corners");
        private static readonly int Stars = Shader.PropertyToID("stars");
        private static readonly int Moved = Shader.PropertyToID("moved");
        private static readonly int Mesh = Shader.PropertyToID("mesh");
        private static readonly int TriangleBends = Shader.PropertyToID("triangle_bends");
        private static readonly int VertexBends = Shader.PropertyToID("vertex_bends");
        private static readonly int Faces = Shader.PropertyToID("faces");
        private static readonly int Texels = Shader.PropertyToID("texels");
        private static readonly int VertexCount = Shader.PropertyToID("vertex_count");
        private static readonly int TriangleCount = Shader.PropertyToID("triangle_count");

        private readonly Kernel sumTargets, bendTriangles, bendVertices, bendTexels, lightTexels;

        public Expressions(ComputeShader shader)
        {
            sumTargets = new Kernel(shader, File, "SumTargets");
            bendTriangles = new Kernel(shader, File, "BendTriangles");
            bendVertices = new Kernel(shader, File, "BendVertices");
            bendTexels = new Kernel(shader, File, "BendTexels");
            lightTexels = new Kernel(shader, File, "LightTexels");
        }

        /// <summary>How far the weights move the vertices, which they are moved by.</summary>
        public void Sum(
            CommandBuffer commands, ExpressionBuffers targets, GraphicsBuffer weights, GraphicsBuffer moved, GraphicsBuffer mesh)
        {
            sumTargets.Set(commands, Vertices, targets.Vertices);
            sumTargets.Set(commands, Starts, targets.Starts);
            sumTargets.Set(commands, EntryExpressions, targets.Expressions);
            sumTargets.Set(commands, Changes, targets.Changes);
            sumTargets.Set(commands, Weights, weights);
            sumTargets.Set(commands, Moved, moved);
            sumTargets.Set(commands, Mesh, mesh);
            sumTargets.Set(commands, VertexCount, targets.VertexCount);
            Dispatch(commands, sumTargets, targets.VertexCount);
        }

        /// <summary>How the triangles in reach bend, and the vertices by them.</summary>
        public void Bend(
            CommandBuffer commands, ExpressionBuffers targets, GraphicsBuffer moved, GraphicsBuffer mesh,
            GraphicsBuffer triangleBends, GraphicsBuffer vertexBends)
        {
            bendTriangles.Set(commands, Corners, targets.Corners);
            bendTriangles.Set(commands, Moved, moved);
            bendTriangles.Set(commands, Mesh, mesh);
            bendTriangles.Set(commands, TriangleBends, triangleBends);
            bendTriangles.Set(commands, TriangleCount, targets.TriangleCount);
            Dispatch(commands, bendTriangles, targets.TriangleCount);

            bendVertices.Set(commands, Vertices, targets.BentVertices);
            bendVertices.Set(commands, Starts, targets.StarStarts);
            bendVertices.Set(commands, Stars, targets.Stars);
            bendVertices.Set(commands, Moved, moved);
            bendVertices.Set(commands, TriangleBends, triangleBends);
            bendVertices.Set(commands, VertexBends, vertexBends);
            bendVertices.Set(commands, VertexCount, targets.BentCount);
            Dispatch(commands, bendVertices, targets.BentCount);
        }

        /// <summary>InverseDwt.UpsampleTexels for geometry; the texels in reach bend as the vertices about them.</summary>
        public void BendTexels(
            CommandBuffer commands, LevelBuffers level, BranchLevel shown, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer texelChannels, GraphicsBuffer faces, GraphicsBuffer vertexBends)
        {
            InverseDwt.SetUpsampling(commands, bendTexels, level, shown, channels, size, ll, texelChannels);
            bendTexels.Set(commands, Faces, faces);
            bendTexels.Set(commands, Texels, level.Texels);
            bendTexels.Set(commands, VertexBends, vertexBends);
            bendTexels.Dispatch(commands, level.TileCount, 1, 1);
        }

        /// <summary>InverseDwt.UpsampleTexels for appearance; the texels in reach are lit as BendTexels left it.</summary>
        public void LightTexels(
            CommandBuffer commands, LevelBuffers level, BranchLevel shown, int channels, int size, GraphicsBuffer ll,
            GraphicsBuffer texelChannels)
        {
            InverseDwt.SetUpsampling(commands, lightTexels, level, shown, channels, size, ll, texelChannels);
            lightTexels.Dispatch(commands, level.TileCount, 1, 1);
        }

        /// <summary>An engine refuses a dispatch of no groups: an expression may move nothing.</summary>
        private static void Dispatch(CommandBuffer commands, Kernel kernel, int count)
        {
            if (count > 0)
            {
                kernel.Dispatch(commands, Kernel.Groups(count, Expressed), 1, 1);
            }
        }
    }
}
