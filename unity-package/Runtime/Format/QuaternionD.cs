using System;

namespace Mua.Format
{
    /// <summary>A quaternion in double precision, stored wxyz; the formulas are those of python/mua/rotation.py.</summary>
    public readonly struct QuaternionD
    {
        private const double SmallAngle = 1e-6;

        public readonly double W;
        public readonly double X;
        public readonly double Y;
        public readonly double Z;

        public static QuaternionD Identity => new QuaternionD(1, 0, 0, 0);

        public QuaternionD(double w, double x, double y, double z)
        {
            W = w;
            X = x;
            Y = y;
            Z = z;
        }

        /// <summary>Hamilton product: the rotation `b`, then `a`.</summary>
        public static QuaternionD operator *(QuaternionD a, QuaternionD b)
        {
            return new QuaternionD(
                a.W * b.W - a.X * b.X - a.Y * b.Y - a.Z * b.Z,
                a.W * b.X + a.X * b.W + a.Y * b.Z - a.Z * b.Y,
                a.W * b.Y - a.X * b.Z + a.Y * b.W + a.Z * b.X,
                a.W * b.Z + a.X * b.Y - a.Y * b.X + a.Z * b.W);
        }

        public static QuaternionD operator +(QuaternionD a, QuaternionD b)
        {
            return new QuaternionD(a.W + b.W, a.X + b.X, a.Y + b.Y, a.Z + b.Z);
        }

        public static QuaternionD operator *(double factor, QuaternionD q)
        {
            return new QuaternionD(factor * q.W, factor * q.X, factor * q.Y, factor * q.Z);
        }

        /// <summary>The conjugate; the inverse of a unit quaternion.</summary>
        public QuaternionD Conjugate => new QuaternionD(W, -X, -Y, -Z);

        public double Length => Math.Sqrt(W * W + X * X + Y * Y + Z * Z);

        /// <summary>The quaternion scaled to unit length.</summary>
        public QuaternionD Normalized()
        {
            double length = Length;
            return new QuaternionD(W / length, X / length, Y / length, Z / length);
        }

        /// <summary>The vector turned by this unit quaternion.</summary>
        public Vector3D Rotate(Vector3D v)
        {
            var axis = new Vector3D(X, Y, Z);
            Vector3D t = 2 * Vector3D.Cross(axis, v);
            return v + W * t + Vector3D.Cross(axis, t);
        }

        /// <summary>Between unit quaternions along the shorter arc, at t from 0 to 1.</summary>
        public static QuaternionD Slerp(QuaternionD a, QuaternionD b, double t)
        {
            double dot = a.W * b.W + a.X * b.X + a.Y * b.Y + a.Z * b.Z;
            if (dot < 0)
            {
                b = -1 * b;
            }
            double angle = Math.Acos(Math.Min(Math.Abs(dot), 1));
            if (angle < SmallAngle)
            {
                return ((1 - t) * a + t * b).Normalized();
            }
            double sine = Math.Sin(angle);
            return (Math.Sin((1 - t) * angle) / sine * a + Math.Sin(t * angle) / sine * b).Normalized();
        }

        /// <summary>The quaternion at position `index` of a flat array of wxyz.</summary>
        public static QuaternionD Load(ReadOnlySpan<double> quadruples, int index)
        {
            int at = 4 * index;
            return new QuaternionD(quadruples[at], quadruples[at + 1], quadruples[at + 2], quadruples[at + 3]);
        }

        /// <summary>Writes the quaternion to position `index` of a flat array of wxyz.</summary>
        public void Store(Span<double> quadruples, int index)
        {
            int at = 4 * index;
            quadruples[at] = W;
            quadruples[at + 1] = X;
            quadruples[at + 2] = Y;
            quadruples[at + 3] = Z;
        }
    }
}
