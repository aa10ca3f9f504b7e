using System.Globalization;
using System.Linq;
using System.Text;
using Mua.Format;

namespace Mua.Editor
{
    /// <summary>
    /// What a file holds, in the tables and words of `mua-inspect` (python/mua/cli/inspect.py): one line for each row,
    /// cells apart by tabs, an empty line between tables. The first line of a table is its title.
    /// </summary>
    internal static class AvatarSummary
    {
        private const double Mega = 1e6, Giga = 1e9;

        private static readonly string[] Parts =
        {
            "skeleton", "encoding", "template", "texels", "coarse", "geometry", "appearance", "clips", "thumbnail",
            "surface", "expressions",
        };

        /// <summary>The tables of `avatar`.</summary>
        public static string Of(AvatarFile avatar)
        {
            Table tree = Parser.Parse(avatar.Content);
            var text = new StringBuilder();
            Overview(text, tree, avatar);
            Row(text);
            Bytes(text, tree, avatar.Content);
            Row(text);
            Costs(text, AvatarCost.Of(avatar));
            Row(text);
            Clips(text, avatar.Clips);
            return text.ToString();
        }

        private static void Overview(StringBuilder text, Table tree, AvatarFile avatar)
        {
            Skeleton skeleton = avatar.Skeleton;
            PoseEncoding encoding = avatar.Encoding;
            int moved = encoding.Translated.Length;
            Row(text, avatar.Name);
            Row(
                text, "format",
                Format(
                    "{0}.{1}, {2}, metres, Y up, right-handed", tree.Number("version_major"),
                    tree.Number("version_minor"),
                    Unpacking.IsPacked(tree) ? "packed" : avatar.Geometry.LlBasis.Type.ToString().ToLowerInvariant()));
            Row(text, "producer", avatar.Producer);
            Row(text, "notes", avatar.Notes);
            Row(text, "skeleton", Format("{0} joints, root {1}", skeleton.JointCount, skeleton.Names[skeleton.Root]));
            Row(
                text, "descriptor",
                Format(
                    "{0} numbers: {1} frames at {2} a second, root and {3} joints{4}, {5}",
                    encoding.Width, encoding.Window, Short(encoding.Rate), encoding.Joints.Length,
                    moved == 0 ? "" : Format(", {0} of them translated", moved),
                    encoding.Heading ? "heading removed" : "world heading"));
            Row(
                text, "template",
                Format(
                    "{0} vertices, {1} triangles, {2} PCA components", avatar.Coarse.Mean.Shape[0],
                    avatar.Template.Faces.Shape[0], avatar.Coarse.Basis.Shape[0]));
            string[] expressions = avatar.Expressions == null ? new string[0] : avatar.Expressions.Names;
            string names = string.Join(", ", expressions);
            Row(text, "expressions", expressions.Length == 0 ? "none" : expressions.Length + ": " + names);
            Row(text, "expressions' rules", Ruled(avatar.Expressions));
            int size = avatar.Texels.Size;
            Row(text, "texels", Format("{0} of {1} x {1}", avatar.Texels.Count, size));
            Row(text, "wavelet", Format("{0}, {1} levels", avatar.Wavelet.Name, avatar.Wavelet.Levels));
            Row(text, "geometry ranks", Ranks(avatar.Geometry));
            Row(text, "appearance ranks", Ranks(avatar.Appearance));
        }

        private static void Bytes(StringBuilder text, Table tree, byte[] content)
        {
            long[] stored = Parts.Select(tree.Held).ToArray();
            Unpacking.Of(tree, content);
            long[] unpacked = Parts.Select(tree.Held).ToArray();
            bool isPacked = !stored.SequenceEqual(unpacked);
            Row(text, Format("{0:F2} MB", content.Length / Mega));
            Row(text, isPacked ? new[] { "part", "bytes", "unpacked" } : new[] { "part", "bytes" });
            for (int i = 0; i < Parts.Length; i++)
            {
                string size = Format("{0:N0}", stored[i]);
                Row(text, isPacked ? new[] { Parts[i], size, Format("{0:N0}", unpacked[i]) } : new[] { Parts[i], size });
            }
        }

        private static void Costs(StringBuilder text, AvatarCost[] costs)
        {
            double parameters = costs.Sum(cost => cost.Parameters ?? 0), operations = costs.Sum(cost => cost.Operations ?? 0);
            Row(text, Format("{0:F2} M parameters, {1:F3} GFLOPs", parameters / Mega, operations / Giga));
            Row(text, "part", "parameters", "MFLOPs a frame");
            foreach (AvatarCost cost in costs)
            {
                Row(text, cost.Part, Format("{0:N0}", cost.Parameters), Format("{0:F1}", cost.Operations / Mega));
            }
        }

        private static void Clips(StringBuilder text, Clip[] clips)
        {
            Row(text, clips.Length == 1 ? "1 clip" : Format("{0} clips", clips.Length));
            Row(text, "clip", "frames", "a second", "seconds");
            foreach (Clip clip in clips)
            {
                string seconds = Format("{0:F1}", (double)clip.FrameCount / clip.Rate);
                Row(text, clip.Name, Format("{0}", clip.FrameCount), Short(clip.Rate), seconds);
            }
        }

        private static string Ruled(Format.Expressions expressions)
        {
            if (expressions?.Rules == null)
            {
                return "none";
            }
            int[] rules = expressions.Rules.Integers.ToArray();
            string[] ruled = expressions.Names.Where((_, e) => rules[e] != 0).ToArray();
            return ruled.Length == 0 ? "none" : string.Join(", ", ruled);
        }

        private static string Ranks(Branch branch)
        {
            return string.Join(" ", branch.Details.Select(band => band.Rank).Prepend(branch.Rank));
        }

        private static void Row(StringBuilder text, params string[] cells)
        {
            text.Append(string.Join("\t", cells.Select(OneLine))).Append('\n');
        }

        /// <summary>Text of the file that does not break the table.</summary>
        private static string OneLine(string text)
        {
            return text.Replace('\t', ' ').Replace('\n', ' ').Replace('\r', ' ');
        }

        private static string Format(string format, params object[] values)
        {
            return string.Format(CultureInfo.InvariantCulture, format, values);
        }

        /// <summary>Six digits, as Python's format `g`.</summary>
        private static string Short(float value)
        {
            return Format("{0:G6}", value).ToLowerInvariant();
        }
    }
}
