using System;

namespace Mua.SelfTest
{
    /// <summary>What bench.json holds; names of fields are those of the file, times are milliseconds.</summary>
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
}
