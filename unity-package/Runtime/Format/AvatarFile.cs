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
            Unpacking.Of(tree, content);
            return new AvatarDecoder(content).Decode(tree);
        }

        private static void RequireStages(Block stages, byte[] content)
        {
            long last = 0;
            for (int i = 0; stages != null && i < stages.Count; i++)
            {
                uint end = MemoryMarshal.Read<uint>(new ReadOnlySpan<byte>(content, stages.Offset + 4 * i, 4));
                if (end < last || end > content.Length)
                {
                    throw Refusal.Of(
                        "stages", "{0} after {1}, expected rising numbers up to the file's {2} bytes", end, last,
                        content.Length);
                }
                last = end;
            }
        }
    }
}
