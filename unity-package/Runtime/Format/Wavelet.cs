namespace Mua.Format
{
    /// <summary>Synthesis filters of a biorthogonal wavelet in periodization mode.</summary>
    public sealed class Wavelet
    {
        /// <summary>As in PyWavelets, such as `bior4.4`.</summary>
        public string Name { get; internal set; }

        /// <summary>Levels from LL to the texture: size = LL size * 2^Levels.</summary>
        public int Levels { get; internal set; }

        public double[] RecLo { get; internal set; }

        public double[] RecHi { get; internal set; }
    }
}
