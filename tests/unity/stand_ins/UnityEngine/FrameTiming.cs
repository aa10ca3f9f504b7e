// Stand-in. Source: Unity 6000.0, Graphics.bindings.cs; a test says how long the GPU took.
namespace UnityEngine
{
    public struct FrameTiming
    {
        public double cpuFrameTime;
        public double gpuFrameTime;
    }

    public static class FrameTimingManager
    {
        public static void CaptureFrameTimings() { }
        public static uint GetLatestTimings(uint numFrames, FrameTiming[] timings)
        {
            if (StandIns.Timings.Gpu == 0)
                return 0;
            timings[0].gpuFrameTime = StandIns.Timings.Gpu;
            return 1;
        }
    }
}

namespace StandIns
{
    /// <summary>Milliseconds of a frame on the GPU; 0 where timings are not recorded. Not part of Unity's API.</summary>
    public static class Timings
    {
        public static double Gpu { get; set; }
    }
}
