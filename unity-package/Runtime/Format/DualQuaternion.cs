using System;

namespace Mua.Format
{
    /// <summary>A rigid transform as a unit dual quaternion: q, then 0.5 (0, t) q (schemas/README.md, Space).</summary>
    public readonly struct DualQuaternion
    {
        public readonly QuaternionD Real;
        public readonly QuaternionD Dual;

        public DualQuaternion(QuaternionD real, QuaternionD dual)
        {
            Real = real;
            Dual = dual;
        }

        /// <summary>The rotation, then the translation in metres.</summary>
        public static DualQuaternion FromRigid(QuaternionD rotation, Vector3D translation)
        {
            var pure = new QuaternionD(0, translation.X, translation.Y, translation.Z);
            return new DualQuaternion(rotation, 0.5 * (pure * rotation));
        }

        /// <summary>The transform `b`, then `a`.</summary>
        public static DualQuaternion operator *(DualQuaternion a, DualQuaternion b)
        {
            return new DualQuaternion(a.Real * b.Real, a.Real * b.Dual + a.Dual * b.Real);
        }

        public DualQuaternion Inverse => new DualQuaternion(Real.Conjugate, Dual.Conjugate);

        public Vector3D Translation
        {
            get
            {
                QuaternionD pure = 2 * Dual * Real.Conjugate;
                return new Vector3D(pure.X, pure.Y, pure.Z);
            }
        }

        /// <summary>The point moved by this transform.</summary>
        public Vector3D Transform(Vector3D point)
        {
            return Real.Rotate(point) + Translation;
        }

        /// <summary>The transform at position `index` of a flat array of eight numbers each.</summary>
        public static DualQuaternion Load(ReadOnlySpan<double> octuples, int index)
        {
            return new DualQuaternion(QuaternionD.Load(octuples, 2 * index), QuaternionD.Load(octuples, 2 * index + 1));
        }

        /// <summary>Writes the transform to position `index` of a flat array of eight numbers each.</summary>
        public void Store(Span<double> octuples, int index)
        {
            Real.Store(octuples, 2 * index);
            Dual.Store(octuples, 2 * index + 1);
        }
    }
}
