using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>
    /// A `.muaavatar` in memory: small parts as arrays, large ones as views of the file's bytes, which must not change
    /// while this lives. Whatever leaves Read has passed every check of schemas/README.md.
    /// </summary>
    public sealed class AvatarFile
    {
        /// <summary>The bytes of the file.</summary>
        public byte[] Content { get; internal set; }

        public string Name { get; internal set; }

        /// <summary>Program and version that trained the avatar.</summary>
        public string Producer { get; internal set; }

        public string Notes { get; internal set; }

        public Skeleton Skeleton { get; internal set; }

        public PoseEncoding Encoding { get; internal set; }

        public Template Template { get; internal set; }

        public Texels Texels { get; internal set; }

        public Wavelet Wavelet { get; internal set; }

        public Coarse Coarse { get; internal set; }

        public Branch Geometry { get; internal set; }

        public Branch Appearance { get; internal set; }

        public Clip[] Clips { get; internal set; }

        /// <summary>[6] lowest, then highest corner of all clips' poses about the root joint's position, metres.</summary>
        public float[] Bounds { get; internal set; }

        /// <summary>A PNG, or nothing.</summary>
        public ArraySegment<byte> Thumbnail { get; internal set; }

        /// <summary>Triangles over the texels; null where the file holds none.</summary>
        public Surface Surface { get; internal set; }

        /// <summary>What moves its face besides joints; null where the file holds none.</summary>
        public Expressions Expressions { get; internal set; }

        /// <summary>E.</summary>
        public int ExpressionCount => Expressions == null ? 0 : Expressions.Names.Length;

        /// <summary>The avatar in `content`, which it keeps; AvatarFormatException says what is wrong with a bad one.</summary>
        public static AvatarFile Read(byte[] content)
        {
            if (content == null)
            {
                throw new ArgumentNullException(nameof(content));
            }
            Table tree = Parser.Parse(content);
            Checksum.Require(tree, content);
            return Decode(tree, content);
        }

        /// <summary>The avatar of a tree that Parser made of `content`.</summary>
        internal static AvatarFile Decode(Table tree, byte[] content)
        {
            RequireStages(tree.Block("stages"), content);
            Sizes.Require(tree, content);
            Unpacking.Of(tree, content);
            return new AvatarDecoder(content).Decode(tree);
        }

        private static void RequireStages(Block stages, byte[] content)
        {
            if (stages == null)
            {
                return;
            }
            var bytes = new ReadOnlySpan<byte>(content, stages.Offset, sizeof(uint) * stages.Count);
            uint[] ends = MemoryMarshal.Cast<byte, uint>(bytes).ToArray();
            bool rises = ends.Length == Limits.Stages && ends[Limits.Stages - 1] <= content.Length;
            for (int i = 1; rises && i < Limits.Stages; i++)
            {
                rises = ends[i - 1] <= ends[i];
            }
            if (!rises)
            {
                throw Refusal.Of(
                    "stages", "[{0}], expected {1} rising numbers up to the file's {2} bytes", string.Join(", ", ends),
                    Limits.Stages, content.Length);
            }
        }
    }
}
