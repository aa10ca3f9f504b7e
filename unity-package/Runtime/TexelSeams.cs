using System;
using System.Collections.Generic;

namespace Mua
{
    /// <summary>
    /// Triangles of texels that zip both sides of every edge of the template that UV or charts cut (`_seams` and
    /// `_fitting` of python/mua/player/surface.py).
    /// </summary>
    internal sealed class TexelSeams
    {
        private const double Step = 0.5; // texels between samples along a seam, so that no texel beside it is left out
        private const double Reach = 4; // texels from a seam to its chart's nearest; else the nearest in space is taken

        private readonly TexelRest rest;
        private readonly int[] rank;
        private readonly double density; // texels for each metre of the surface
        private readonly List<int> first = new List<int>(); // triangles with two corners on the right
        private readonly List<int> second = new List<int>(); // triangles with two corners on the left

        private TexelSeams(TexelRest rest, int[] rank)
        {
            this.rest = rest;
            this.rank = rank;
            density = Math.Sqrt(2) / Median(rest.Footprints);
        }

        /// <summary>Appends those that fit beside the triangles that there are; `rank` is TexelGrid's.</summary>
        public static void Add(TexelRest rest, int[] rank, List<int> triangles)
        {
            var seams = new TexelSeams(rest, rank);
            seams.ZipAll();
            seams.first.AddRange(seams.second);
            seams.AddFitting(triangles);
        }

        private void ZipAll()
        {
            int[] faces = rest.Faces;
            long count = rest.Vertices.Length / 3;
            var half = new Dictionary<long, int>(faces.Length); // the first edge from one vertex to another
            for (int edge = 0; edge < faces.Length; edge++)
            {
                long name = faces[edge] * count + faces[Next(edge)];
                if (!half.ContainsKey(name))
                {
                    half[name] = edge;
                }
            }
            for (int edge = 0; edge < faces.Length; edge++)
            {
                int start = faces[edge], end = faces[Next(edge)];
                if (start < end && half.TryGetValue(end * count + start, out int other) && IsCut(edge, other))
                {
                    Zip(edge, other);
                }
            }
        }

        private bool IsCut(int left, int right)
        {
            return rest.UvFaces[left] != rest.UvFaces[Next(right)] || rest.UvFaces[Next(left)] != rest.UvFaces[right]
                || rest.Charts[left / 3] != rest.Charts[right / 3];
        }

        /// <summary>The triangles along one edge, whose two sides run in opposite directions.</summary>
        private void Zip(int left, int right)
        {
            int steps = Math.Max(Steps(left, Next(left)), Steps(Next(right), right));
            int a = -1, b = -1;
            for (int step = 0; step <= steps; step++)
            {
                double t = (double)step / steps;
                int nextA = Nearest(left, left, Next(left), left, t), nextB = Nearest(right, Next(right), right, left, t);
                if (step > 0)
                {
                    Add(first, b, nextB, nextA);
                    Add(second, b, nextA, a);
                }
                a = nextA;
                b = nextB;
            }
        }

        private int Steps(int start, int end)
        {
            int a = 2 * rest.UvFaces[start], b = 2 * rest.UvFaces[end];
            double x = rest.Uv[b] * rest.Size - rest.Uv[a] * rest.Size;
            double y = rest.Uv[b + 1] * rest.Size - rest.Uv[a + 1] * rest.Size;
            return Math.Max((int)Math.Ceiling(Math.Sqrt(x * x + y * y) / Step), 1);
        }

        /// <summary>
        /// The texel of the chart of `edge` nearest to the point at a share t between two UV corners, in texture and in
        /// space together: in space alone it could lie across the seam, in the texture alone on another limb.
        /// </summary>
        private int Nearest(int edge, int start, int end, int left, double t)
        {
            double x = Between(rest.Uv, 2 * rest.UvFaces[start], 2 * rest.UvFaces[end], rest.Size, t);
            double y = Between(rest.Uv, 2 * rest.UvFaces[start] + 1, 2 * rest.UvFaces[end] + 1, rest.Size, t);
            var place = new double[3];
            for (int axis = 0; axis < 3; axis++)
            {
                place[axis] = Between(
                    rest.Vertices, 3 * rest.Faces[left] + axis, 3 * rest.Faces[Next(left)] + axis, 1, t);
            }
            int chart = rest.Charts[edge / 3], width = rest.Size + 1, nearest = -1;
            double least = Reach * Reach;
            int lastRow = Math.Min((int)Math.Ceiling(y + Reach), rest.Size - 1);
            int lastColumn = Math.Min((int)Math.Ceiling(x + Reach), rest.Size - 1);
            for (int row = Math.Max((int)Math.Floor(y - Reach) - 1, 0); row <= lastRow; row++)
            {
                for (int column = Math.Max((int)Math.Floor(x - Reach) - 1, 0); column <= lastColumn; column++)
                {
                    int texel = rank[row * width + column];
                    if (texel < 0 || rest.ChartOf(texel) != chart)
                    {
                        continue;
                    }
                    double across = column + 0.5 - x, down = row + 0.5 - y;
                    double squared = across * across + down * down
                        + density * density * TexelRest.Squared(rest.Places, texel, place, 0);
                    if (squared < least || (nearest < 0 && squared <= least))
                    {
                        least = squared;
                        nearest = texel;
                    }
                }
            }
            return nearest >= 0 ? nearest : NearestInSpace(place);
        }

        /// <summary>For the few charts that are smaller than a texel.</summary>
        private int NearestInSpace(double[] place)
        {
            int nearest = 0;
            double least = double.PositiveInfinity;
            for (int texel = 0; texel < rest.Texels.Length; texel++)
            {
                double squared = TexelRest.Squared(rest.Places, texel, place, 0);
                if (squared < least)
                {
                    least = squared;
                    nearest = texel;
                }
            }
            return nearest;
        }

        /// <summary>
        /// Appends the triangles of three different corners that share no edge, in the same direction, with those that
        /// there are or with a smaller one: they would fold over the surface, and leave open edges that form no loop.
        /// </summary>
        private void AddFitting(List<int> triangles)
        {
            int count = first.Count / 3;
            var longest = new double[count];
            var order = new List<int>();
            for (int i = 0; i < count; i++)
            {
                int a = first[3 * i], b = first[3 * i + 1], c = first[3 * i + 2];
                if (a != b && b != c && c != a)
                {
                    longest[i] = Math.Sqrt(rest.LongestSquared(a, b, c));
                    order.Add(i);
                }
            }
            order.Sort((i, j) => longest[i].Equals(longest[j]) ? i.CompareTo(j) : longest[i].CompareTo(longest[j]));
            long[] grid = TexelHoles.Edges(triangles, rest.Texels.Length);
            var taken = new HashSet<long>();
            foreach (int i in order)
            {
                long ab = Name(3 * i, 3 * i + 1), bc = Name(3 * i + 1, 3 * i + 2), ca = Name(3 * i + 2, 3 * i);
                bool isFree = Array.BinarySearch(grid, ab) < 0 && Array.BinarySearch(grid, bc) < 0
                    && Array.BinarySearch(grid, ca) < 0;
                if (isFree && !taken.Contains(ab) && !taken.Contains(bc) && !taken.Contains(ca))
                {
                    taken.Add(ab);
                    taken.Add(bc);
                    taken.Add(ca);
                    Add(triangles, first[3 * i], first[3 * i + 1], first[3 * i + 2]);
                }
            }
        }

        private long Name(int start, int end)
        {
            return (long)first[start] * rest.Texels.Length + first[end];
        }

        private static void Add(List<int> triangles, int a, int b, int c)
        {
            triangles.Add(a);
            triangles.Add(b);
            triangles.Add(c);
        }

        /// <summary>The edge after one of the three of its face.</summary>
        private static int Next(int edge)
        {
            return edge % 3 == 2 ? edge - 2 : edge + 1;
        }

        private static double Between(double[] values, int from, int to, double scale, double t)
        {
            return values[from] * scale * (1 - t) + values[to] * scale * t;
        }

        private static double Median(double[] values)
        {
            var sorted = (double[])values.Clone();
            Array.Sort(sorted);
            int middle = sorted.Length / 2;
            return sorted.Length % 2 == 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
        }
    }
}
