namespace Mua.Format
{
    /// <summary>What moves a face besides its joints: linear targets over the template (section 12 of schemas/README.md).</summary>
    public sealed class Expressions
    {
        /// <summary>[E] no two equal.</summary>
        public string[] Names { get; internal set; }

        /// <summary>[E + 1] into the entries, expression by expression.</summary>
        public Tensor Starts { get; internal set; }

        /// <summary>[P] vertices of the template, ascending within an expression.</summary>
        public Tensor Vertices { get; internal set; }

        /// <summary>[P, 3] how far weight 1 moves them, metres.</summary>
        public Tensor Offsets { get; internal set; }

        /// <summary>[P] how much brighter colours become there, as a share of them; null where they stay.</summary>
        public Tensor Gains { get; internal set; }

        /// <summary>[E] which others each holds back, and what holds it back; null where nothing does.</summary>
        public Tensor Rules { get; internal set; }
    }
}
