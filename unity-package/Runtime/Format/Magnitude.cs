using System;

namespace Mua.Format
{
    /// <summary>
    /// How large the numbers may become that a file decodes to: refused where single precision would not hold their squares.
    /// Mirrors python/mua/asset/magnitude.py.
    /// </summary>
    internal sealed class Magnitude
    {
        private readonly bool isExact; // or at least as large, which takes less time

        private Magnitude(bool isExact)
        {
            this.isExact = isExact;
        }

        public static void Require(AvatarFile avatar)
        {
            string path = new Magnitude(isExact: false).Excess(avatar);
            path = path == null ? null : new Magnitude(isExact: true).Excess(avatar);
            if (path != null)
            {
                throw Refusal.Of(path, "the numbers that follow from it may exceed 4.6e+18");
            }
        }

        /// <summary>The first field from which too large numbers follow; null where none do.</summary>
        private string Excess(AvatarFile avatar)
        {
            double inputs = Largest(avatar.Encoding.Ranges) + Largest(avatar.Encoding.Margins);
            Coarse coarse = avatar.Coarse;
            double weight = Network(coarse.Mlp, inputs);
            double mesh = Largest(coarse.Mean) + coarse.Basis.Shape[0] * weight * Largest(coarse.Basis);
            return Exceeds(weight) ? "coarse.mlp" : Exceeds(mesh) ? "coarse"
                : Excess(avatar.Geometry, avatar.Wavelet, inputs, "geometry")
                ?? Excess(avatar.Appearance, avatar.Wavelet, inputs, "appearance");
        }

        private string Excess(Branch branch, Wavelet wavelet, double inputs, string path)
        {
            double coefficient = Network(branch.Mlp, inputs);
            return Exceeds(coefficient) ? path + ".mlp" : Exceeds(Texture(branch, wavelet, coefficient)) ? path : null;
        }

        /// <summary>What comes out of the layers; infinite where it is too large after any of them.</summary>
        private double Network(Layer[] mlp, double inputs)
        {
            double found = inputs;
            foreach (Layer layer in mlp)
            {
                found = LargestRow(layer) * found + Largest(layer.Bias);
                found = Exceeds(found) ? double.PositiveInfinity : found;
            }
            return found;
        }

        private double Texture(Branch branch, Wavelet wavelet, double coefficient)
        {
            double low = Sum(wavelet.RecLo), high = Sum(wavelet.RecHi);
            double found = Largest(branch.LlMean) + branch.Rank * coefficient * Largest(branch.LlBasis);
            for (int level = 0; level < wavelet.Levels; level++)
            {
                found *= low * low;
                if (level < branch.Details.Length)
                {
                    DetailBand band = branch.Details[level];
                    double product = Largest(band.H) * Largest(band.W);
                    found += (2 * low + high) * high * (Largest(band.Mean) + band.Rank * coefficient * product);
                }
            }
            return found;
        }

        private double Largest(Tensor tensor)
        {
            bool isQuick = !isExact && tensor.Type == ElementType.I8;
            return isQuick ? 128.0 * Largest(tensor.Scale) : Finite.Magnitude(tensor);
        }

        /// <summary>The largest sum of magnitudes in a row of weights.</summary>
        private double LargestRow(Layer layer)
        {
            if (!isExact)
            {
                return layer.Inputs * Largest(layer.Weight);
            }
            float[] weights = layer.Weight.ToFloats();
            double largest = 0;
            for (int row = 0; row < layer.Outputs; row++)
            {
                double sum = 0;
                for (int i = row * layer.Inputs; i < (row + 1) * layer.Inputs; i++)
                {
                    sum += Math.Abs(weights[i]);
                }
                largest = Math.Max(largest, sum);
            }
            return largest;
        }

        private static double Sum(double[] taps)
        {
            double sum = 0;
            foreach (double tap in taps)
            {
                sum += Math.Abs(tap);
            }
            return sum;
        }

        private static double Largest(float[] values)
        {
            float largest = 0;
            foreach (float value in values)
            {
                largest = Math.Max(largest, Math.Abs(value));
            }
            return largest;
        }

        private static bool Exceeds(double reached)
        {
            return !(reached <= Limits.Magnitude);
        }
    }
}
