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

        /// <summary>One row of a tile, after the tile's own column and row: two words of the kernel.</summary>
        public struct Row
        {
            public int First; // valid texel of the row
            public int Columns; // the valid ones as bits, from bit 16 on those in reach of expressions
        }

        /// <param name="texels">[N] row * size + column, ascending.</param>
        /// <param name="size">Texels along a side of the texture.</param>
        /// <param name="isReached">[N] those that expressions may change.</param>
        public TexelTiles(int[] texels, int size, bool[] isReached)
        {
            int across = (size + Side - 1) / Side;
            int[] places = Places(texels, size, across);
            for (int i = 0; i < texels.Length; i++)
            {
                int row = texels[i] / size, column = texels[i] % size;
                int at = (Side + 1) * places[row / Side * across + column / Side] + 1 + row % Side;
                if (Rows[at].Columns == 0)
                {
                    Rows[at].First = i;
                }
                Rows[at].Columns |= (isReached[i] ? 1 << Side | 1 : 1) << column % Side;
            }
        }

        /// <summary>T.</summary>
        public int Count => Rows.Length / (Side + 1);

        /// <summary>[T, 17], the tiles ascending.</summary>
        public Row[] Rows { get; private set; }

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
            Rows = new Row[(Side + 1) * count];
            var places = new int[held.Length];
            int next = 0;
            for (int tile = 0; tile < held.Length; tile++)
            {
                if (held[tile])
                {
                    Rows[(Side + 1) * next] = new Row { First = tile % across, Columns = tile / across };
                    places[tile] = next++;
                }
            }
            return places;
        }
    }
}
