namespace Mua
{
    /// <summary>How far an AvatarRenderer is with its avatar.</summary>
    public enum AvatarState
    {
        /// <summary>There is nothing to show.</summary>
        Empty,

        /// <summary>The file is read, checked and uploaded, a part in each frame.</summary>
        Loading,

        /// <summary>It is drawn.</summary>
        Ready,

        /// <summary>AvatarRenderer.Message says why it is not.</summary>
        Failed,
    }
}
