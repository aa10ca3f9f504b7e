using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// Principal components of the motion descriptor, limited to the range of training: the input of the networks
    /// (python/mua/pose/components.py).
    /// </summary>
    internal sealed class Components
    {
        private readonly PoseEncoding encoding;
        private readonly float[] directions; // [K, D]

        public Components(PoseEncoding encoding)
        {
            this.encoding = encoding;
            directions = encoding.Components.ToFloats();
        }

        /// <summary>
        /// From a normalised descriptor [D] to `target` [K]; the length of what the bounds take off the components, relative
        /// to their own.
        /// </summary>
        public double Read(double[] descriptor, Span<float> target)
        {
            double all = 0, taken = 0;
            for (int i = 0; i < encoding.ComponentCount; i++)
            {
                double found = Along(descriptor, i), held = Hold(found, i);
                target[i] = (float)held;
                all += found * found;
                taken += (found - held) * (found - held);
            }
            return all > 0 ? Math.Sqrt(taken / all) : 0;
        }

        private double Along(double[] descriptor, int component)
        {
            var direction = new ReadOnlySpan<float>(directions, component * descriptor.Length, descriptor.Length);
            double sum = 0;
            for (int i = 0; i < direction.Length; i++)
            {
                sum += direction[i] * descriptor[i];
            }
            return sum;
        }

        /// <summary>A component as it is within its range; beyond, it nears the margin and never passes it.</summary>
        private double Hold(double found, int component)
        {
            double low = encoding.Ranges[component], high = encoding.Ranges[encoding.ComponentCount + component];
            double margin = encoding.Margins[component];
            if (found > high)
            {
                return high + margin * (found - high) / (found - high + margin);
            }
            return found < low ? low - margin * (low - found) / (low - found + margin) : found;
        }
    }
}
