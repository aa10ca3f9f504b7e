using System;
using Mua.Format;

namespace Mua
{
    /// <summary>The template and its texels at rest, as TexelGrid works on them: flat arrays in double precision.</summary>
    internal sealed class TexelRest
    {
        public TexelRest(AvatarFile avatar)
        {
            Size = avatar.Texels.Size;
            Vertices = Doubles(avatar.Coarse.Mean);
            Faces = Integers(avatar.Template.Faces);
            Uv = Doubles(avatar.Template.Uv);
            UvFaces = Integers(avatar.Template.UvFaces);
            Texels = Integers(avatar.Texels.Indices);
            Triangles = Integers(avatar.Texels.Triangles);
            Places = PlacesOf(avatar.Texels.Barycentrics);
            Charts = TexelCharts.Find(this);
            Footprints = FootprintsOf();
        }

        /// <summary>Texels along a side of the texture.</summary>
        public int Size { get; }

        /// <summary>[V, 3] metres.</summary>
        public double[] Vertices { get; }

        /// <summary>[F, 3] into Vertices.</summary>
        public int[] Faces { get; }

        /// <summary>[T, 2].</summary>
        public double[] Uv { get; }

        /// <summary>[F, 3] into Uv.</summary>
        public int[] UvFaces { get; }

        /// <summary>[N] row * Size + column, ascending.</summary>
        public int[] Texels { get; }

        /// <summary>[N] into the faces.</summary>
        public int[] Triangles { get; }

        /// <summary>[N, 3] positions of the texels, metres.</summary>
        public double[] Places { get; }

        /// <summary>[F] a number for each face, the same throughout a UV chart.</summary>
        public int[] Charts { get; }

        /// <summary>[N] greatest length on the surface of one step along a texel's diagonal, metres.</summary>
        public double[] Footprints { get; }

        /// <summary>The chart that a texel lies in.</summary>
        public int ChartOf(int texel)
        {
            return Charts[Triangles[texel]];
        }

        /// <summary>Area in UV of a face, negative where it is mirrored.</summary>
        public double SignedArea(int face)
        {
            int a = 2 * UvFaces[3 * face], b = 2 * UvFaces[3 * face + 1], c = 2 * UvFaces[3 * face + 2];
            double ax = Uv[b] - Uv[a], ay = Uv[b + 1] - Uv[a + 1];
            double bx = Uv[c] - Uv[a], by = Uv[c + 1] - Uv[a + 1];
            return (ax * by - ay * bx) / 2;
        }

        /// <summary>Squared distance between points of two arrays [.., 3], metres squared.</summary>
        public static double Squared(double[] points, int i, double[] others, int j)
        {
            double x = points[3 * i] - others[3 * j];
            double y = points[3 * i + 1] - others[3 * j + 1];
            double z = points[3 * i + 2] - others[3 * j + 2];
            return x * x + y * y + z * z;
        }

        /// <summary>Squared length of the longest edge of a triangle of texels, metres squared.</summary>
        public double LongestSquared(int a, int b, int c)
        {
            double ab = Squared(Places, a, Places, b), bc = Squared(Places, b, Places, c);
            return Math.Max(Math.Max(ab, bc), Squared(Places, c, Places, a));
        }

        private double[] PlacesOf(Tensor barycentrics)
        {
            var places = new double[3 * Texels.Length];
            for (int texel = 0; texel < Texels.Length; texel++)
            {
                float a = barycentrics.Read(2 * texel), b = barycentrics.Read(2 * texel + 1);
                double third = Math.Max((float)(1 - (float)(a + b)), 0), first = Math.Max(a, 0), second = Math.Max(b, 0);
                int face = 3 * Triangles[texel];
                for (int axis = 0; axis < 3; axis++)
                {
                    places[3 * texel + axis] = first * Vertices[3 * Faces[face] + axis]
                        + second * Vertices[3 * Faces[face + 1] + axis] + third * Vertices[3 * Faces[face + 2] + axis];
                }
            }
            return places;
        }

        private double[] FootprintsOf()
        {
            var ofFaces = new double[Faces.Length / 3];
            for (int face = 0; face < ofFaces.Length; face++)
            {
                ofFaces[face] = Math.Sqrt(2) * Stretch(face);
            }
            var footprints = new double[Texels.Length];
            for (int texel = 0; texel < footprints.Length; texel++)
            {
                footprints[texel] = ofFaces[Triangles[texel]];
            }
            return footprints;
        }

        /// <summary>Greatest length on the surface of a step of one texel, metres; 0 for a face that has no texels.</summary>
        private double Stretch(int face)
        {
            int a = UvFaces[3 * face], b = UvFaces[3 * face + 1], c = UvFaces[3 * face + 2];
            double bx = (Uv[2 * b] - Uv[2 * a]) * Size, by = (Uv[2 * b + 1] - Uv[2 * a + 1]) * Size;
            double cx = (Uv[2 * c] - Uv[2 * a]) * Size, cy = (Uv[2 * c + 1] - Uv[2 * a + 1]) * Size;
            double determinant = bx * cy - by * cx;
            if (determinant.Equals(0))
            {
                return 0;
            }
            double rr = 0, rs = 0, ss = 0; // J J^T of the surface's derivatives J along columns and rows
            for (int axis = 0; axis < 3; axis++)
            {
                double start = Vertices[3 * Faces[3 * face] + axis];
                double side = Vertices[3 * Faces[3 * face + 1] + axis] - start;
                double other = Vertices[3 * Faces[3 * face + 2] + axis] - start;
                double r = (cy * side - by * other) / determinant, s = (bx * other - cx * side) / determinant;
                rr += r * r;
                rs += r * s;
                ss += s * s;
            }
            double half = (rr - ss) / 2;
            return Math.Sqrt((rr + ss) / 2 + Math.Sqrt(half * half + rs * rs));
        }

        private static double[] Doubles(Tensor tensor)
        {
            var values = new double[tensor.Count];
            for (int i = 0; i < values.Length; i++)
            {
                values[i] = tensor.Read(i);
            }
            return values;
        }

        private static int[] Integers(Tensor tensor)
        {
            var values = new int[tensor.Count];
            tensor.CopyTo(values);
            return values;
        }
    }
}
