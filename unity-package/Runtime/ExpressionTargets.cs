using System;
using Mua.Format;

namespace Mua
{
    /// <summary>
    /// Expressions as the kernels read them: what moves each vertex, and the triangles about these and about their neighbours,
    /// which they bend. It may be made on any thread. Reference: python/mua/kernels/expressions.py.
    /// </summary>
    internal sealed class ExpressionTargets
    {
        private readonly bool[] isReached; // [F]

        /// <summary>Those of a file; empty where it has none.</summary>
        public ExpressionTargets(AvatarFile avatar)
        {
            Format.Expressions held = avatar.Expressions;
            int count = held == null ? 0 : held.Vertices.Count;
            int[] firsts = Firsts(held, avatar.Coarse.Mean.Shape[0]);
            Vertices = Moved(firsts);
            Starts = Append(Array.ConvertAll(Vertices, vertex => firsts[vertex]), count);
            Expressions = new int[(count + 1) / 2];
            Changes = new int[2 * count];
            isReached = new bool[avatar.Template.Faces.Shape[0]];
            ReadOnlySpan<int> faces = avatar.Template.Faces.Integers;
            bool[] moves = new bool[firsts.Length - 1];
            foreach (int vertex in Vertices)
            {
                moves[vertex] = true;
            }
            Corners = Reached(faces, Beside(faces, moves));
            var places = (int[])Corners.Clone();
            BentVertices = Place(places, moves.Length);
            StarStarts = new int[BentVertices.Length + 1];
            Stars = Collect(places, StarStarts);
            if (held != null)
            {
                Fill(held, firsts);
            }
        }

        /// <summary>[M] of the template, ascending: all that any expression moves.</summary>
        public int[] Vertices { get; }

        /// <summary>[M + 1] into the entries, vertex by vertex.</summary>
        public int[] Starts { get; }

        /// <summary>[P / 2] of each entry, ascending for a vertex, in 16 bits.</summary>
        public int[] Expressions { get; }

        /// <summary>[P, 2] offset in metres and gain, as half floats.</summary>
        public int[] Changes { get; }

        /// <summary>[T, 3] vertices of the triangles in reach.</summary>
        public int[] Corners { get; }

        /// <summary>[B] of the template, ascending: all corners of these triangles.</summary>
        public int[] BentVertices { get; }

        /// <summary>[B + 1] into Stars.</summary>
        public int[] StarStarts { get; }

        /// <summary>[3 T] vertex by vertex, the places of the triangles about it.</summary>
        public int[] Stars { get; }

        /// <summary>Whether expressions may bend a triangle, and the texels on it.</summary>
        public bool IsReached(int triangle)
        {
            return isReached[triangle];
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

        /// <summary>Which vertices have a neighbour that moves, or do so themselves.</summary>
        private static bool[] Beside(ReadOnlySpan<int> faces, bool[] moves)
        {
            var beside = new bool[moves.Length];
            for (int face = 0; face < faces.Length; face += 3)
            {
                if (moves[faces[face]] || moves[faces[face + 1]] || moves[faces[face + 2]])
                {
                    beside[faces[face]] = beside[faces[face + 1]] = beside[faces[face + 2]] = true;
                }
            }
            return beside;
        }

        /// <summary>The corners of the faces that have one of these vertices, which it notes.</summary>
        private int[] Reached(ReadOnlySpan<int> faces, bool[] beside)
        {
            var reached = new int[faces.Length];
            int count = 0;
            for (int face = 0; face < isReached.Length; face++)
            {
                ReadOnlySpan<int> own = faces.Slice(3 * face, 3);
                isReached[face] = beside[own[0]] || beside[own[1]] || beside[own[2]];
                if (isReached[face])
                {
                    own.CopyTo(reached.AsSpan(3 * count++));
                }
            }
            Array.Resize(ref reached, 3 * count);
            return reached;
        }

        /// <summary>The vertices that corners are, whose places among them take their stead.</summary>
        private static int[] Place(int[] corners, int vertices)
        {
            var place = new int[vertices];
            foreach (int vertex in corners)
            {
                place[vertex] = 1;
            }
            var held = new int[vertices];
            int count = 0;
            for (int vertex = 0; vertex < vertices; vertex++)
            {
                if (place[vertex] > 0)
                {
                    place[vertex] = count;
                    held[count++] = vertex;
                }
            }
            for (int i = 0; i < corners.Length; i++)
            {
                corners[i] = place[corners[i]];
            }
            Array.Resize(ref held, count);
            return held;
        }

        /// <summary>The triangles about each vertex, ascending.</summary>
        private static int[] Collect(int[] corners, int[] starts)
        {
            foreach (int corner in corners)
            {
                starts[corner + 1]++;
            }
            for (int vertex = 1; vertex < starts.Length; vertex++)
            {
                starts[vertex] += starts[vertex - 1];
            }
            var next = (int[])starts.Clone();
            var stars = new int[corners.Length];
            for (int i = 0; i < corners.Length; i++)
            {
                stars[next[corners[i]]++] = i / 3;
            }
            return stars;
        }

        private void Fill(Format.Expressions held, int[] next)
        {
            ReadOnlySpan<int> starts = held.Starts.Integers, vertices = held.Vertices.Integers;
            for (int expression = 0; expression < held.Names.Length; expression++)
            {
                for (int entry = starts[expression]; entry < starts[expression + 1]; entry++)
                {
                    int at = next[vertices[entry]]++;
                    Expressions[at / 2] |= expression << 16 * (at % 2);
                    float gain = held.Gains == null ? 0 : held.Gains.Read(entry);
                    Changes[2 * at] = Pair(held.Offsets.Read(3 * entry), held.Offsets.Read(3 * entry + 1));
                    Changes[2 * at + 1] = Pair(held.Offsets.Read(3 * entry + 2), gain);
                }
            }
        }

        private static int Pair(float low, float high)
        {
            return Half.FromSingle(low) | Half.FromSingle(high) << 16;
        }
    }
}
