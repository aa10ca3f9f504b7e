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
    }

    /// <summary>From an avatar's space to the right-handed world: rigid, then made larger about the world's origin.</summary>
    internal readonly struct AvatarPlace
    {
        private const float SizeSlack = 1e-3f; // of the largest axis
        private const float LeastSize = 1e-4f; // a speck: the smallest to divide a position by

        /// <summary>To the world divided by Size; a dual quaternion has no scale.</summary>
        public DualQuaternion Rigid { get; }

        /// <summary>How many times as large as baked.</summary>
        public float Size { get; }

        /// <summary>A place from Unity's position and rotation, and a size.</summary>
        public AvatarPlace(Vector3 position, Quaternion rotation, float size = 1)
        {
            Size = Mathf.Max(size, LeastSize);
            Rigid = DualQuaternion.FromRigid(AvatarSpace.Rotation(rotation), 1.0 / Size * AvatarSpace.Position(position));
        }

        /// <summary>The point in the right-handed world, metres.</summary>
        public Vector3D Transform(in Vector3D point)
        {
            return (double)Size * Rigid.Transform(point);
        }

        /// <summary>Whether a scale is one size along all axes, and not mirrored.</summary>
        public static bool IsUniform(Vector3 scale)
        {
            float slack = SizeSlack * Mathf.Abs(scale.x);
            return scale.x >= 0 && Mathf.Abs(scale.y - scale.x) <= slack && Mathf.Abs(scale.z - scale.x) <= slack;
        }

        /// <summary>The size of a scale: 1 where it is not uniform.</summary>
        public static float SizeOf(Vector3 scale)
        {
            return IsUniform(scale) ? scale.x : 1;
        }
    }

    /// <summary>Where a GameObject stands, in the kernels' world; it is converted only where it has changed.</summary>
    internal sealed class AvatarPlacement
    {
        private Vector3 position;
        private Quaternion rotation;
        private Vector3 scale;
        private bool isKnown;

        public AvatarPlace Value { get; private set; }

        /// <summary>Reads where `transform` is now; returns whether it has moved.</summary>
        public bool Follow(Transform transform)
        {
            transform.GetPositionAndRotation(out Vector3 at, out Quaternion turned);
            Vector3 large = transform.lossyScale;
            if (isKnown && at.Equals(position) && turned.Equals(rotation) && large.Equals(scale))
            {
                return false;
            }
            position = at;
            rotation = turned;
            scale = large;
            Value = new AvatarPlace(at, turned, AvatarPlace.SizeOf(large));
            isKnown = true;
            return true;
        }
    }
}
