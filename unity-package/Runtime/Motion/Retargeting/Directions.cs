using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// Vectors that show directions, and the rotations that they ask for (python/mua/rotation.py, python/mua/motion/trunk.py).
    /// </summary>
    internal static class Directions
    {
        private const double Opposite = -1 + 1e-9; // cosine below which the shortest turn is a half one, about any axis across

        public static readonly Vector3D Y = new Vector3D(0, 1, 0);

        public static double Dot(Vector3D a, Vector3D b)
        {
            return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
        }

        public static double Length(Vector3D a)
        {
            return Math.Sqrt(Dot(a, a));
        }

        /// <summary>The direction of a vector; one without length stays 0.</summary>
        public static Vector3D Unit(Vector3D a)
        {
            double length = Length(a);
            return length > 0 ? new Vector3D(a.X / length, a.Y / length, a.Z / length) : a;
        }

        /// <summary>The angle between two vectors.</summary>
        public static double Degrees(Vector3D a, Vector3D b)
        {
            return 180 / Math.PI * Math.Atan2(Length(Vector3D.Cross(a, b)), Dot(a, b));
        }

        /// <summary>The signed coordinate axis nearest to a vector: what is up for a body that leans at rest.</summary>
        public static Vector3D NearestAxis(Vector3D a)
        {
            double x = Math.Abs(a.X), y = Math.Abs(a.Y), z = Math.Abs(a.Z);
            return x >= y && x >= z ? new Vector3D(Math.Sign(a.X), 0, 0)
                : y >= z ? new Vector3D(0, Math.Sign(a.Y), 0)
                : new Vector3D(0, 0, Math.Sign(a.Z));
        }

        /// <summary>The shortest rotation that takes one unit vector to another.</summary>
        public static QuaternionD Between(Vector3D a, Vector3D b)
        {
            double cosine = Dot(a, b);
            if (cosine >= Opposite)
            {
                Vector3D axis = Vector3D.Cross(a, b);
                return new QuaternionD(1 + cosine, axis.X, axis.Y, axis.Z).Normalized();
            }
            double x = Math.Abs(a.X), y = Math.Abs(a.Y), z = Math.Abs(a.Z);
            Vector3D least = x <= y && x <= z ? new Vector3D(1, 0, 0) : y <= z ? Y : new Vector3D(0, 0, 1);
            Vector3D across = Unit(Vector3D.Cross(a, least));
            return new QuaternionD(0, across.X, across.Y, across.Z);
        }

        /// <summary>
        /// The rotation whose matrix has these columns, w >= 0 (Shepperd 1978, https://doi.org/10.2514/3.55767b).
        /// </summary>
        public static QuaternionD FromColumns(Vector3D x, Vector3D y, Vector3D z)
        {
            double yz = y.Z - z.Y, zx = z.X - x.Z, xy = x.Y - y.X, sxy = x.Y + y.X, szx = x.Z + z.X, syz = y.Z + z.Y;
            QuaternionD[] rows =
            {
                new QuaternionD(1 + x.X + y.Y + z.Z, yz, zx, xy), new QuaternionD(yz, 1 + x.X - y.Y - z.Z, sxy, szx),
                new QuaternionD(zx, sxy, 1 - x.X + y.Y - z.Z, syz), new QuaternionD(xy, szx, syz, 1 - x.X - y.Y + z.Z),
            };
            double[] diagonal = { rows[0].W, rows[1].X, rows[2].Y, rows[3].Z };
            int largest = 0;
            for (int row = 1; row < diagonal.Length; row++)
            {
                largest = diagonal[row] > diagonal[largest] ? row : largest;
            }
            QuaternionD turn = rows[largest].Normalized();
            return turn.W < 0 ? -1 * turn : turn;
        }
    }
}
