using System;

namespace Mua.Format
{
    /// <summary>A point or direction in double precision.</summary>
    public readonly struct Vector3D
    {
        public readonly double X;
        public readonly double Y;
        public readonly double Z;

        public Vector3D(double x, double y, double z)
        {
            X = x;
            Y = y;
            Z = z;
        }

        public static Vector3D operator +(Vector3D a, Vector3D b)
        {
            return new Vector3D(a.X + b.X, a.Y + b.Y, a.Z + b.Z);
        }

        public static Vector3D operator -(Vector3D a, Vector3D b)
        {
            return new Vector3D(a.X - b.X, a.Y - b.Y, a.Z - b.Z);
        }

        public static Vector3D operator *(double factor, Vector3D v)
        {
            return new Vector3D(factor * v.X, factor * v.Y, factor * v.Z);
        }

        public static Vector3D Cross(Vector3D a, Vector3D b)
        {
            return new Vector3D(a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X);
        }

        /// <summary>The vector at position `index` of a flat array of triples.</summary>
        public static Vector3D Load(ReadOnlySpan<double> triples, int index)
        {
            int at = 3 * index;
            return new Vector3D(triples[at], triples[at + 1], triples[at + 2]);
        }

        /// <summary>Writes the vector to position `index` of a flat array of triples.</summary>
        public void Store(Span<double> triples, int index)
        {
            int at = 3 * index;
            triples[at] = X;
            triples[at + 1] = Y;
            triples[at + 2] = Z;
        }
    }
}
