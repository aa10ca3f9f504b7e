using System;
using Mua.Format;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    /// <summary>Transforms of another skeleton than the avatar's that pose it, whoever moves them.</summary>
    internal sealed class RetargetedJoints : IPosingRig
    {
        private readonly RetargetedRig rig;
        private readonly Transform root;
        private readonly Transform[] joints;
        private readonly Retargeter retargeter;
        private readonly double[] turned; // [S, 4] of those that are read, in the root's space
        private readonly double[] placed; // [S, 3] metres of the unscaled rig

        /// <summary>InvalidOperationException, with a sentence, where the rig does not show a body like the avatar's.</summary>
        public RetargetedJoints(Skeleton skeleton, RetargetedRig rig)
        {
            this.rig = rig;
            root = rig.transform;
            var animator = rig.GetComponentInChildren<Animator>();
            RigRest rest = rig.Rest;
            joints = rest.Joints;
            Skeleton source = rest.Skeleton(animator);
            try
            {
                retargeter = new Retargeter(source, skeleton, rest.Roles(animator), rig.Mapping);
            }
            catch (InvalidOperationException error)
            {
                throw new InvalidOperationException("the rig " + root.name + " cannot be followed: " + error.Message);
            }
            turned = new double[4 * joints.Length];
            placed = new double[3 * joints.Length];
            source.World(source.BindRotations, source.BindTranslations, turned, placed);
        }

        public string Missing => "";

        public bool Alive => root != null && joints[retargeter.Used[0]] != null;

        public void Read(Span<double> rotations, Span<double> translations)
        {
            root.GetPositionAndRotation(out Vector3 origin, out Quaternion turn);
            Quaternion back = Quaternion.Inverse(turn);
            float size = AvatarPlace.SizeOf(root.lossyScale);
            double shrink = size > 0 ? 1.0 / size : 1;
            foreach (int joint in retargeter.Used)
            {
                if (joints[joint] != null) // one that was destroyed stays as it was
                {
                    joints[joint].GetPositionAndRotation(out Vector3 at, out Quaternion turning);
                    AvatarSpace.Rotation(back * turning).Store(turned, joint);
                    Vector3D place = shrink * AvatarSpace.Position(back * (at - origin));
                    place.Store(placed, joint);
                }
            }
            retargeter.InPlace = rig != null && rig.InPlace;
            retargeter.Pose(turned, placed, Time.timeAsDouble, rotations, translations);
        }

        public void ReadWindow(Span<double> rotations, Span<double> translations)
        {
        }

        public float Weight(int expression)
        {
            return 0;
        }
    }
}
