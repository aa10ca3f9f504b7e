using Unity.Profiling;
using Unity.Profiling.LowLevel;

namespace Mua
{
    /// <summary>The stages of a frame for Unity's profiler, on the CPU that records them and on the GPU.</summary>
    internal static class AvatarStages
    {
        public static readonly ProfilerMarker CoarseMesh = Marker("MUA coarse mesh");
        public static readonly ProfilerMarker Texture = Marker("MUA texture");
        public static readonly ProfilerMarker Pose = Marker("MUA pose");
        public static readonly ProfilerMarker Project = Marker("MUA project");
        public static readonly ProfilerMarker Sort = Marker("MUA sort");
        public static readonly ProfilerMarker Draw = Marker("MUA draw");

        private static ProfilerMarker Marker(string name)
        {
            return new ProfilerMarker(ProfilerCategory.Render, name, MarkerFlags.SampleGPU);
        }
    }
}
