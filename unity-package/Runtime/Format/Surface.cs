using System;
using System.Collections.Generic;

namespace Mua.Format
{
    /// <summary>Triangles over the texels (python/mua/rig/surface.py; section 8 of schemas/README.md).</summary>
    public sealed class Surface
    {
        internal const int RunShift = 4, CodeMask = 15; // a byte of Runs counts blocks, less one, and holds their code
        internal const int End = -1; // of a strip

        /// <summary>Codes of the blocks, by runs.</summary>
        public ArraySegment<byte> Runs { get; internal set; }

        /// <summary>Corners of what the blocks leave open: twice a texel, and one more where the edge keeps its start.</summary>
        public Tensor Strips { get; internal set; }

        /// <summary>[T, 3] into the texels, by whose map it was made, counter-clockwise seen from outside.</summary>
        public int[] Triangles(Texels texels)
        {
            var triangles = new List<int>();
            var blocks = new BlockWalk(texels);
            foreach (byte run in Runs.AsSpan())
            {
                for (int left = run >> RunShift; left >= 0 && blocks.Next(); left--)
                {
                    blocks.Add(run & CodeMask, triangles);
                }
            }
            AddStrips(triangles);
            return triangles.ToArray();
        }

        private void AddStrips(List<int> triangles)
        {
            int start = -1, end = -1; // of the edge that the next corner makes a triangle with
            foreach (int entry in Strips.Integers)
            {
                int corner = entry >> 1;
                if (entry == End)
                {
                    start = end = -1;
                }
                else if (start < 0)
                {
                    start = corner;
                }
                else if (end < 0)
                {
                    end = corner;
                }
                else
                {
                    triangles.Add(start);
                    triangles.Add(end);
                    triangles.Add(corner);
                    start = entry % 2 == 0 ? corner : start;
                    end = entry % 2 == 0 ? end : corner;
                }
            }
        }
    }
}
