using System;
using System.Collections.Generic;

namespace Mua
{
    /// <summary>Triangles that close the holes of the texel grid (`_patches` of python/mua/player/surface.py).</summary>
    internal static class TexelHoles
    {
        private const int SmallHole = 12; // edges round a hole that is closed wherever it is

        /// <summary>
        /// Appends a fan for every loop of open edges that is short, or that lies farther from every opening of the
        /// template than it is wide.
        /// </summary>
        public static void Fill(TexelRest rest, List<int> triangles)
        {
            List<int[]> rims = Openings(new List<int>(rest.Faces), rest.Vertices.Length / 3);
            foreach (int[] loop in Openings(triangles, rest.Texels.Length))
            {
                if (loop.Length < 3 || (loop.Length > SmallHole && !IsApart(rest, loop, rims)))
                {
                    continue;
                }
                for (int i = 1; i < loop.Length - 1; i++)
                {
                    triangles.Add(loop[0]);
                    triangles.Add(loop[i]);
                    triangles.Add(loop[i + 1]);
                }
            }
        }

        /// <summary>A number for each directed edge of triangles over `count` corners, ascending.</summary>
        public static long[] Edges(List<int> triangles, int count)
        {
            var edges = new long[triangles.Count];
            for (int i = 0; i < edges.Length; i++)
            {
                edges[i] = (long)triangles[i] * count + triangles[i % 3 == 2 ? i - 2 : i + 1];
            }
            Array.Sort(edges);
            return edges;
        }

        private static bool IsApart(TexelRest rest, int[] loop, List<int[]> rims)
        {
            double width = 0;
            for (int axis = 0; axis < 3; axis++)
            {
                double low = double.PositiveInfinity, high = double.NegativeInfinity;
                foreach (int corner in loop)
                {
                    low = Math.Min(low, rest.Places[3 * corner + axis]);
                    high = Math.Max(high, rest.Places[3 * corner + axis]);
                }
                width = Math.Max(width, high - low);
            }
            foreach (int[] rim in rims)
            {
                foreach (int vertex in rim)
                {
                    foreach (int corner in loop)
                    {
                        if (Math.Sqrt(TexelRest.Squared(rest.Places, corner, rest.Vertices, vertex)) <= width)
                        {
                            return false;
                        }
                    }
                }
            }
            return true;
        }

        /// <summary>Every simple loop of edges that belong to one triangle, in the order of a triangle that fills it.</summary>
        private static List<int[]> Openings(List<int> triangles, int count)
        {
            long[] edges = Edges(triangles, count);
            var tops = new int[count]; // of each corner's stack of corners that follow it, plus one
            var below = new int[triangles.Count];
            var firsts = new List<int>();
            for (int i = 0; i < triangles.Count; i++)
            {
                int start = triangles[i], end = triangles[i % 3 == 2 ? i - 2 : i + 1];
                if (Array.BinarySearch(edges, (long)end * count + start) >= 0)
                {
                    continue;
                }
                if (tops[end] == 0)
                {
                    firsts.Add(end);
                }
                below[i] = tops[end];
                tops[end] = i + 1;
            }
            var loops = new List<int[]>();
            var path = new List<int>();
            var places = new int[count]; // in the path, plus one
            foreach (int first in firsts)
            {
                path.Add(first);
                places[first] = 1;
                while (tops[path[path.Count - 1]] > 0)
                {
                    int edge = tops[path[path.Count - 1]] - 1, corner = triangles[edge];
                    tops[path[path.Count - 1]] = below[edge];
                    Follow(corner, path, places, loops);
                }
                foreach (int corner in path)
                {
                    places[corner] = 0;
                }
                path.Clear();
            }
            return loops;
        }

        /// <summary>Goes on to a corner; where the path has been there, what lies between is a loop and leaves it.</summary>
        private static void Follow(int corner, List<int> path, int[] places, List<int[]> loops)
        {
            if (places[corner] == 0)
            {
                path.Add(corner);
                places[corner] = path.Count;
                return;
            }
            int start = places[corner] - 1, length = path.Count - start;
            loops.Add(path.GetRange(start, length).ToArray());
            for (int i = start + 1; i < path.Count; i++)
            {
                places[path[i]] = 0;
            }
            path.RemoveRange(start + 1, length - 1);
        }
    }
}
