using System;
using System.Collections.Generic;

namespace Mua.Format
{
    /// <summary>Goes row by row through the 2 x 2 blocks of texels of which at least three are valid.</summary>
    internal ref struct BlockWalk
    {
        private const int First = 1, Second = 2, Rising = 4, Turned = 8; // bits of a block's code

        private readonly ReadOnlySpan<int> texels;
        private readonly int size;
        private int step; // two for each texel: the block that it is the upper right corner of, then the upper left one
        private int below; // the first texel that is not before the block's lower left corner
        private int a, b, c, d; // which texel is at the corners a, b over c, d; -1 where none is

        public BlockWalk(Texels of) : this()
        {
            texels = of.Indices.Integers;
            size = of.Size;
        }

        /// <summary>Goes on to the next block; false where there is none.</summary>
        public bool Next()
        {
            while (step < 2 * texels.Length)
            {
                int upper = step / 2, texel = texels[upper], column = texel % size;
                bool isRight = step++ % 2 == 0;
                bool isTaken = upper > 0 && texels[upper - 1] == texel - 1; // the block was that texel's
                if (isRight ? column == 0 || isTaken : column == size - 1)
                {
                    continue;
                }
                a = isRight ? -1 : upper;
                b = isRight ? upper : Find(upper + 1, texel + 1);
                int lower = (isRight ? texel - 1 : texel) + size;
                while (below < texels.Length && texels[below] < lower)
                {
                    below++;
                }
                c = Find(below, lower);
                d = Find(c < 0 ? below : below + 1, lower + 1);
                if (Missing() <= 1)
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Whether all corners of a code's triangles are valid texels.</summary>
        public bool Holds(int code)
        {
            bool isRising = (code & Rising) != 0;
            bool hasFirst = a >= 0 && b >= 0 && (isRising ? c : d) >= 0;
            bool hasSecond = (isRising ? b : a) >= 0 && d >= 0 && c >= 0;
            return ((code & First) == 0 || hasFirst) && ((code & Second) == 0 || hasSecond);
        }

        /// <summary>Appends a code's triangles.</summary>
        public void Add(int code, List<int> triangles)
        {
            bool isRising = (code & Rising) != 0, isTurned = (code & Turned) != 0;
            if ((code & First) != 0)
            {
                Add(a, b, isRising ? c : d, isTurned, triangles);
            }
            if ((code & Second) != 0)
            {
                Add(isRising ? b : a, d, c, isTurned, triangles);
            }
        }

        private static void Add(int one, int two, int three, bool isTurned, List<int> triangles)
        {
            triangles.Add(isTurned ? three : one);
            triangles.Add(two);
            triangles.Add(isTurned ? one : three);
        }

        private int Find(int at, int texel)
        {
            return at < texels.Length && texels[at] == texel ? at : -1;
        }

        private int Missing()
        {
            return (a < 0 ? 1 : 0) + (b < 0 ? 1 : 0) + (c < 0 ? 1 : 0) + (d < 0 ? 1 : 0);
        }
    }
}
