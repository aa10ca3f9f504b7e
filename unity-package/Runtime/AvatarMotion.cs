using System;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>What moves an avatar: the transforms of a rig, else one of its clips, else nothing.</summary>
    internal sealed class AvatarMotion
    {
        private readonly AvatarFile avatar;
        private IPosingRig joints; // null where a clip gives the pose
        private AvatarFace face; // null where no mesh sets expressions

        public AvatarMotion(AvatarFile avatar)
        {
            this.avatar = avatar;
            Pose = new AvatarPose(avatar);
            Playback = new AvatarPlayback(avatar);
        }

        public AvatarPlayback Playback { get; }

        public AvatarPose Pose { get; }

        /// <summary>
        /// Takes the transforms below a root in place of those it had, or none for null; what is wrong with them, or nothing.
        /// </summary>
        public string Bind(Transform root)
        {
            joints = null;
            if (root == null)
            {
                return "";
            }
            try
            {
                joints = root.TryGetComponent(out RetargetedRig other)
                    ? (IPosingRig)new RetargetedJoints(avatar.Skeleton, other)
                    : new AvatarJoints(avatar.Skeleton, root);
                return joints.Missing;
            }
            catch (InvalidOperationException error)
            {
                return error.Message;
            }
        }

        /// <summary>Lets go of transforms that were destroyed; whether they were since the last call.</summary>
        public bool LosesRig()
        {
            if (joints == null || joints.Alive)
            {
                return false;
            }
            joints = null;
            return true;
        }

        /// <summary>
        /// Takes the blend shapes of a mesh in place of those of another, or none for null; what is wrong with them, or nothing.
        /// </summary>
        public string Bind(SkinnedMeshRenderer mesh)
        {
            face?.Release();
            face = mesh == null ? null : new AvatarFace(Pose.Expressions, mesh);
            return face == null ? "" : face.Missing;
        }

        /// <summary>Lets go of a mesh that was destroyed; whether it was since the last call.</summary>
        public bool LosesFace()
        {
            if (face == null || face.Alive)
            {
                return false;
            }
            face.Release();
            face = null;
            return true;
        }

        /// <summary>Takes the weights of expressions of a moment; `always`: however soon after others.</summary>
        public void Express(double seconds, bool always)
        {
            face?.Read();
            Pose.Express(seconds, always);
        }

        /// <summary>
        /// The pose of a moment, in seconds of the rig's clock, or `step` seconds of the clip after the last; whether it is
        /// another than before.
        /// </summary>
        public bool Sample(double seconds, double step)
        {
            if (joints != null)
            {
                Playback.Forget();
                return Pose.Sample(joints, seconds);
            }
            if (!Playback.IsEmpty)
            {
                return Playback.Sample(Pose, step);
            }
            Pose.Hold();
            return false;
        }
    }
}
