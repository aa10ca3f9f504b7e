using System;

namespace Mua
{
    /// <summary>
    /// UV charts of the template (find_charts of python/mua/rig/charts.py): faces that share an edge in space and in UV and
    /// are not folded over it; a folded sliver stays with a neighbour.
    /// </summary>
    internal static class TexelCharts
    {
        private const double Speck = 4.0 / (512 * 512); // area in UV below which a fold is no chart

        /// <summary>[F] a number for each face, the same throughout a chart.</summary>
        public static int[] Find(TexelRest rest)
        {
            int count = rest.Faces.Length / 3;
            var low = new long[3 * count]; // of each edge, its two nodes in order
            var high = new long[3 * count];
            int[] order = Sorted(rest, low, high);
            var parents = new int[count];
            for (int face = 0; face < count; face++)
            {
                parents[face] = face;
            }
            for (int i = 1; i < order.Length; i++)
            {
                int a = order[i - 1], b = order[i];
                bool isSame = low[a] == low[b] && high[a] == high[b];
                if (isSame && Math.Sign(rest.SignedArea(a / 3)) * Math.Sign(rest.SignedArea(b / 3)) >= 0)
                {
                    parents[Root(parents, a / 3)] = Root(parents, b / 3);
                }
            }
            return Joined(rest, parents, order, low, high);
        }

        /// <summary>Edges [3 F] by their nodes; a node is a vertex and a UV corner.</summary>
        private static int[] Sorted(TexelRest rest, long[] low, long[] high)
        {
            long corners = rest.Uv.Length / 2;
            var order = new int[low.Length];
            for (int edge = 0; edge < order.Length; edge++)
            {
                int next = edge % 3 == 2 ? edge - 2 : edge + 1;
                long start = rest.Faces[edge] * corners + rest.UvFaces[edge];
                long end = rest.Faces[next] * corners + rest.UvFaces[next];
                low[edge] = Math.Min(start, end);
                high[edge] = Math.Max(start, end);
                order[edge] = edge;
            }
            Array.Sort(order, (a, b) => Compare(low, high, a, b));
            return order;
        }

        private static int Compare(long[] low, long[] high, int a, int b)
        {
            int byLow = low[a].CompareTo(low[b]);
            int byHigh = byLow != 0 ? byLow : high[a].CompareTo(high[b]);
            return byHigh != 0 ? byHigh : a.CompareTo(b);
        }

        private static int Root(int[] parents, int face)
        {
            while (parents[face] != face)
            {
                parents[face] = parents[parents[face]];
                face = parents[face];
            }
            return face;
        }

        /// <summary>Charts, each speck with a larger one beside it.</summary>
        private static int[] Joined(TexelRest rest, int[] parents, int[] order, long[] low, long[] high)
        {
            var charts = new int[parents.Length];
            var areas = new double[parents.Length];
            var joins = new int[parents.Length];
            for (int face = 0; face < charts.Length; face++)
            {
                charts[face] = Root(parents, face);
                areas[charts[face]] += Math.Abs(rest.SignedArea(face));
                joins[face] = face;
            }
            for (int side = 0; side < 2; side++)
            {
                for (int i = 1; i < order.Length; i++)
                {
                    int a = order[i - 1], b = order[i];
                    int one = charts[(side == 0 ? a : b) / 3], other = charts[(side == 0 ? b : a) / 3];
                    if (low[a] == low[b] && high[a] == high[b] && areas[one] < Speck && areas[other] >= Speck)
                    {
                        joins[one] = other;
                    }
                }
            }
            for (int face = 0; face < charts.Length; face++)
            {
                charts[face] = joins[charts[face]];
            }
            return charts;
        }
    }
}
