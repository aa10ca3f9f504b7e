using System;
using Mua.Format;

namespace Mua
{
    /// <summary>
    /// The triangles of an avatar's surface, and those about each texel, by which its normal is found when it is posed
    /// (python/mua/player/surface.py, in its order). It may be made on any thread.
    /// </summary>
    internal sealed class TexelGrid
    {
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

        /// <summary>The surface that an avatar's file holds.</summary>
        public static TexelGrid Build(AvatarFile avatar)
        {
            if (avatar.Surface == null)
            {
                throw new InvalidOperationException("the file holds no surface to show; bake it again.");
            }
            return new TexelGrid(avatar.Surface.Triangles(avatar.Texels), avatar.Texels.Count);
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
