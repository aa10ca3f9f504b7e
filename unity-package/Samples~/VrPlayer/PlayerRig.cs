using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    /// <summary>
    /// The ground that the user stands on, with the head somewhere above it. Zooming shrinks the user, not the avatar, which
    /// keeps its size in metres.
    /// </summary>
    internal sealed class PlayerRig
    {
        private const float WalkSpeed = 1.5f; // metres a second
        private const float ZoomSpeed = 2; // times as large each second
        private const float LeastZoom = 0.5f;
        private const float MostZoom = 8;
        private const float NearPlane = 0.05f; // metres, not zoomed
        private const float SteepestLook = 85; // degrees

        private readonly Transform ground;
        private readonly Camera head;
        private readonly Vector3 startPosition, startHead;
        private readonly Quaternion startRotation;
        private float pitch; // degrees upwards, without a headset

        public PlayerRig(Transform ground, Camera head)
        {
            this.ground = ground;
            this.head = head;
            startPosition = ground.position;
            startRotation = ground.rotation;
            startHead = head.transform.localPosition;
        }

        /// <summary>How many times as large the world appears.</summary>
        public float Zoom { get; private set; } = 1;

        /// <summary>Moves over the ground to where the head looks; amounts are of full speed.</summary>
        public void Walk(Vector2 amount, float rise, float seconds)
        {
            Vector3 right = Vector3.ProjectOnPlane(head.transform.right, Vector3.up).normalized;
            Vector3 forward = Vector3.Cross(right, Vector3.up);
            Vector3 way = amount.x * right + amount.y * forward + rise * Vector3.up;
            ground.position += WalkSpeed * seconds / Zoom * way;
        }

        /// <summary>Turns ground and head by degrees to the right and up, for a head without a headset.</summary>
        public void Look(Vector2 degrees)
        {
            ground.RotateAround(head.transform.position, Vector3.up, degrees.x);
            pitch = Mathf.Clamp(pitch + degrees.y, -SteepestLook, SteepestLook);
            head.transform.localRotation = Quaternion.Euler(-pitch, 0, 0);
        }

        /// <summary>Shrinks the user towards a point at eye level over a place, so that what is there grows in sight.</summary>
        public void Approach(Vector3 place, float amount, float seconds)
        {
            float zoom = Mathf.Clamp(Zoom * Mathf.Pow(ZoomSpeed, amount * seconds), LeastZoom, MostZoom);
            Vector3 centre = new Vector3(place.x, head.transform.position.y, place.z);
            ground.position = centre + Zoom / zoom * (ground.position - centre);
            SetZoom(zoom);
        }

        /// <summary>
        /// Back to where it was made. A user with a headset stands there and looks ahead, wherever in the room that is.
        /// </summary>
        public void Reset(bool isTracked)
        {
            SetZoom(1);
            ground.SetPositionAndRotation(startPosition, startRotation);
            if (!isTracked)
            {
                pitch = 0;
                head.transform.SetLocalPositionAndRotation(startHead, Quaternion.identity);
                return;
            }
            float yaw = Yaw(startRotation * Vector3.forward) - Yaw(head.transform.forward);
            ground.RotateAround(head.transform.position, Vector3.up, yaw);
            Vector3 away = head.transform.position - startPosition;
            ground.position -= new Vector3(away.x, 0, away.z);
        }

        /// <summary>Degrees clockwise from +Z, seen from above.</summary>
        private static float Yaw(Vector3 direction)
        {
            return Mathf.Atan2(direction.x, direction.z) * Mathf.Rad2Deg;
        }

        private void SetZoom(float zoom)
        {
            Zoom = zoom;
            ground.localScale = Vector3.one / zoom;
            head.nearClipPlane = NearPlane / zoom;
        }
    }
}
