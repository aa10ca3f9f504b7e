using System;

namespace Mua.Motion
{
    /// <summary>
    /// How far to raise an avatar whose figure does not tell where its floor is, so that the lower foot stood on it in the last
    /// seconds (python/mua/live/retargeting.py).
    /// </summary>
    internal sealed class Footing
    {
        private const double Remembered = 10; // seconds
        private const int Most = 600; // heights that are remembered: of 60 frames a second
        private const double Standing = 0.05; // quantile of the lower foot's heights that counts as standing

        private readonly double[] times = new double[Most], heights = new double[Most]; // rings
        private readonly double[] lowest = new double[Most]; // as many as the quantile asks for
        private int begin, count;

        /// <summary>Metres to raise the avatar by at a time, whose lower foot is so high above the floor without that.</summary>
        public double Lift(double seconds, double height)
        {
            bool isBack = count > 0 && seconds < times[(begin + count - 1) % Most];
            count = isBack ? 0 : count;
            while (count > 0 && times[begin] < seconds - Remembered)
            {
                begin = (begin + 1) % Most;
                count--;
            }
            bool isFirst = count == 0;
            double lift = isFirst ? 0 : -Stood();
            if (count == Most)
            {
                begin = (begin + 1) % Most;
                count--;
            }
            int at = (begin + count++) % Most;
            times[at] = seconds;
            heights[at] = height;
            return isFirst ? -Stood() : lift;
        }

        private double Stood()
        {
            double at = Standing * (count - 1);
            int below = (int)at, wanted = Math.Min(below + 2, count), kept = 0;
            for (int i = 0; i < count; i++)
            {
                kept = Keep(heights[(begin + i) % Most], kept, wanted);
            }
            return lowest[below] + (at - below) * (lowest[kept - 1] - lowest[below]);
        }

        /// <summary>Puts a height among the lowest, ascending; how many there are then.</summary>
        private int Keep(double height, int kept, int wanted)
        {
            if (kept == wanted && height >= lowest[kept - 1])
            {
                return kept;
            }
            int at = kept < wanted ? kept : kept - 1;
            for (; at > 0 && lowest[at - 1] > height; at--)
            {
                lowest[at] = lowest[at - 1];
            }
            lowest[at] = height;
            return Math.Min(kept + 1, wanted);
        }
    }
}
