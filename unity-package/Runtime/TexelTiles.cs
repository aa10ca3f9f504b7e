namespace Mua
{
    /// <summary>
    /// The tiles that hold a valid texel, as the kernel UpsampleTexels takes them: `texel_tiles` of
    /// python/mua/kernels/inverse_dwt.py.
    /// </summary>
    internal sealed class TexelTiles
    {
        /// <summary>Texels along a side of a tile.</summary>
        public const int Side = 16;

        /// <summary>One row of a tile: two words of the kernel.</summary>
        public struct Row
        {
            public int First; // valid texel of the row
            public int Columns; // the valid ones as bits
        }

        /// <param name="texels">[N] row * size + column, ascending.</param>
        /// <param name="size">Texels along a side of the texture.</param>
        public TexelTiles(int[] texels, int size)
        {
            int across = (size + Side - 1) / Side;
            int[] places = Places(texels, size, across);
            Rows = new Row[Side * Tiles.Length];
            for (int i = 0; i < texels.Length; i++)
            {
                int row = texels[i] / size, column = texels[i] % size;
                int at = Side * places[row / Side * across + column / Side] + row % Side;
                if (Rows[at].Columns == 0)
                {
                    Rows[at].First = i;
                }
                Rows[at].Columns |= 1 << column % Side;
            }
        }

        /// <summary>[T] row * 65536 + column of a tile, ascending.</summary>
        public int[] Tiles { get; private set; }

        /// <summary>[T, 16].</summary>
        public Row[] Rows { get; }

        /// <summary>Lists the tiles; returns where in the list each of the texture's is.</summary>
        private int[] Places(int[] texels, int size, int across)
        {
            var held = new bool[across * across];
            int count = 0;
            foreach (int texel in texels)
            {
                int tile = texel / size / Side * across + texel % size / Side;
                count += held[tile] ? 0 : 1;
                held[tile] = true;
            }
            Tiles = new int[count];
            var places = new int[held.Length];
            int next = 0;
            for (int tile = 0; tile < held.Length; tile++)
            {
                if (held[tile])
                {
                    Tiles[next] = (tile / across << 16) + tile % across;
                    places[tile] = next++;
                }
            }
            return places;
        }
    }
}
