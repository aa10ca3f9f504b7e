namespace Mua
{
    /// <summary>How many texels of an avatar are shown.</summary>
    public enum AvatarLevel
    {
        /// <summary>As many as can be distinguished at its distance, within the AvatarBudget if there is one.</summary>
        Automatic,

        /// <summary>All.</summary>
        Full,

        /// <summary>Half as many along a side, a quarter of the splats.</summary>
        Half,

        /// <summary>A quarter along a side, a sixteenth of the splats.</summary>
        Quarter,
    }
}
