namespace Mua
{
    /// <summary>The three detail subbands of one level.</summary>
    internal sealed class BandBuffers
    {
        public readonly StoredBuffer Mean;
        public readonly StoredBuffer H;
        public readonly StoredBuffer W;
        public readonly int Rank;
        public readonly int Size; // texels along a side

        public BandBuffers(StoredBuffer mean, StoredBuffer h, StoredBuffer w, int rank, int size)
        {
            Mean = mean;
            H = h;
            W = w;
            Rank = rank;
            Size = size;
        }
    }
}
