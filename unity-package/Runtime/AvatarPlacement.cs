using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>Where a GameObject stands, in the kernels' world; it is converted only where it has changed.</summary>
    internal sealed class AvatarPlacement
    {
        private Vector3 position;
        private Quaternion rotation;
        private bool isKnown;

        /// <summary>From the avatar's space to the right-handed world.</summary>
        public DualQuaternion Value { get; private set; }

        /// <summary>Takes where `transform` is now; whether that is another place than before.</summary>
        public bool Follow(Transform transform)
        {
            transform.GetPositionAndRotation(out Vector3 at, out Quaternion turned);
            if (isKnown && at.Equals(position) && turned.Equals(rotation))
            {
                return false;
            }
            position = at;
            rotation = turned;
            Value = AvatarSpace.Place(at, turned);
            isKnown = true;
            return true;
        }
    }
}
