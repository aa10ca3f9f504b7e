using System;
using Mua.Format;

namespace Mua.Editor
{
    /// <summary>
    /// A picture of the template mesh at rest, drawn without a graphics device: from the front and a little from the side,
    /// upright, in the average colours of the texels. For a file that brings no thumbnail of its own.
    /// </summary>
    internal sealed class Portrait
    {
        private const int Samples = 2; // of a pixel, along each axis
        private const double Turn = 25 * Math.PI / 180; // of the eye about Y, from the character's front to its left
        private const double Margin = 0.06; // of the picture, on each side
        private const double Ambient = 0.65; // of the light; the rest falls from above the eye
        private const double Smallest = 1e-6; // metres, of a mesh that is a point

        private static readonly Vector3D Right = new Vector3D(Math.Cos(Turn), 0, -Math.Sin(Turn));
        private static readonly Vector3D Ahead = new Vector3D(Math.Sin(Turn), 0, Math.Cos(Turn));
        private static readonly Vector3D Light = new Vector3D(-0.3, 0.6, 0.74); // right, up, towards the eye; of length 1

        private readonly AvatarFile avatar;
        private readonly int side; // samples
        private readonly Vector3D[] points; // of the vertices: right and up in samples, then towards the eye
        private readonly double[] nearest;
        private readonly double[] samples; // red, green, blue, alpha

        private Portrait(AvatarFile avatar, int size)
        {
            this.avatar = avatar;
            side = Samples * size;
            points = Place();
            nearest = new double[side * side];
            samples = new double[4 * side * side];
            for (int i = 0; i < nearest.Length; i++)
            {
                nearest[i] = double.NegativeInfinity;
            }
        }

        /// <summary>[size, size, 4] red, green, blue and alpha, not premultiplied; the lowest row is first.</summary>
        public static byte[] Draw(AvatarFile avatar, int size)
        {
            var portrait = new Portrait(avatar, size);
            var colours = new TexelColours(avatar);
            for (int face = 0; face < avatar.Template.Faces.Shape[0]; face++)
            {
                portrait.Draw(face, colours);
            }
            return portrait.Resolve(size);
        }

        /// <summary>The vertices fitted into the picture.</summary>
        private Vector3D[] Place()
        {
            var turned = new Vector3D[avatar.Coarse.Mean.Shape[0]];
            double left = double.MaxValue, right = -left, bottom = left, top = -left;
            for (int i = 0; i < turned.Length; i++)
            {
                var at = new Vector3D(Mean(3 * i), Mean(3 * i + 1), Mean(3 * i + 2));
                turned[i] = new Vector3D(Dot(at, Right), at.Y, Dot(at, Ahead));
                left = Math.Min(left, turned[i].X);
                right = Math.Max(right, turned[i].X);
                bottom = Math.Min(bottom, turned[i].Y);
                top = Math.Max(top, turned[i].Y);
            }
            double extent = Math.Max(Math.Max(right - left, top - bottom), Smallest);
            double scale = side * (1 - 2 * Margin) / extent, half = 0.5 * side;
            var centre = new Vector3D(0.5 * (left + right), 0.5 * (bottom + top), 0);
            for (int i = 0; i < turned.Length; i++)
            {
                turned[i] = scale * (turned[i] - centre) + new Vector3D(half, half, 0);
            }
            return turned;
        }

        private double Mean(int index)
        {
            return avatar.Coarse.Mean.Read(index);
        }

        private void Draw(int face, TexelColours colours)
        {
            ReadOnlySpan<int> corners = avatar.Template.Faces.Integers.Slice(3 * face, 3);
            ReadOnlySpan<int> uvs = avatar.Template.UvFaces.Integers.Slice(3 * face, 3);
            Vector3D a = points[corners[0]], b = points[corners[1]], c = points[corners[2]];
            Vector3D normal = Vector3D.Cross(b - a, c - a); // Z is twice the area, negative from behind
            if (Math.Abs(normal.Z) < double.Epsilon)
            {
                return;
            }
            double shade = Ambient + (1 - Ambient) * Math.Max(0, Dot(normal, Light) / Math.Sqrt(Dot(normal, normal)));
            int low = Sample(Math.Min(a.Y, Math.Min(b.Y, c.Y))), high = Sample(Math.Max(a.Y, Math.Max(b.Y, c.Y)));
            int first = Sample(Math.Min(a.X, Math.Min(b.X, c.X))), last = Sample(Math.Max(a.X, Math.Max(b.X, c.X)));
            for (int row = low; row <= high; row++)
            {
                for (int column = first; column <= last; column++)
                {
                    var at = new Vector3D(column + 0.5, row + 0.5, 0);
                    double shareA = Vector3D.Cross(b - at, c - at).Z / normal.Z;
                    double shareB = Vector3D.Cross(c - at, a - at).Z / normal.Z;
                    double shareC = 1 - shareA - shareB, depth = shareA * a.Z + shareB * b.Z + shareC * c.Z;
                    int index = row * side + column;
                    if (shareA < 0 || shareB < 0 || shareC < 0 || depth <= nearest[index])
                    {
                        continue;
                    }
                    nearest[index] = depth;
                    double u = shareA * Uv(uvs[0], 0) + shareB * Uv(uvs[1], 0) + shareC * Uv(uvs[2], 0);
                    double v = shareA * Uv(uvs[0], 1) + shareB * Uv(uvs[1], 1) + shareC * Uv(uvs[2], 1);
                    for (int channel = 0; channel < 3; channel++)
                    {
                        samples[4 * index + channel] = shade * colours.Read(u, v, face, channel);
                    }
                    samples[4 * index + 3] = 1;
                }
            }
        }

        private double Uv(int corner, int axis)
        {
            return avatar.Template.Uv.Read(2 * corner + axis);
        }

        private int Sample(double coordinate)
        {
            return (int)Math.Max(0, Math.Min(side - 1, Math.Floor(coordinate)));
        }

        private byte[] Resolve(int size)
        {
            var pixels = new byte[4 * size * size];
            for (int pixel = 0; pixel < size * size; pixel++)
            {
                int corner = Samples * (pixel / size) * side + Samples * (pixel % size);
                double alpha = Sum(corner, 3);
                for (int channel = 0; channel < 3; channel++)
                {
                    pixels[4 * pixel + channel] = Byte(Sum(corner, channel) / Math.Max(alpha, 1));
                }
                pixels[4 * pixel + 3] = Byte(alpha / (Samples * Samples));
            }
            return pixels;
        }

        private double Sum(int corner, int channel)
        {
            double sum = 0;
            for (int i = 0; i < Samples * Samples; i++)
            {
                sum += samples[4 * (corner + i / Samples * side + i % Samples) + channel];
            }
            return sum;
        }

        private static byte Byte(double value)
        {
            return (byte)Math.Round(255 * Math.Max(0, Math.Min(1, value)));
        }

        private static double Dot(in Vector3D a, in Vector3D b)
        {
            return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
        }
    }
}
