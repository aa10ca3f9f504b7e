using System;
using UnityEngine;

namespace Mua
{
    /// <summary>What moves each vertex that any expression moves, on the device (python/mua/player/buffers.py).</summary>
    internal sealed class ExpressionBuffers
    {
        private const string Field = "expressions.vertices";

        private readonly Upload vertices, starts, expressions, offsets, triangles;

        /// <param name="targets">What they hold.</param>
        /// <param name="add">Takes what is to be uploaded.</param>
        public ExpressionBuffers(ExpressionTargets targets, Func<Upload, Upload> add)
        {
            vertices = add(new Upload(Field, targets.Vertices, sizeof(int)));
            starts = add(new Upload("expressions.starts", targets.Starts, sizeof(int)));
            expressions = add(new Upload(Field, targets.Expressions, sizeof(int)));
            offsets = add(new Upload("expressions.offsets", targets.Offsets, sizeof(float)));
            triangles = add(new Upload(Field, targets.Triangles, sizeof(int)));
        }

        /// <summary>M.</summary>
        public int VertexCount => vertices.Count;

        /// <summary>T.</summary>
        public int TriangleCount => triangles.Count;

        /// <summary>[M]</summary>
        public GraphicsBuffer Vertices => vertices.Buffer;

        /// <summary>[M + 1] into the entries.</summary>
        public GraphicsBuffer Starts => starts.Buffer;

        /// <summary>[P] of each entry.</summary>
        public GraphicsBuffer Expressions => expressions.Buffer;

        /// <summary>[P, 3] metres.</summary>
        public GraphicsBuffer Offsets => offsets.Buffer;

        /// <summary>[T] in reach of the vertices.</summary>
        public GraphicsBuffer Triangles => triangles.Buffer;
    }
}
