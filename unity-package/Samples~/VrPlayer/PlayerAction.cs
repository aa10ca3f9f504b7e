using System;

namespace Mua.Samples.VrPlayer
{
    /// <summary>What happens once when a button or key goes down.</summary>
    [Flags]
    internal enum PlayerAction
    {
        None = 0,
        PlayPause = 1,
        NextFrame = 2,
        PreviousFrame = 4,
        NextClip = 8,
        PreviousClip = 16,
        NextAvatar = 32,
        PreviousAvatar = 64,
        Splats = 128,
        Geometry = 256,
        Mesh = 512,
        Skeleton = 1024,
        Shadow = 2048,

        /// <summary>User and avatar go back to where they began, at natural size.</summary>
        Reset = 4096,

        /// <summary>Shows or hides the page of buttons.</summary>
        Help = 8192,
    }
}
