// Stand-in. Source: Unity 6000.0 scripting reference, Bounds, Color, Rect.
using System;

namespace UnityEngine
{
    public struct Bounds
    {
        public Vector3 center { get; set; }
        public Vector3 extents { get; set; }

        public Bounds(Vector3 center, Vector3 size) : this() { this.center = center; extents = size * 0.5f; }

        public Vector3 size { get { return extents * 2; } set { extents = value * 0.5f; } }
        public Vector3 min { get { return center - extents; } set { SetMinMax(value, max); } }
        public Vector3 max { get { return center + extents; } set { SetMinMax(min, value); } }
        public void SetMinMax(Vector3 min, Vector3 max)
        {
            extents = (max - min) * 0.5f;
            center = min + extents;
        }
        public void Encapsulate(Vector3 point) { SetMinMax(Vector3.Min(min, point), Vector3.Max(max, point)); }
        public void Encapsulate(Bounds bounds) { Encapsulate(bounds.min); Encapsulate(bounds.max); }
        public bool Contains(Vector3 p)
        {
            Vector3 low = min, high = max;
            return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
        }
    }

    public struct Color
    {
        public float r, g, b, a;

        public Color(float r, float g, float b, float a) { this.r = r; this.g = g; this.b = b; this.a = a; }
        public Color(float r, float g, float b) { this.r = r; this.g = g; this.b = b; a = 1; }

        public static Color clear { get { return new Color(0, 0, 0, 0); } }

        public static implicit operator Vector4(Color c) { return new Vector4(c.r, c.g, c.b, c.a); }
        public static implicit operator Color(Vector4 v) { return new Color(v.x, v.y, v.z, v.w); }
        public static Color operator *(Color a, float b) { return new Color(a.r * b, a.g * b, a.b * b, a.a * b); }
    }

    public sealed class Gizmos
    {
        public static readonly System.Collections.Generic.List<Bounds> Cubes = new System.Collections.Generic.List<Bounds>(); // not Unity's

        public static Color color { get; set; }
        public static void DrawCube(Vector3 center, Vector3 size) { Cubes.Add(new Bounds(center, size)); }
    }

    public struct Rect
    {
        public float x { get; set; }
        public float y { get; set; }
        public float width { get; set; }
        public float height { get; set; }

        public Rect(float x, float y, float width, float height) : this()
        {
            this.x = x;
            this.y = y;
            this.width = width;
            this.height = height;
        }
    }
}
