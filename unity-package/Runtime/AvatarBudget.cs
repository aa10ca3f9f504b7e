using UnityEngine;

namespace Mua
{
    /// <summary>
    /// How many splats all avatars in the scene may show together. Their levels of detail are chosen within it, for the nearest
    /// avatar first; where not even the coarsest levels fit, these are shown. Without one, the distance alone decides.
    /// </summary>
    [ExecuteAlways, DisallowMultipleComponent, AddComponentMenu("MUA/Avatar Budget")]
    public sealed class AvatarBudget : MonoBehaviour
    {
        private const int Default = 300000;

        private static AvatarBudget current; // the one that was enabled last

        [SerializeField, Min(0), Tooltip("Most splats of all avatars together whose level of detail is automatic.")]
        private int splats = Default;

        /// <summary>Most splats of all avatars together.</summary>
        public int Splats
        {
            get => splats;
            set => splats = Mathf.Max(value, 0);
        }

        /// <summary>Splats, or -1 where there is no budget.</summary>
        internal static long Limit => current == null ? -1 : current.splats;

        private void OnEnable()
        {
            current = this;
        }

        private void OnDisable()
        {
            if (current == this)
            {
                current = null;
            }
        }
    }
}
