namespace Mua.Samples.VrPlayer
{
    /// <summary>An avatar that can be shown.</summary>
    internal sealed class AvatarEntry
    {
        public AvatarEntry(string name, string path, AvatarAsset asset)
        {
            Name = name;
            Path = path;
            Asset = asset;
        }

        public string Name { get; }

        /// <summary>Of a file; null where Asset is set.</summary>
        public string Path { get; }

        /// <summary>An imported avatar; null where Path is set.</summary>
        public AvatarAsset Asset { get; }

        /// <summary>Whether it was tried and cannot be shown.</summary>
        public bool HasFailed { get; set; }
    }
}
