using System;

namespace Mua
{
    /// <summary>
    /// The filter that a branch's levels without details are together: `upsampling_taps` of
    /// python/mua/kernels/inverse_dwt.py.
    /// </summary>
    internal sealed class Upsampling
    {
        /// <param name="recLo">Taps of one level.</param>
        /// <param name="levels">Number of levels without details.</param>
        /// <param name="coarser">At most as many: times that two texels become one.</param>
        public Upsampling(double[] recLo, int levels, int coarser)
        {
            var taps = new double[] { 1 };
            for (int level = 0; level < levels; level++)
            {
                taps = Refined(taps, recLo);
            }
            int delay = ((1 << levels) - 1) * (recLo.Length / 2 - 1);
            for (int i = 0; i < coarser; i++)
            {
                taps = Halved(taps, delay % 2);
                delay = (delay + 1) / 2;
            }
            Factor = 1 << (levels - coarser);
            int first = 0, last = taps.Length - 1;
            while (last > 0 && taps[last] == 0)
            {
                last--;
            }
            while (first < Math.Min(delay, last) && taps[first] == 0)
            {
                first++;
            }
            Reach = (last - first + Factor) / Factor;
            Delay = delay - first;
            var used = new float[Reach * Factor];
            for (int i = first; i <= last; i++)
            {
                used[i - first] = (float)taps[i];
            }
            Taps = new Upload("wavelet.rec_lo", used, sizeof(float));
        }

        /// <summary>[reach, factor] taps, on their way to the device.</summary>
        public Upload Taps { get; }

        /// <summary>Texels along a side for each sample.</summary>
        public int Factor { get; }

        /// <summary>Samples along a side that a texel needs.</summary>
        public int Reach { get; }

        /// <summary>Delay of the filter, texels.</summary>
        public int Delay { get; }

        /// <summary>The taps upsampled by two, then convolved with the filter of the next level.</summary>
        private static double[] Refined(double[] taps, double[] filter)
        {
            var refined = new double[2 * (taps.Length - 1) + filter.Length];
            for (int i = 0; i < taps.Length; i++)
            {
                for (int j = 0; j < filter.Length; j++)
                {
                    refined[2 * i + j] += taps[i] * filter[j];
                }
            }
            return refined;
        }

        /// <summary>The filter of the means of two texels: means of two taps, of which zeros precede the first.</summary>
        private static double[] Halved(double[] taps, int zeros)
        {
            var halved = new double[(taps.Length + zeros + 1) / 2];
            for (int i = 0; i < taps.Length; i++)
            {
                halved[(i + zeros) / 2] += taps[i] / 2;
            }
            return halved;
        }
    }
}
