using System;

namespace Mua
{
    /// <summary>An avatar as the eyes see it.</summary>
    internal struct AvatarSeen
    {
        /// <summary>Distance to the nearest eye, metres.</summary>
        public double Distance;

        /// <summary>Pixels along a side of a texel of its finest level.</summary>
        public double Texel;

        /// <summary>Pixels of its box's height.</summary>
        public double Height;

        /// <summary>Splats by level, the finest first.</summary>
        public int[] Counts;

        /// <summary>Level at present; then the one that is chosen.</summary>
        public int Level;
    }

    /// <summary>
    /// The choice of avatars' levels of detail and of splats' shapes by their size on the screen, and a budget of splats, as in
    /// python/mua/avatar/level_choice.py; tests/golden/level_choice.json holds both to it.
    /// </summary>
    internal static class LevelChoice
    {
        private const double LargestTexel = 0.65; // pixels; texels up to this size look like smaller ones
        private const double LargestTriangle = 32; // pixels of a quad, about; one triangle costs less than two up to this size
        private const double Hysteresis = 1.15; // times: texels must look so much larger before a finer level comes back

        /// <summary>The coarsest level with texels up to LargestTexel; one that is shown stays a little longer.</summary>
        public static int Choose(in AvatarSeen seen)
        {
            int level = 0;
            for (int coarser = 1; coarser < seen.Counts.Length; coarser++)
            {
                double largest = LargestTexel * (coarser <= seen.Level ? Hysteresis : 1);
                level = seen.Texel * (1 << coarser) <= largest ? coarser : level;
            }
            return level;
        }

        /// <summary>
        /// Sets the level of each avatar, no finer than it is worth: the nearest first, as far as a budget of splats goes. Every other
        /// one is kept the splats of its coarsest level; where not even these fit, all are at their coarsest. Of two that are
        /// about as near, the one that is shown finer now counts as nearer.
        /// </summary>
        /// <param name="order">Room for as many numbers as there are avatars.</param>
        /// <param name="budget">Splats of all together; negative for as many as there are.</param>
        public static void Choose(Span<AvatarSeen> avatars, Span<int> order, long budget)
        {
            long spare = budget;
            for (int i = 0; i < avatars.Length; i++)
            {
                order[i] = i;
                spare -= Last(avatars[i]);
            }
            SortByNearness(avatars, order);
            for (int i = 0; i < avatars.Length; i++)
            {
                ref AvatarSeen seen = ref avatars[order[i]];
                int level = Choose(seen);
                while (budget >= 0 && level < seen.Counts.Length - 1 && seen.Counts[level] - Last(seen) > spare)
                {
                    level++;
                }
                spare -= seen.Counts[level] - Last(seen);
                seen.Level = level;
            }
        }

        /// <summary>
        /// Vertices by which each splat is drawn: 3 where splats are small, one triangle around the quad; else 6, its halves.
        /// Both make the same picture.
        /// </summary>
        /// <param name="covered">Square pixels that all quads cover, about.</param>
        public static int Corners(double covered, int splats)
        {
            return covered <= LargestTriangle * splats ? 3 : 6;
        }

        private static int Last(in AvatarSeen seen)
        {
            return seen.Counts[seen.Counts.Length - 1];
        }

        /// <summary>By insertion: few avatars, in nearly the order of the last frame, those of equal distance as they stand.</summary>
        private static void SortByNearness(ReadOnlySpan<AvatarSeen> avatars, Span<int> order)
        {
            for (int i = 1; i < order.Length; i++)
            {
                int moved = order[i], at = i;
                for (; at > 0 && Nearness(avatars[order[at - 1]]) > Nearness(avatars[moved]); at--)
                {
                    order[at] = order[at - 1];
                }
                order[at] = moved;
            }
        }

        private static double Nearness(in AvatarSeen seen)
        {
            return seen.Distance * Math.Pow(Hysteresis, seen.Level);
        }
    }
}
