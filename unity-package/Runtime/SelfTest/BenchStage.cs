using System;

namespace Mua.SelfTest
{
    /// <summary>GPU milliseconds of one stage in each frame that had it.</summary>
    [Serializable]
    internal sealed class BenchStage
    {
        public string name = "";
        public float[] gpu = new float[0];
    }
}
