using System;
using UnityEngine;

namespace Mua
{
    /// <summary>What moves each vertex that any expression moves, and what it bends, on the device (python/mua/player/buffers.py).</summary>
    internal sealed class ExpressionBuffers
    {
        private const string Field = "expressions.vertices";

        private readonly Upload vertices, starts, expressions, changes, corners, bentVertices, starStarts, stars;

        /// <param name="targets">What they hold.</param>
        /// <param name="add">Takes what is to be uploaded.</param>
        public ExpressionBuffers(ExpressionTargets targets, Func<Upload, Upload> add)
        {
            vertices = add(new Upload(Field, targets.Vertices, sizeof(int)));
            starts = add(new Upload("expressions.starts", targets.Starts, sizeof(int)));
            expressions = add(new Upload(Field, targets.Expressions, sizeof(int)));
            changes = add(new Upload("expressions.offsets", targets.Changes, 2 * sizeof(int)));
            corners = add(new Upload(Field, targets.Corners, sizeof(int)));
            bentVertices = add(new Upload(Field, targets.BentVertices, sizeof(int)));
            starStarts = add(new Upload(Field, targets.StarStarts, sizeof(int)));
            stars = add(new Upload(Field, targets.Stars, sizeof(int)));
        }

        /// <summary>M.</summary>
        public int VertexCount => vertices.Count;

        /// <summary>T.</summary>
        public int TriangleCount => corners.Count / 3;

        /// <summary>B.</summary>
        public int BentCount => bentVertices.Count;

        /// <summary>[M]</summary>
        public GraphicsBuffer Vertices => vertices.Buffer;

        /// <summary>[M + 1] into the entries.</summary>
        public GraphicsBuffer Starts => starts.Buffer;

        /// <summary>[P / 2] of each entry, in 16 bits.</summary>
        public GraphicsBuffer Expressions => expressions.Buffer;

        /// <summary>[P] offset in metres and gain, half floats.</summary>
        public GraphicsBuffer Changes => changes.Buffer;

        /// <summary>[T, 3] vertices of the triangles in reach.</summary>
        public GraphicsBuffer Corners => corners.Buffer;

        /// <summary>[B] all of these.</summary>
        public GraphicsBuffer BentVertices => bentVertices.Buffer;

        /// <summary>[B + 1] into Stars.</summary>
        public GraphicsBuffer StarStarts => starStarts.Buffer;

        /// <summary>[3 T] vertex by vertex, the places of the triangles about it.</summary>
        public GraphicsBuffer Stars => stars.Buffer;
    }
}
