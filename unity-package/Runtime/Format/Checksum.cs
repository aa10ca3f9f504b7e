using System.Globalization;

namespace Mua.Format
{
    /// <summary>
    /// The file's own checksum: CRC-32, as in zlib and PNG, of the whole file with the checksum's four bytes zero. Eight bytes
    /// at a step.
    /// </summary>
    internal static class Checksum
    {
        private const uint Polynomial = 0xEDB88320; // reflected
        private const int Step = 8;

        private static readonly byte[] Blank = new byte[4];
        private static readonly uint[][] Tables = CreateTables();

        public static void Require(Table tree, byte[] content)
        {
            int at = tree.Position("crc32");
            if (at == 0)
            {
                throw new AvatarFormatException("missing", "crc32", "the field is required and absent");
            }
            uint found = Append(Append(0, content, 0, at), Blank, 0, Blank.Length);
            found = Append(found, content, at + Blank.Length, content.Length - at - Blank.Length);
            uint stated = (uint)tree.Number("crc32");
            if (found != stated)
            {
                throw new AvatarFormatException(
                    "checksum", "crc32",
                    string.Format(
                        CultureInfo.InvariantCulture, "{0:x8}, but the content gives {1:x8}: the file is damaged; {2}",
                        stated, found, Parser.Again));
            }
        }

        /// <summary>The checksum of `count` bytes from `offset` on, continuing that of the bytes before them.</summary>
        public static uint Append(uint crc, byte[] content, int offset, int count)
        {
            uint[] t0 = Tables[0], t1 = Tables[1], t2 = Tables[2], t3 = Tables[3];
            uint[] t4 = Tables[4], t5 = Tables[5], t6 = Tables[6], t7 = Tables[7];
            int at = offset, end = offset + count;
            crc = ~crc;
            for (; end - at >= Step; at += Step)
            {
                crc = t7[content[at] ^ (byte)crc] ^ t6[content[at + 1] ^ (byte)(crc >> 8)]
                    ^ t5[content[at + 2] ^ (byte)(crc >> 16)] ^ t4[content[at + 3] ^ (crc >> 24)]
                    ^ t3[content[at + 4]] ^ t2[content[at + 5]] ^ t1[content[at + 6]] ^ t0[content[at + 7]];
            }
            for (; at < end; at++)
            {
                crc = t0[content[at] ^ (byte)crc] ^ (crc >> 8);
            }
            return ~crc;
        }

        /// <summary>Table k holds what a byte contributes k bytes later.</summary>
        private static uint[][] CreateTables()
        {
            var tables = new uint[Step][];
            for (int k = 0; k < Step; k++)
            {
                tables[k] = new uint[256];
                for (uint value = 0; value < 256; value++)
                {
                    tables[k][value] = k == 0 ? Divide(value) : Shift(tables[k - 1][value], tables[0]);
                }
            }
            return tables;
        }

        private static uint Divide(uint value)
        {
            for (int bit = 0; bit < 8; bit++)
            {
                value = (value & 1) != 0 ? Polynomial ^ (value >> 1) : value >> 1;
            }
            return value;
        }

        private static uint Shift(uint value, uint[] table)
        {
            return table[value & 0xFF] ^ (value >> 8);
        }
    }
}
