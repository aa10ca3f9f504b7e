// Stand-in. Source: Unity 6000.0 scripting reference, Quaternion.
using System;

namespace UnityEngine
{
    public struct Quaternion : IEquatable<Quaternion>
    {
        public float x, y, z, w;

        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }

        public static Quaternion identity { get { return new Quaternion(0, 0, 0, 1); } }
        public Quaternion normalized { get { return Normalize(this); } }

        /// <summary>Degrees; turns about z, then x, then y.</summary>
        public Vector3 eulerAngles
        {
            get
            {
                double sine = Math.Max(-1, Math.Min(1, 2.0 * (w * x - y * z)));
                double pitch = Math.Asin(sine);
                double yaw = Math.Atan2(2.0 * (w * y + x * z), 1 - 2.0 * (x * x + y * y));
                double roll = Math.Atan2(2.0 * (w * z + x * y), 1 - 2.0 * (x * x + z * z));
                return new Vector3(Degrees(pitch), Degrees(yaw), Degrees(roll));
            }
        }

        public static Quaternion Euler(float x, float y, float z)
        {
            return AngleAxis(y, Vector3.up) * AngleAxis(x, Vector3.right) * AngleAxis(z, Vector3.forward);
        }
        public static Quaternion Euler(Vector3 euler) { return Euler(euler.x, euler.y, euler.z); }
        public static Quaternion AngleAxis(float angle, Vector3 axis)
        {
            double half = angle * Math.PI / 360, sine = Math.Sin(half);
            Vector3 unit = axis.normalized;
            return new Quaternion((float)(unit.x * sine), (float)(unit.y * sine), (float)(unit.z * sine), (float)Math.Cos(half));
        }
        public static Quaternion Inverse(Quaternion q) { return new Quaternion(-q.x, -q.y, -q.z, q.w); }
        public static float Dot(Quaternion a, Quaternion b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
        public static Quaternion Normalize(Quaternion q)
        {
            float length = (float)Math.Sqrt(Dot(q, q));
            return length < 1e-15f ? identity : new Quaternion(q.x / length, q.y / length, q.z / length, q.w / length);
        }
        public static Quaternion LookRotation(Vector3 forward) { return LookRotation(forward, Vector3.up); }
        public static Quaternion LookRotation(Vector3 forward, Vector3 upwards)
        {
            Vector3 z = forward.normalized, x = Vector3.Cross(upwards, z).normalized, y = Vector3.Cross(z, x);
            return FromAxes(x, y, z);
        }

        public static Quaternion operator *(Quaternion a, Quaternion b)
        {
            return new Quaternion(
                a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
                a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
                a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
        }
        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            Vector3 u = new Vector3(q.x, q.y, q.z), t = 2 * Vector3.Cross(u, v);
            return v + q.w * t + Vector3.Cross(u, t);
        }
        public static bool operator ==(Quaternion a, Quaternion b) { return Dot(a, b) > 1 - 1e-6f; }
        public static bool operator !=(Quaternion a, Quaternion b) { return !(a == b); }
        public bool Equals(Quaternion o) { return x == o.x && y == o.y && z == o.z && w == o.w; }
        public override bool Equals(object other) { return other is Quaternion && Equals((Quaternion)other); }
        public override int GetHashCode()
        {
            return x.GetHashCode() ^ (y.GetHashCode() << 2) ^ (z.GetHashCode() >> 2) ^ (w.GetHashCode() >> 1);
        }
        public override string ToString() { return "(" + x + ", " + y + ", " + z + ", " + w + ")"; }

        internal static Quaternion FromAxes(Vector3 x, Vector3 y, Vector3 z)
        {
            double w = Math.Sqrt(Math.Max(0, 1.0 + x.x + y.y + z.z)) / 2;
            double i = Math.Sqrt(Math.Max(0, 1.0 + x.x - y.y - z.z)) / 2;
            double j = Math.Sqrt(Math.Max(0, 1.0 - x.x + y.y - z.z)) / 2;
            double k = Math.Sqrt(Math.Max(0, 1.0 - x.x - y.y + z.z)) / 2;
            if (y.z - z.y < 0) i = -i;
            if (z.x - x.z < 0) j = -j;
            if (x.y - y.x < 0) k = -k;
            if (w < 1e-4) // a half turn: signs from the products of the axis
            {
                i = Math.Abs(i);
                j = x.y + y.x < 0 ? -Math.Abs(j) : Math.Abs(j);
                k = x.z + z.x < 0 ? -Math.Abs(k) : Math.Abs(k);
            }
            return Normalize(new Quaternion((float)i, (float)j, (float)k, (float)w));
        }

        private static float Degrees(double radians) { return (float)((radians * 180 / Math.PI + 360) % 360); }
    }
}
