using System;

namespace Mua.Format
{
    /// <summary>
    /// How large the numbers may become that a file decodes to: refused where single precision would not hold their squares.
    /// Mirrors python/mua/asset/magnitude.py.
    /// </summary>
    internal static class Magnitude
    {
        public static void Require(AvatarFile avatar)
        {
            double inputs = Largest(avatar.Encoding.Ranges) + Largest(avatar.Encoding.Margins);
            Coarse coarse = avatar.Coarse;
            double weight = Network(coarse.Mlp, inputs, "coarse.mlp");
            Require("coarse", Finite.Magnitude(coarse.Mean) + coarse.Basis.Shape[0] * weight * Finite.Magnitude(coarse.Basis));
            RequireTexture(avatar.Geometry, avatar.Wavelet, inputs, "geometry");
            RequireTexture(avatar.Appearance, avatar.Wavelet, inputs, "appearance");
        }

        private static double Network(Layer[] mlp, double inputs, string path)
        {
            double found = inputs;
            foreach (Layer layer in mlp)
            {
                double rows = 0;
                for (int row = 0; row < layer.Outputs; row++)
                {
                    double sum = 0;
                    for (int i = row * layer.Inputs; i < (row + 1) * layer.Inputs; i++)
                    {
                        sum += Math.Abs(layer.Weight.Read(i));
                    }
                    rows = Math.Max(rows, sum);
                }
                found = rows * found + Finite.Magnitude(layer.Bias);
                Require(path, found);
            }
            return found;
        }

        private static void RequireTexture(Branch branch, Wavelet wavelet, double inputs, string path)
        {
            double low = Sum(wavelet.RecLo), high = Sum(wavelet.RecHi);
            double coefficient = Network(branch.Mlp, inputs, path + ".mlp");
            double found = Finite.Magnitude(branch.LlMean) + branch.Rank * coefficient * Finite.Magnitude(branch.LlBasis);
            for (int level = 0; level < wavelet.Levels; level++)
            {
                found *= low * low;
                if (level < branch.Details.Length)
                {
                    DetailBand band = branch.Details[level];
                    double product = Finite.Magnitude(band.H) * Finite.Magnitude(band.W);
                    found += (2 * low + high) * high * (Finite.Magnitude(band.Mean) + band.Rank * coefficient * product);
                }
            }
            Require(path, found);
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

        private static void Require(string path, double reached)
        {
            if (!(reached <= Limits.Magnitude))
            {
                throw Refusal.Of(path, "the numbers that follow from it may exceed 4.6e+18");
            }
        }
    }
}
