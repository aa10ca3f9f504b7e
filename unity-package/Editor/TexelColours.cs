using System;
using Mua.Format;

namespace Mua.Editor
{
    /// <summary>
    /// The average look of an avatar, without any motion: at each texel the low-pass mean of its appearance plus the static
    /// offset, of which the constant term of the spherical harmonics is the colour (schemas/README.md, steps 3 to 5).
    /// </summary>
    internal sealed class TexelColours
    {
        private const double Constant = 0.28209479177387814; // of degree 0: 1 / (2 sqrt(pi))
        private const double Grey = 0.5; // where all coefficients are 0

        private readonly int size;
        private readonly int[] found; // position of each texel among the valid ones, -1 for none
        private readonly double[] colours; // [N, 3]
        private readonly double[] means; // [F, 3] of the texels of a face

        public TexelColours(AvatarFile avatar)
        {
            size = avatar.Texels.Size;
            found = new int[size * size];
            for (int i = 0; i < found.Length; i++)
            {
                found[i] = -1;
            }
            ReadOnlySpan<int> texels = avatar.Texels.Indices.Integers;
            colours = new double[3 * texels.Length];
            for (int i = 0; i < texels.Length; i++)
            {
                found[texels[i]] = i;
            }
            for (int channel = 0; channel < 3; channel++)
            {
                Fill(avatar, channel);
            }
            means = Average(avatar);
        }

        /// <summary>Colour channel at UV of a face; that of the face as a whole where no texel is valid.</summary>
        public double Read(double u, double v, int face, int channel)
        {
            int column = Clamp(u), row = Clamp(v);
            int texel = found[row * size + column];
            return texel < 0 ? means[3 * face + channel] : colours[3 * texel + channel];
        }

        private int Clamp(double coordinate)
        {
            return (int)Math.Max(0, Math.Min(size - 1, Math.Floor(coordinate * size)));
        }

        private void Fill(AvatarFile avatar, int channel)
        {
            Branch appearance = avatar.Appearance;
            int side = appearance.LlMean.Shape[1], step = size / side, count = avatar.Texels.Count;
            double gain = Gain(avatar.Wavelet);
            ReadOnlySpan<int> texels = avatar.Texels.Indices.Integers;
            for (int i = 0; i < texels.Length; i++)
            {
                double row = (double)(texels[i] / size) / step, column = (double)(texels[i] % size) / step;
                double mean = gain * Between(appearance.LlMean, channel, row, column);
                double coefficient = mean + appearance.StaticOffset.Read(channel * count + i);
                colours[3 * i + channel] = Grey + Constant * coefficient;
            }
        }

        /// <summary>What synthesis makes of a constant LL: half of the taps meet each sample, along both axes.</summary>
        private static double Gain(Wavelet wavelet)
        {
            double sum = 0;
            foreach (double tap in wavelet.RecLo)
            {
                sum += tap;
            }
            return Math.Pow(sum / 2, 2 * wavelet.Levels);
        }

        /// <summary>One channel of LL between its coefficients, which are centred on every step-th texel and periodic.</summary>
        private static double Between(Tensor ll, int channel, double row, double column)
        {
            int side = ll.Shape[1], top = (int)row, left = (int)column, origin = channel * side * side;
            int below = (top + 1) % side, right = (left + 1) % side;
            double down = row - top, across = column - left;
            double upper = Mix(ll.Read(origin + top * side + left), ll.Read(origin + top * side + right), across);
            double lower = Mix(ll.Read(origin + below * side + left), ll.Read(origin + below * side + right), across);
            return Mix(upper, lower, down);
        }

        private static double Mix(double a, double b, double share)
        {
            return a + share * (b - a);
        }

        private double[] Average(AvatarFile avatar)
        {
            int faces = avatar.Template.Faces.Shape[0];
            var sums = new double[3 * faces];
            var counts = new int[faces];
            ReadOnlySpan<int> triangles = avatar.Texels.Triangles.Integers;
            for (int i = 0; i < triangles.Length; i++)
            {
                counts[triangles[i]]++;
                for (int channel = 0; channel < 3; channel++)
                {
                    sums[3 * triangles[i] + channel] += colours[3 * i + channel];
                }
            }
            for (int i = 0; i < sums.Length; i++)
            {
                sums[i] = counts[i / 3] == 0 ? Grey : sums[i] / counts[i / 3];
            }
            return sums;
        }
    }
}
