namespace Mua.Format
{
    /// <summary>A clip of motion on the avatar's skeleton; Mua.Motion.ClipSampler reads it.</summary>
    public sealed class Clip
    {
        public string Name { get; internal set; }

        /// <summary>Frames per second.</summary>
        public float Rate { get; internal set; }

        /// <summary>[F, J, 4] local rotations, unit up to their rounding in storage.</summary>
        public Tensor Rotations { get; internal set; }

        /// <summary>[F, 3] local translation of the root joint, metres.</summary>
        public Tensor Translation { get; internal set; }

        /// <summary>[F, M, 3] local translations of the skeleton's translated joints, metres; null where it has none.</summary>
        public Tensor Translations { get; internal set; }

        /// <summary>[F, E] weights of the avatar's expressions, 0 to 1; null where it moves none.</summary>
        public Tensor Expressions { get; internal set; }

        /// <summary>F.</summary>
        public int FrameCount => Rotations.Shape[0];
    }
}
