using System;
using System.Collections.Generic;
using Unity.Profiling;
using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    /// <summary>
    /// Milliseconds of the stages of a frame, by the package's profiler markers: of the GPU where the device times it, else of
    /// recording. Players that are not development builds record none.
    /// </summary>
    internal sealed class StageTimes : IDisposable
    {
        private const int Frames = 32; // averaged
        private const double NanosecondsOfMillisecond = 1e6;

        private static readonly string[] Stages = { "coarse mesh", "texture", "pose", "project", "sort", "draw" };

        private readonly string[] markers = new string[Stages.Length];
        private readonly ProfilerRecorder[] recorders = new ProfilerRecorder[Stages.Length];
        private readonly FrameTiming[] whole = new FrameTiming[1];
        private readonly ProfilerRecorderOptions options =
            ProfilerRecorderOptions.Default | ProfilerRecorderOptions.StartImmediately;

        public StageTimes()
        {
            IsOfGpu = SystemInfo.supportsGpuRecorder;
            options |= IsOfGpu ? ProfilerRecorderOptions.GpuRecorder : ProfilerRecorderOptions.None;
            for (int i = 0; i < Stages.Length; i++)
            {
                markers[i] = "MUA " + Stages[i];
            }
            Attach();
        }

        /// <summary>Names of the stages, in the order of a frame.</summary>
        public IReadOnlyList<string> Names => Stages;

        /// <summary>Whether Of returns GPU time; otherwise it returns CPU time.</summary>
        public bool IsOfGpu { get; }

        /// <summary>Looks for markers that do not exist yet; they appear with the first avatar.</summary>
        public void Attach()
        {
            for (int i = 0; i < recorders.Length; i++)
            {
                if (!recorders[i].Valid)
                {
                    recorders[i].Dispose();
                    recorders[i] = new ProfilerRecorder(markers[i], Frames, options);
                }
            }
        }

        /// <summary>Milliseconds of a stage, on the average of the last frames; NaN where nothing is known.</summary>
        public double Of(int stage)
        {
            ProfilerRecorder recorder = recorders[stage];
            int count = recorder.Valid ? recorder.Count : 0;
            double total = 0;
            for (int i = 0; i < count; i++)
            {
                total += recorder.GetSample(i).Value;
            }
            return count == 0 ? double.NaN : total / count / NanosecondsOfMillisecond;
        }

        /// <summary>Milliseconds of the whole frame on the GPU; NaN where the project does not record frame timings.</summary>
        public double OfFrame()
        {
            return FrameTimingManager.GetLatestTimings(1, whole) == 1 && whole[0].gpuFrameTime > 0
                ? whole[0].gpuFrameTime
                : double.NaN;
        }

        public void Dispose()
        {
            for (int i = 0; i < recorders.Length; i++)
            {
                recorders[i].Dispose();
            }
        }
    }
}
