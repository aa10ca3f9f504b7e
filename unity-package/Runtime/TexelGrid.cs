using System;
using System.Collections.Generic;
using Mua.Format;

namespace Mua
{
    /// <summary>
    /// The texel grid as one closed triangle mesh over the splats' centres: the triangles of
    /// python/mua/player/surface.py, in its order. A second of work for a large avatar; it may run on any thread.
    /// </summary>
    internal sealed class TexelGrid
    {
        private const double Stretch = 2.5; // times its texel's footprint that an edge may span; more crosses a slit

        private TexelGrid(int[] triangles, int count)
        {
            Triangles = triangles;
            RingStarts = new int[count + 1];
            Ring = new int[2 * triangles.Length];
            FillRings();
        }

        /// <summary>[T, 3] into the texels, counter-clockwise seen from outside.</summary>
        public int[] Triangles { get; }

        /// <summary>[N + 1] into Ring.</summary>
        public int[] RingStarts { get; }

        /// <summary>[3 T, 2] the other two corners of each triangle about a texel, in turning order.</summary>
        public int[] Ring { get; }

        /// <summary>Triangulates the texels of an avatar.</summary>
        public static TexelGrid Build(AvatarFile avatar)
        {
            var triangles = new List<int>();
            if (avatar.Texels.Count > 0)
            {
                var rest = new TexelRest(avatar);
                int[] rank = Ranks(rest);
                AddInner(rest, rank, triangles);
                TexelSeams.Add(rest, rank, triangles);
                TexelHoles.Fill(rest, triangles);
            }
            return new TexelGrid(triangles.ToArray(), avatar.Texels.Count);
        }

        /// <summary>[Size + 1, Size + 1] which texel lies at a row and column, or -1.</summary>
        private static int[] Ranks(TexelRest rest)
        {
            int width = rest.Size + 1;
            var rank = new int[width * width];
            for (int i = 0; i < rank.Length; i++)
            {
                rank[i] = -1;
            }
            for (int i = 0; i < rest.Texels.Length; i++)
            {
                rank[rest.Texels[i] / rest.Size * width + rest.Texels[i] % rest.Size] = i;
            }
            return rank;
        }

        /// <summary>The triangles of the 2 x 2 blocks of texels that lie in one chart.</summary>
        private static void AddInner(TexelRest rest, int[] rank, List<int> triangles)
        {
            int width = rest.Size + 1;
            double[] turning = Turning(rest);
            for (int half = 0; half < 4; half++)
            {
                for (int row = 0; row < rest.Size; row++)
                {
                    for (int column = 0; column < rest.Size; column++)
                    {
                        int at = row * width + column;
                        AddHalf(
                            rest, turning, half, rank[at], rank[at + 1], rank[at + width], rank[at + width + 1],
                            triangles);
                    }
                }
            }
        }

        /// <summary>
        /// One of the four halves of a block a b / c d that its two diagonals make, if it is the one to take: the shorter
        /// diagonal cuts, and a block with one empty corner keeps the triangle of the other three.
        /// </summary>
        private static void AddHalf(
            TexelRest rest, double[] turning, int half, int a, int b, int c, int d, List<int> triangles)
        {
            int first = half == 3 ? b : a, second = half == 0 || half == 2 ? b : d, third = half == 0 ? d : c;
            int left = half == 0 ? c : half == 1 ? b : half == 2 ? d : a; // the corner that this half does not have
            if (first < 0 || second < 0 || third < 0)
            {
                return;
            }
            if (left >= 0)
            {
                double[] places = rest.Places;
                bool falling = TexelRest.Squared(places, a, places, d) <= TexelRest.Squared(places, b, places, c);
                if (falling != half < 2)
                {
                    return;
                }
            }
            int chart = rest.ChartOf(first);
            double[] footprints = rest.Footprints;
            double most = Math.Max(Math.Max(footprints[first], footprints[second]), footprints[third]);
            bool isWhole = chart == rest.ChartOf(second) && chart == rest.ChartOf(third)
                && Math.Sqrt(rest.LongestSquared(first, second, third)) <= Stretch * most;
            if (isWhole)
            {
                bool isTurned = turning[chart] < 0; // a mirrored chart
                triangles.Add(isTurned ? third : first);
                triangles.Add(second);
                triangles.Add(isTurned ? first : third);
            }
        }

        /// <summary>Signed area of each chart in UV.</summary>
        private static double[] Turning(TexelRest rest)
        {
            var areas = new double[rest.Charts.Length];
            for (int face = 0; face < areas.Length; face++)
            {
                areas[rest.Charts[face]] += rest.SignedArea(face);
            }
            return areas;
        }

        private void FillRings()
        {
            foreach (int corner in Triangles)
            {
                RingStarts[corner + 1]++;
            }
            for (int i = 1; i < RingStarts.Length; i++)
            {
                RingStarts[i] += RingStarts[i - 1];
            }
            var filled = new int[RingStarts.Length];
            for (int turn = 0; turn < 3; turn++)
            {
                for (int first = 0; first < Triangles.Length; first += 3)
                {
                    int corner = Triangles[first + turn], at = 2 * (RingStarts[corner] + filled[corner]++);
                    Ring[at] = Triangles[first + (turn + 1) % 3];
                    Ring[at + 1] = Triangles[first + (turn + 2) % 3];
                }
            }
        }
    }
}
