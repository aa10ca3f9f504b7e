// Stand-in. Source: Unity 6000.0, ProfilerRecorder.bindings.cs; a test says what the markers measured.
using System;
using System.Collections.Generic;

namespace Unity.Profiling
{
    public struct ProfilerCategory
    {
        public static ProfilerCategory Render { get { return new ProfilerCategory(); } }
    }

    [Flags]
    public enum ProfilerRecorderOptions
    {
        None = 0, StartImmediately = 1, KeepAliveDuringDomainReload = 2, CollectOnlyOnCurrentThread = 4, WrapAroundWhenCapacityReached = 8,
        SumAllSamplesInFrame = 16, GpuRecorder = 64, Default = WrapAroundWhenCapacityReached | SumAllSamplesInFrame
    }

    public struct ProfilerRecorderSample
    {
        public long Value { get; internal set; }
        public long Count { get { return 1; } }
    }

    public struct ProfilerRecorder : IDisposable
    {
        private readonly bool started;
        private string name;

        public ProfilerRecorder(string statName, int capacity = 1, ProfilerRecorderOptions options = ProfilerRecorderOptions.Default)
        {
            StandIns.Markers.Open++;
            name = statName;
            started = (options & ProfilerRecorderOptions.StartImmediately) != 0;
        }

        public static ProfilerRecorder StartNew(ProfilerCategory category, string statName, int capacity = 1, ProfilerRecorderOptions options = ProfilerRecorderOptions.Default)
        {
            return new ProfilerRecorder(statName, capacity, options | ProfilerRecorderOptions.StartImmediately);
        }

        public bool Valid { get { return name != null && StandIns.Markers.Samples.ContainsKey(name); } }
        public int Count { get { return started ? StandIns.Markers.Samples[name].Length : 0; } }
        public long LastValue { get { return Count == 0 ? 0 : GetSample(Count - 1).Value; } }
        public ProfilerRecorderSample GetSample(int index) { return new ProfilerRecorderSample { Value = StandIns.Markers.Samples[name][index] }; }
        public void Dispose()
        {
            StandIns.Markers.Open -= name == null ? 0 : 1;
            name = null;
        }
    }
}

namespace Unity.Profiling.LowLevel
{
    [Flags]
    public enum MarkerFlags : ushort { Default = 0, Script = 2, Warning = 16, Counter = 128, SampleGPU = 256 }
}

namespace StandIns
{
    /// <summary>What the profiler measured of a marker, nanoseconds by frame. Not part of Unity's API.</summary>
    public static class Markers
    {
        internal static readonly Dictionary<string, long[]> Samples = new Dictionary<string, long[]>();

        public static int Open { get; internal set; }
        public static void Measure(string marker, params long[] nanoseconds) { Samples[marker] = nanoseconds; }
    }
}
