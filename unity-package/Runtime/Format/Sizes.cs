using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>
    /// Counts of parts and the size of the texture, which a few bytes could claim: checked before any tensor is opened.
    /// Mirrors python/mua/asset/sizes.py.
    /// </summary>
    internal static class Sizes
    {
        public static void Require(Table tree, byte[] content)
        {
            Table wavelet = tree.Child("wavelet"), texels = tree.Child("texels");
            long levels = wavelet.Number("levels");
            int geometry = tree.Child("geometry").Children("details").Length;
            int appearance = tree.Child("appearance").Children("details").Length;
            Require("skeleton.names", tree.Child("skeleton").Texts("names").Length, 0, Limits.MaxJoints);
            Require("wavelet.levels", levels, 1, Limits.MaxLevels);
            RequireTexture(texels, (int)levels, content);
            foreach (string part in new[] { "coarse", "geometry", "appearance" })
            {
                Require(part + ".mlp", tree.Child(part).Children("mlp").Length, 0, Limits.MaxLayers);
            }
            Require("geometry.details", geometry, 0, levels);
            Require("appearance.details", appearance, 0, levels);
            long most = Math.Min(Limits.MaxDetailLevels, levels - Math.Max(geometry, appearance));
            most = wavelet.Block("rec_lo").Count > Limits.MostTaps ? 0 : most;
            Require("texels.levels", texels.Children("levels").Length, 0, most);
            Require("clips", tree.Children("clips").Length, 0, Limits.MaxClips);
            Table expressions = tree.Child("expressions");
            Require("expressions.names", expressions == null ? 0 : expressions.Texts("names").Length, 0, Limits.MaxExpressions);
        }

        /// <summary>The texture's memory goes with its sides, which a few bytes could claim: so many must be valid.</summary>
        private static void RequireTexture(Table texels, int levels, byte[] content)
        {
            long side = texels.Number("size");
            Block shape = texels.Child("texels").Block("shape");
            uint count = shape.Count == 0
                ? 0
                : MemoryMarshal.Read<uint>(new ReadOnlySpan<byte>(content, shape.Offset, sizeof(uint)));
            Require("texels.size", side, 1, Limits.MaxSide);
            if (side % (1 << levels) != 0)
            {
                throw Refusal.Of("texels.size", "{0} does not halve {1} times", side, levels);
            }
            if (side * side > (long)Limits.TextureTimes * count + Limits.TextureRoom)
            {
                throw Refusal.Of("texels.size", "{0}, too large for {1} valid texels", side, count);
            }
        }

        private static void Require(string field, long number, long least, long most)
        {
            if (number < least || number > most)
            {
                throw Refusal.Of(field, "{0}, expected {1} to {2}", number, least, most);
            }
        }
    }
}
