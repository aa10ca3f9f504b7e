using System;

namespace Mua.Format
{
    /// <summary>The blocks of 2 x 2 texels that become the texels of a coarser level (schemas/README.md, section 9).</summary>
    public sealed class BlockLevel
    {
        /// <summary>What a texel is to its block: counted, its rotation too, gives it its place on the mesh.</summary>
        public const int Member = 1, Turned = 2, Chief = 3;

        /// <summary>Texels of a block.</summary>
        public const int Four = 4;

        /// <summary>Factor of the standard deviations where one splat stands for four.</summary>
        public const double Growth = Limits.Growth;

        private readonly int[] finer; // [B, 4] valid texels of the finer level, -1 for none
        private readonly byte[] codes; // [B]

        internal BlockLevel(ReadOnlySpan<int> texels, int size, ReadOnlySpan<byte> codes)
        {
            int side = size / 2, count = 0;
            var places = new int[side * side]; // one more than where a block stands
            foreach (int texel in texels)
            {
                places[Number(texel, size)] = 1;
            }
            for (int i = 0; i < places.Length; i++)
            {
                count += places[i];
                places[i] *= count;
            }
            finer = new int[Four * count];
            Texels = new int[count];
            Array.Fill(finer, -1);
            for (int i = 0; i < texels.Length; i++)
            {
                int number = Number(texels[i], size), corner = texels[i] / size % 2 * 2 + texels[i] % size % 2;
                finer[Four * (places[number] - 1) + corner] = i;
                Texels[places[number] - 1] = number;
            }
            this.codes = codes.ToArray();
        }

        /// <summary>[B] blocks as texels of half the size: row * size / 2 + column, ascending.</summary>
        public int[] Texels { get; }

        /// <summary>B.</summary>
        public int Count => Texels.Length;

        /// <summary>What the texel in a corner of a block is to it, 0 where it does not count.</summary>
        public int Kind(int block, int corner)
        {
            return codes[block] >> 2 * corner & 3;
        }

        /// <summary>The valid texel in a corner of a block, upper left, upper right, lower left, lower right; -1 for none.</summary>
        public int Finer(int block, int corner)
        {
            return finer[Four * block + corner];
        }

        /// <summary>The first block that has not one chief or has a member that is no valid texel, -1 where all are sound.</summary>
        internal int FindUnsound()
        {
            for (int block = 0; block < Count; block++)
            {
                int chiefs = 0;
                bool isSound = true;
                for (int corner = 0; corner < Four; corner++)
                {
                    int kind = Kind(block, corner);
                    chiefs += kind == Chief ? 1 : 0;
                    isSound &= kind == 0 || Finer(block, corner) >= 0;
                }
                if (chiefs != 1 || !isSound)
                {
                    return block;
                }
            }
            return -1;
        }

        private static int Number(int texel, int size)
        {
            return texel / size / 2 * (size / 2) + texel % size / 2;
        }
    }
}
