using System;
using System.Collections.Generic;
using Unity.Profiling;
using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>GPU milliseconds of one stage in each frame that had it.</summary>
    [Serializable]
    internal sealed class BenchStage
    {
        public string name = "";
        public float[] gpu = new float[0];
    }

    /// <summary>The content of bench.json; names of fields are those of the file, times are milliseconds.</summary>
    [Serializable]
    internal sealed class BenchReport
    {
        public string avatar = "";
        public string device = "";
        public float[] frames = new float[0]; // from one to the next
        public float[] cpu = new float[0]; // as FrameTimingManager has them; empty where it is off
        public float[] gpu = new float[0];
        public BenchStage[] stages = new BenchStage[0]; // those that the device times
    }

    /// <summary>Times of frames as they pass, in milliseconds, without an allocation.</summary>
    internal sealed class FrameTimes : IDisposable
    {
        private const int MostRate = 144; // Hz
        private const float Milliseconds = 1000;
        private const double Nanosecond = 1e-6; // in milliseconds

        private static readonly string[] Stages =
        {
            "MUA coarse mesh", "MUA texture", "MUA pose", "MUA project", "MUA sort",
            "MUA draw",
        };

        private readonly List<float> frames, cpu, gpu;
        private readonly FrameTiming[] timings = new FrameTiming[1];
        private readonly ProfilerRecorder[] recorders = new ProfilerRecorder[Stages.Length];
        private readonly List<float>[] stages = new List<float>[Stages.Length];

        /// <summary>Place for so many seconds of frames.</summary>
        public FrameTimes(float seconds)
        {
            int count = (int)(seconds * MostRate) + MostRate;
            frames = new List<float>(count);
            cpu = new List<float>(count);
            gpu = new List<float>(count);
            for (int i = 0; i < Stages.Length; i++)
            {
                stages[i] = new List<float>(count);
                recorders[i] = ProfilerRecorder.StartNew(
                    ProfilerCategory.Render, Stages[i], 1,
                    ProfilerRecorderOptions.Default | ProfilerRecorderOptions.GpuRecorder);
            }
        }

        /// <summary>The frame that has just passed.</summary>
        public void Add()
        {
            frames.Add(Time.unscaledDeltaTime * Milliseconds);
            FrameTimingManager.CaptureFrameTimings();
            if (FrameTimingManager.GetLatestTimings(1, timings) > 0)
            {
                cpu.Add((float)timings[0].cpuFrameTime);
                gpu.Add((float)timings[0].gpuFrameTime);
            }
            for (int i = 0; i < recorders.Length; i++)
            {
                if (recorders[i].Valid && recorders[i].LastValue > 0)
                {
                    stages[i].Add((float)(recorders[i].LastValue * Nanosecond));
                }
            }
        }

        public BenchReport Report(string avatar, string device)
        {
            var timed = new List<BenchStage>();
            for (int i = 0; i < Stages.Length; i++)
            {
                if (stages[i].Count > 0)
                {
                    timed.Add(new BenchStage { name = Stages[i], gpu = stages[i].ToArray() });
                }
            }
            return new BenchReport
            {
                avatar = avatar, device = device, frames = frames.ToArray(), cpu = cpu.ToArray(), gpu = gpu.ToArray(),
                stages = timed.ToArray(),
            };
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
