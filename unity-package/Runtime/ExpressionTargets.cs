using System;
using Mua.Format;

namespace Mua
{
    /// <summary>
    /// Expressions as the kernels read them: what moves each vertex, and the triangles that these bend. It may be made on any
    /// thread. Reference: python/mua/kernels/expressions.py.
    /// </summary>
    internal sealed class ExpressionTargets
    {
        private readonly int[] places; // [F] among Triangles; -1 for those out of reach

        /// <summary>Those of a file; empty where it has none.</summary>
        public ExpressionTargets(AvatarFile avatar)
        {
            Format.Expressions held = avatar.Expressions;
            int count = held == null ? 0 : held.Vertices.Count;
            int[] firsts = Firsts(held, avatar.Coarse.Mean.Shape[0]);
            Vertices = Moved(firsts);
            Starts = Append(Array.ConvertAll(Vertices, vertex => firsts[vertex]), count);
            Expressions = new int[count];
            Offsets = new float[3 * count];
            places = new int[avatar.Template.Faces.Shape[0]];
            Triangles = Reached(avatar.Template.Faces.Integers, firsts);
            if (held != null)
            {
                Fill(held, firsts);
            }
        }

        /// <summary>[M] of the template, ascending: all that any expression moves.</summary>
        public int[] Vertices { get; }

        /// <summary>[M + 1] into the entries, vertex by vertex.</summary>
        public int[] Starts { get; }

        /// <summary>[P] of each entry, ascending for a vertex.</summary>
        public int[] Expressions { get; }

        /// <summary>[P, 3] metres.</summary>
        public float[] Offsets { get; }

        /// <summary>[T] into the faces, ascending: those with a corner among the vertices.</summary>
        public int[] Triangles { get; }

        /// <summary>[K, 2] of a level: texels on these triangles, and their triangle's place among them.</summary>
        public int[] Reached(DetailLevel level)
        {
            int count = 0;
            foreach (int triangle in level.Triangles)
            {
                count += places[triangle] >= 0 ? 1 : 0;
            }
            var reached = new int[2 * count];
            int next = 0;
            for (int texel = 0; texel < level.Count; texel++)
            {
                int place = places[level.Triangles[texel]];
                if (place >= 0)
                {
                    reached[next++] = texel;
                    reached[next++] = place;
                }
            }
            return reached;
        }

        /// <summary>[V + 1] first entry of each vertex.</summary>
        private static int[] Firsts(Format.Expressions held, int vertices)
        {
            var firsts = new int[vertices + 1];
            if (held != null)
            {
                foreach (int vertex in held.Vertices.Integers)
                {
                    firsts[vertex + 1]++;
                }
            }
            for (int vertex = 0; vertex < vertices; vertex++)
            {
                firsts[vertex + 1] += firsts[vertex];
            }
            return firsts;
        }

        private static int[] Moved(int[] firsts)
        {
            var moved = new int[firsts.Length - 1];
            int count = 0;
            for (int vertex = 0; vertex < moved.Length; vertex++)
            {
                if (firsts[vertex + 1] > firsts[vertex])
                {
                    moved[count++] = vertex;
                }
            }
            Array.Resize(ref moved, count);
            return moved;
        }

        private static int[] Append(int[] values, int last)
        {
            Array.Resize(ref values, values.Length + 1);
            values[values.Length - 1] = last;
            return values;
        }

        /// <summary>The faces with a corner that has entries, whose places it notes.</summary>
        private int[] Reached(ReadOnlySpan<int> faces, int[] firsts)
        {
            var reached = new int[places.Length];
            int count = 0;
            for (int face = 0; face < places.Length; face++)
            {
                bool isHeld = false;
                foreach (int vertex in faces.Slice(3 * face, 3))
                {
                    isHeld |= firsts[vertex + 1] > firsts[vertex];
                }
                places[face] = isHeld ? count : -1;
                if (isHeld)
                {
                    reached[count++] = face;
                }
            }
            Array.Resize(ref reached, count);
            return reached;
        }

        private void Fill(Format.Expressions held, int[] next)
        {
            ReadOnlySpan<int> starts = held.Starts.Integers, vertices = held.Vertices.Integers;
            for (int expression = 0; expression < held.Names.Length; expression++)
            {
                for (int entry = starts[expression]; entry < starts[expression + 1]; entry++)
                {
                    int at = next[vertices[entry]]++;
                    Expressions[at] = expression;
                    for (int axis = 0; axis < 3; axis++)
                    {
                        Offsets[3 * at + axis] = held.Offsets.Read(3 * entry + axis);
                    }
                }
            }
        }
    }
}
