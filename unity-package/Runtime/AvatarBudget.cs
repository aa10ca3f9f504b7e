using System.Collections.Generic;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// How many splats all avatars in the scene may show together, and how long a frame may take, which the device measures.
    /// Their levels of detail are chosen within it, for the nearest avatar first; where not even the coarsest levels fit,
    /// these are shown. Without one, the distance alone decides.
    /// </summary>
    [ExecuteAlways, DisallowMultipleComponent, AddComponentMenu("MUA/Avatar Budget")]
    public sealed class AvatarBudget : MonoBehaviour
    {
        private const int Default = 300000;

        private static readonly List<AvatarBudget> Enabled = new List<AvatarBudget>(); // the last one counts

        [SerializeField, Min(0), Tooltip("Most splats of all avatars together whose level of detail is automatic.")]
        private int splats = Default;

        [SerializeField, Min(0)]
        [Tooltip("Milliseconds of a frame on the graphics device: where it takes longer, fewer splats are shown. 0: no such limit.")]
        private float milliseconds = 0;

        /// <summary>Most splats of all avatars together.</summary>
        public int Splats
        {
            get => splats;
            set => splats = Mathf.Max(value, 0);
        }

        /// <summary>
        /// Milliseconds of a frame on the graphics device, or from one frame to the next where it reports no time; 0 for no
        /// limit. Fewer splats are shown where frames take longer, down to the coarsest levels, and more again where there is room.
        /// </summary>
        public float Milliseconds
        {
            get => milliseconds;
            set => milliseconds = Mathf.Max(value, 0);
        }

        /// <summary>Milliseconds, or 0 where there is no limit.</summary>
        internal static float FrameLimit => Enabled.Count == 0 ? 0 : Current.milliseconds;

        /// <summary>Splats, or -1 where there is no budget.</summary>
        internal static long Limit => Enabled.Count == 0 ? -1 : Current.splats;

        private static AvatarBudget Current => Enabled[Enabled.Count - 1];

        private void OnEnable()
        {
            Enabled.Add(this);
        }

        private void OnDisable()
        {
            Enabled.Remove(this);
        }
    }
}
