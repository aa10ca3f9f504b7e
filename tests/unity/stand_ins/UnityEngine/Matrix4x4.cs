// Stand-in. Source: Unity 6000.0 scripting reference, Matrix4x4: column-major memory, column vectors.
using System;

namespace UnityEngine
{
    public struct Matrix4x4 : IEquatable<Matrix4x4>
    {
        public float m00, m10, m20, m30, m01, m11, m21, m31, m02, m12, m22, m32, m03, m13, m23, m33;

        public Matrix4x4(Vector4 column0, Vector4 column1, Vector4 column2, Vector4 column3) : this()
        {
            SetColumn(0, column0);
            SetColumn(1, column1);
            SetColumn(2, column2);
            SetColumn(3, column3);
        }

        public static Matrix4x4 zero { get { return new Matrix4x4(); } }
        public static Matrix4x4 identity { get { return Scale(Vector3.one); } }
        public Matrix4x4 inverse { get { return Inverse(this); } }
        public float determinant { get { double[] unused; return (float)Invert(this, out unused); } }
        public Vector3 lossyScale
        {
            get
            {
                Vector3 x = GetColumn(0), y = GetColumn(1), z = GetColumn(2);
                float sign = Vector3.Dot(Vector3.Cross(x, y), z) < 0 ? -1 : 1;
                return new Vector3(sign * x.magnitude, y.magnitude, z.magnitude);
            }
        }
        public Quaternion rotation
        {
            get
            {
                Vector3 x = GetColumn(0), y = GetColumn(1), z = GetColumn(2);
                return Quaternion.FromAxes(x.normalized, y.normalized, z.normalized);
            }
        }

        public float this[int row, int column]
        {
            get { return this[row + 4 * column]; }
            set { this[row + 4 * column] = value; }
        }

        public float this[int index]
        {
            get
            {
                switch (index)
                {
                    case 0: return m00;
                    case 1: return m10;
                    case 2: return m20;
                    case 3: return m30;
                    case 4: return m01;
                    case 5: return m11;
                    case 6: return m21;
                    case 7: return m31;
                    case 8: return m02;
                    case 9: return m12;
                    case 10: return m22;
                    case 11: return m32;
                    case 12: return m03;
                    case 13: return m13;
                    case 14: return m23;
                    case 15: return m33;
                    default: throw new IndexOutOfRangeException("Invalid matrix index!");
                }
            }
            set
            {
                switch (index)
                {
                    case 0: m00 = value; break;
                    case 1: m10 = value; break;
                    case 2: m20 = value; break;
                    case 3: m30 = value; break;
                    case 4: m01 = value; break;
                    case 5: m11 = value; break;
                    case 6: m21 = value; break;
                    case 7: m31 = value; break;
                    case 8: m02 = value; break;
                    case 9: m12 = value; break;
                    case 10: m22 = value; break;
                    case 11: m32 = value; break;
                    case 12: m03 = value; break;
                    case 13: m13 = value; break;
                    case 14: m23 = value; break;
                    case 15: m33 = value; break;
                    default: throw new IndexOutOfRangeException("Invalid matrix index!");
                }
            }
        }

        public Vector4 GetColumn(int i) { return new Vector4(this[0, i], this[1, i], this[2, i], this[3, i]); }
        public Vector4 GetRow(int i) { return new Vector4(this[i, 0], this[i, 1], this[i, 2], this[i, 3]); }
        public void SetColumn(int i, Vector4 v)
        {
            for (int row = 0; row < 4; row++)
                this[row, i] = v[row];
        }
        public void SetRow(int i, Vector4 v)
        {
            for (int column = 0; column < 4; column++)
                this[i, column] = v[column];
        }

        public Vector3 MultiplyPoint3x4(Vector3 p) { return this * new Vector4(p.x, p.y, p.z, 1); }

        public static Matrix4x4 Scale(Vector3 s)
        {
            Matrix4x4 m = new Matrix4x4();
            m.m00 = s.x;
            m.m11 = s.y;
            m.m22 = s.z;
            m.m33 = 1;
            return m;
        }
        public static Matrix4x4 Translate(Vector3 v)
        {
            Matrix4x4 m = identity;
            m.SetColumn(3, new Vector4(v.x, v.y, v.z, 1));
            return m;
        }
        public static Matrix4x4 Rotate(Quaternion q) { return TRS(Vector3.zero, q, Vector3.one); }
        public static Matrix4x4 TRS(Vector3 pos, Quaternion q, Vector3 s)
        {
            Vector3 x = q * Vector3.right * s.x, y = q * Vector3.up * s.y, z = q * Vector3.forward * s.z;
            return new Matrix4x4(x, y, z, new Vector4(pos.x, pos.y, pos.z, 1));
        }
        /// <summary>OpenGL's clip space, camera looking along -z; fov is vertical, degrees.</summary>
        public static Matrix4x4 Perspective(float fov, float aspect, float zNear, float zFar)
        {
            double focal = 1 / Math.Tan(fov * Math.PI / 360);
            Matrix4x4 m = new Matrix4x4();
            m.m00 = (float)(focal / aspect);
            m.m11 = (float)focal;
            m.m22 = (zFar + zNear) / (zNear - zFar);
            m.m23 = 2 * zFar * zNear / (zNear - zFar);
            m.m32 = -1;
            return m;
        }
        public static Matrix4x4 LookAt(Vector3 from, Vector3 to, Vector3 up)
        {
            return TRS(from, Quaternion.LookRotation(to - from, up), Vector3.one);
        }
        public static Matrix4x4 Inverse(Matrix4x4 m)
        {
            double[] found;
            if (Invert(m, out found) == 0)
                return zero;
            Matrix4x4 inverse = new Matrix4x4();
            for (int i = 0; i < 16; i++)
                inverse[i / 4, i % 4] = (float)found[i];
            return inverse;
        }

        public static Matrix4x4 operator *(Matrix4x4 a, Matrix4x4 b)
        {
            return new Matrix4x4(a * b.GetColumn(0), a * b.GetColumn(1), a * b.GetColumn(2), a * b.GetColumn(3));
        }
        public static Vector4 operator *(Matrix4x4 m, Vector4 v)
        {
            return new Vector4(
                m.m00 * v.x + m.m01 * v.y + m.m02 * v.z + m.m03 * v.w,
                m.m10 * v.x + m.m11 * v.y + m.m12 * v.z + m.m13 * v.w,
                m.m20 * v.x + m.m21 * v.y + m.m22 * v.z + m.m23 * v.w,
                m.m30 * v.x + m.m31 * v.y + m.m32 * v.z + m.m33 * v.w);
        }
        public static bool operator ==(Matrix4x4 a, Matrix4x4 b)
        {
            return a.GetColumn(0) == b.GetColumn(0) && a.GetColumn(1) == b.GetColumn(1)
                && a.GetColumn(2) == b.GetColumn(2) && a.GetColumn(3) == b.GetColumn(3);
        }
        public static bool operator !=(Matrix4x4 a, Matrix4x4 b) { return !(a == b); }
        public bool Equals(Matrix4x4 other)
        {
            return GetColumn(0).Equals(other.GetColumn(0)) && GetColumn(1).Equals(other.GetColumn(1))
                && GetColumn(2).Equals(other.GetColumn(2)) && GetColumn(3).Equals(other.GetColumn(3));
        }
        public override bool Equals(object other) { return other is Matrix4x4 && Equals((Matrix4x4)other); }
        public override int GetHashCode() { return GetColumn(0).GetHashCode() ^ (GetColumn(3).GetHashCode() << 2); }

        [ThreadStatic] private static double[] work, result;

        /// <summary>Gauss-Jordan with row pivots; returns the determinant, and the inverse row by row. Does not allocate.</summary>
        private static double Invert(Matrix4x4 m, out double[] inverse)
        {
            double[] a = work ?? (work = new double[16]);
            inverse = result ?? (result = new double[16]);
            for (int i = 0; i < 16; i++)
            {
                a[i] = m[i / 4, i % 4];
                inverse[i] = i / 4 == i % 4 ? 1 : 0;
            }
            double determinant = 1;
            for (int column = 0; column < 4; column++)
            {
                int pivot = column;
                for (int row = column + 1; row < 4; row++)
                    if (Math.Abs(a[4 * row + column]) > Math.Abs(a[4 * pivot + column]))
                        pivot = row;
                double largest = a[4 * pivot + column];
                determinant *= pivot == column ? largest : -largest;
                if (largest == 0)
                    return 0;
                for (int i = 0; i < 4; i++)
                {
                    Swap(a, 4 * pivot + i, 4 * column + i);
                    Swap(inverse, 4 * pivot + i, 4 * column + i);
                    a[4 * column + i] /= largest;
                    inverse[4 * column + i] /= largest;
                }
                for (int row = 0; row < 4; row++)
                {
                    double factor = row == column ? 0 : a[4 * row + column];
                    for (int i = 0; i < 4; i++)
                    {
                        a[4 * row + i] -= factor * a[4 * column + i];
                        inverse[4 * row + i] -= factor * inverse[4 * column + i];
                    }
                }
            }
            return determinant;
        }

        private static void Swap(double[] a, int i, int j)
        {
            double held = a[i];
            a[i] = a[j];
            a[j] = held;
        }
    }
}
