using System;

namespace Mua.Format
{
    /// <summary>The surface of a parsed tree, checked as in python/mua/asset/read.py.</summary>
    internal static class SurfaceDecoder
    {
        /// <summary>Null where the file holds none.</summary>
        public static Surface Decode(Table tree, Tensors tensors, byte[] content, Texels texels)
        {
            if (tree == null)
            {
                return null;
            }
            Block block = tree.Block("runs");
            var runs = new ArraySegment<byte>(content, block.Offset, block.Count);
            RequireCodes(runs, texels);
            Tensor strips = tensors.Indices(
                tree.Child("strips"), "surface.strips", Surface.End, 2L * texels.Count, Tensors.Any);
            return new Surface { Runs = runs, Strips = strips };
        }

        /// <summary>Refuses another number of codes than of blocks, or a triangle at a corner that is no texel.</summary>
        private static void RequireCodes(ArraySegment<byte> runs, Texels texels)
        {
            var blocks = new BlockWalk(texels);
            long codes = 0, count = 0;
            bool isSound = true;
            foreach (byte run in runs.AsSpan())
            {
                for (int left = run >> Surface.RunShift; left >= 0 && blocks.Next(); left--)
                {
                    isSound &= blocks.Holds(run & Surface.CodeMask);
                    count++;
                }
                codes += (run >> Surface.RunShift) + 1;
            }
            while (blocks.Next())
            {
                count++;
            }
            if (codes != count)
            {
                throw new AvatarFormatException("shape", "surface.runs", codes + " codes, expected " + count);
            }
            if (!isSound)
            {
                throw Refusal.Of("surface.runs", "a triangle has a corner that is no valid texel");
            }
        }
    }
}
