using UnityEngine;

namespace Mua
{
    /// <summary>The avatars of the open scenes.</summary>
    internal static class AvatarScene
    {
        /// <summary>Those of active GameObjects, in no order.</summary>
        public static AvatarRenderer[] All()
        {
#if UNITY_6000_4_OR_NEWER // where the one below is deprecated
            return Object.FindObjectsByType<AvatarRenderer>();
#else
            return Object.FindObjectsByType<AvatarRenderer>(FindObjectsSortMode.None);
#endif
        }
    }
}
