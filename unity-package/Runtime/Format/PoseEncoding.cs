namespace Mua.Format
{
    /// <summary>How a window of poses becomes what the MLPs read (schemas/README.md, section 3).</summary>
    public sealed class PoseEncoding
    {
        private const int RootNumbers = 9, JointNumbers = 6, TranslationNumbers = 3;

        /// <summary>[S] joints encoded beside the root, ascending.</summary>
        public int[] Joints { get; internal set; }

        /// <summary>[T] joints whose translation is encoded, ascending; of the skeleton's translated ones.</summary>
        public int[] Translated { get; internal set; }

        /// <summary>Frames per second between the frames of a window.</summary>
        public float Rate { get; internal set; }

        /// <summary>Frames of a window.</summary>
        public int Window { get; internal set; }

        /// <summary>Whether the yaw of the newest frame is turned back.</summary>
        public bool Heading { get; internal set; }

        /// <summary>[Width] what is subtracted from a descriptor.</summary>
        public float[] Mean { get; internal set; }

        /// <summary>[Width] what it is divided by then.</summary>
        public float[] Scale { get; internal set; }

        /// <summary>[K, Width] principal components of the descriptor so normalised.</summary>
        public Tensor Components { get; internal set; }

        /// <summary>[2, K] lowest and highest value of each component in training.</summary>
        public float[] Ranges { get; internal set; }

        /// <summary>[K] how far beyond its range a component may go.</summary>
        public float[] Margins { get; internal set; }

        /// <summary>K: numbers that the MLPs read.</summary>
        public int ComponentCount => Margins.Length;

        /// <summary>Numbers that one frame of the window adds to a descriptor.</summary>
        public int FrameWidth => RootNumbers + JointNumbers * Joints.Length + TranslationNumbers * Translated.Length;

        /// <summary>Length of a descriptor.</summary>
        public int Width => JointNumbers * Joints.Length + Window * FrameWidth;
    }
}
