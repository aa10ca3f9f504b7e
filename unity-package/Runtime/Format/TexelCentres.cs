using System;

namespace Mua.Format
{
    /// <summary>
    /// Where texels' centres lie in their triangles, from UV alone; mirrors centre_barycentrics of
    /// python/mua/rig/texel_map.py operation for operation (section 5.5 of schemas/README.md).
    /// </summary>
    internal static class TexelCentres
    {
        /// <summary>[N, 2] the first two barycentrics; NaN where a triangle has no area.</summary>
        public static float[] Barycentrics(Template template, int size, ReadOnlySpan<int> texels, ReadOnlySpan<int> triangles)
        {
            float[] uv = template.Uv.ToFloats();
            ReadOnlySpan<int> corners = template.UvFaces.Integers;
            var found = new float[2 * texels.Length];
            for (int e = 0; e < texels.Length; e++)
            {
                int a = 2 * corners[3 * triangles[e]], b = 2 * corners[3 * triangles[e] + 1];
                int c = 2 * corners[3 * triangles[e] + 2];
                double column = texels[e] % size + 0.5, row = texels[e] / size + 0.5;
                double ax = (double)uv[a] * size - column, ay = (double)uv[a + 1] * size - row;
                double bx = (double)uv[b] * size - column, by = (double)uv[b + 1] * size - row;
                double cx = (double)uv[c] * size - column, cy = (double)uv[c + 1] * size - row;
                double one = bx * cy - by * cx, two = cx * ay - cy * ax, three = ax * by - ay * bx;
                double whole = one + two + three;
                if (whole == 0)
                {
                    found[2 * e] = found[2 * e + 1] = float.NaN;
                    continue;
                }
                found[2 * e] = (float)Math.Min(Math.Max(one / whole, 0), 1);
                found[2 * e + 1] = (float)Math.Min(Math.Max(two / whole, 0), 1 - (double)found[2 * e]);
            }
            return found;
        }
    }
}
