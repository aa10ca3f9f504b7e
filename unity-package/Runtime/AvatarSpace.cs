using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// The one place where handedness is converted. Files and kernels are right-handed, Unity is left-handed; both are
    /// metres with Y up. Unity = diag(-1, 1, 1) x avatar: vectors change the sign of x, quaternions that of y and z.
    /// </summary>
    internal static class AvatarSpace
    {
        private const float ScaleSlack = 1e-3f;

        public static Vector3D Position(Vector3 unity)
        {
            return new Vector3D(-unity.x, unity.y, unity.z);
        }

        public static Vector3 Position(in Vector3D avatar)
        {
            return new Vector3((float)-avatar.X, (float)avatar.Y, (float)avatar.Z);
        }

        public static QuaternionD Rotation(Quaternion unity)
        {
            return new QuaternionD(unity.w, unity.x, -unity.y, -unity.z).Normalized();
        }

        public static Quaternion Rotation(in QuaternionD avatar)
        {
            return new Quaternion((float)avatar.X, (float)-avatar.Y, (float)-avatar.Z, (float)avatar.W);
        }

        /// <summary>From an avatar's space to the right-handed world that its GameObject stands in.</summary>
        public static DualQuaternion Place(Vector3 position, Quaternion rotation)
        {
            return DualQuaternion.FromRigid(Rotation(rotation), Position(position));
        }

        /// <summary>Right-handed world to eye, of Unity's left-handed world to the same eye.</summary>
        public static Matrix4x4 View(Matrix4x4 unityView)
        {
            Matrix4x4 view = unityView;
            view.m00 = -view.m00;
            view.m10 = -view.m10;
            view.m20 = -view.m20;
            view.m30 = -view.m30;
            return view;
        }

        /// <summary>Unity's box of a right-handed one, metres.</summary>
        public static Bounds Box(Vector3 low, Vector3 high)
        {
            var box = new Bounds();
            box.SetMinMax(new Vector3(-high.x, low.y, low.z), new Vector3(-low.x, high.y, high.z));
            return box;
        }

        /// <summary>Whether a transform is rigid; a dual quaternion holds no scale.</summary>
        public static bool IsRigid(Vector3 scale)
        {
            return Mathf.Abs(scale.x - 1) < ScaleSlack && Mathf.Abs(scale.y - 1) < ScaleSlack
                && Mathf.Abs(scale.z - 1) < ScaleSlack;
        }
    }

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
