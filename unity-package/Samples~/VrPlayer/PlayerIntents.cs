using System;
using UnityEngine;

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
        Template = 512,
        Skeleton = 1024,
        Shadow = 2048,

        /// <summary>Resets user and avatar to where they began, at natural size.</summary>
        Reset = 4096,

        /// <summary>Shows or hides the page of buttons.</summary>
        Help = 8192,
    }

    /// <summary>
    /// What the user asks for in one frame, whichever device said so. Amounts are of full speed, from -1 to 1.
    /// </summary>
    internal struct PlayerIntents
    {
        /// <summary>Buttons and keys that went down in this frame.</summary>
        public PlayerAction Pressed;

        /// <summary>Walk to the right and forward, relative to where the user looks.</summary>
        public Vector2 Walk;

        /// <summary>Upward movement.</summary>
        public float Rise;

        /// <summary>Turn of the view to the right and up in this frame, degrees.</summary>
        public Vector2 Look;

        /// <summary>Turn of the avatar, clockwise seen from above.</summary>
        public float Turn;

        /// <summary>Zoom; positive shows the avatar larger.</summary>
        public float Zoom;

        /// <summary>Scrubbing through the clip, forward.</summary>
        public float Scrub;
    }
}
