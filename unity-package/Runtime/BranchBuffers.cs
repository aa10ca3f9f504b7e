namespace Mua
{
    /// <summary>Geometry or appearance on the device.</summary>
    internal sealed class BranchBuffers
    {
        public LayerBuffers[] Mlp;
        public StoredBuffer LlMean;
        public StoredBuffer LlBasis;
        public BandBuffers[] Details; // coarse first
        public Upsampling Upsampling; // of the levels without details
        public StoredBuffer StaticOffset;
        public int Channels;
        public int Rank; // of LL
    }
}
