using System;

namespace Mua
{
    /// <summary>What is drawn of an avatar.</summary>
    [Flags]
    public enum AvatarViews
    {
        None = 0,

        /// <summary>The avatar itself.</summary>
        Splats = 1,

        /// <summary>The surface through the splats' centres, shaded.</summary>
        Geometry = 2,

        /// <summary>The coarse template mesh, shaded.</summary>
        Mesh = 4,

        /// <summary>The bones.</summary>
        Skeleton = 8,

        /// <summary>The shadow of the template mesh on other objects.</summary>
        Shadow = 16,
    }
}
