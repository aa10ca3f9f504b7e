using System.Globalization;

namespace Mua.Format
{
    /// <summary>The file's own checksum: CRC-32 of the whole file with the checksum's four bytes zero.</summary>
    internal static class Checksum
    {
        private static readonly byte[] Blank = new byte[4];

        public static void Require(Table tree, byte[] content)
        {
            int at = tree.Position("crc32");
            if (at == 0)
            {
                throw new AvatarFormatException("missing", "crc32", "the field is required and absent");
            }
            uint stated = (uint)tree.Number("crc32"), found = Compute(content, at);
            if (found != stated)
            {
                throw new AvatarFormatException(
                    "checksum", "crc32",
                    string.Format(
                        CultureInfo.InvariantCulture, "{0:x8}, but the content gives {1:x8}: the file is damaged",
                        stated, found));
            }
        }

        /// <summary>The checksum of `content`, whose own four bytes stand at byte `at`.</summary>
        public static uint Compute(byte[] content, int at)
        {
            uint crc = Crc32.Append(Crc32.Append(0, content, 0, at), Blank, 0, Blank.Length);
            return Crc32.Append(crc, content, at + Blank.Length, content.Length - at - Blank.Length);
        }
    }
}
