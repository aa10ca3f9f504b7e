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

        /// <summary>The template, the coarse mesh that the joints move, shaded.</summary>
        Template = 4,

        /// <summary>The bones.</summary>
        Skeleton = 8,

        /// <summary>The shadow of the template on other objects.</summary>
        Shadow = 16,
    }
}
