using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// Transforms that carry an avatar's pose, whoever moves them: an Animator, physics, a script. They are found by the
    /// joints' names and must have the bind orientations of the avatar's skeleton, as the rig that it was made from.
    /// </summary>
    internal sealed class AvatarJoints : IPosingRig
    {
        private const int Named = 3; // missing joints in a message

        private readonly Skeleton skeleton;
        private readonly Transform root;
        private readonly Transform[] joints; // null where there is none
        private readonly double[] turned; // [J, 4] rotations in the root's space
        private readonly double[] placed; // [J, 3] positions there, metres of the unscaled rig
        private readonly bool[] moves; // [J] whether a joint's place is read, and not that of the bind pose

        /// <summary>InvalidOperationException where no transform below `root` has a joint's name.</summary>
        public AvatarJoints(Skeleton skeleton, Transform root)
        {
            this.skeleton = skeleton;
            this.root = root;
            joints = new Transform[skeleton.JointCount];
            turned = new double[4 * skeleton.JointCount];
            placed = new double[3 * skeleton.JointCount];
            moves = new bool[skeleton.JointCount];
            moves[skeleton.Root] = true;
            foreach (int joint in skeleton.Translated)
            {
                moves[joint] = true;
            }
            int found = Find();
            if (found == 0 || joints[skeleton.Root] == null)
            {
                throw new InvalidOperationException(
                    "no active GameObject below " + root.name + " is named " + skeleton.Names[skeleton.Root]
                    + ", the avatar's root joint; assign the root of the rig that the avatar was baked from, or add MUA > Retargeted Rig"
                    + " to that of another.");
            }
            Missing = found == joints.Length ? "" : DescribeMissing(joints.Length - found);
        }

        public string Missing { get; }

        public bool Alive => root != null && joints[skeleton.Root] != null;

        /// <summary>Local rotations [J, 4] and translations [J, 3], metres, of this moment.</summary>
        public void Read(Span<double> rotations, Span<double> translations)
        {
            root.GetPositionAndRotation(out Vector3 origin, out Quaternion turn);
            Quaternion back = Quaternion.Inverse(turn);
            float size = AvatarPlace.SizeOf(root.lossyScale);
            double shrink = size > 0 ? 1.0 / size : 1;
            for (int joint = 0; joint < joints.Length; joint++)
            {
                int parent = skeleton.Parents[joint];
                QuaternionD above = parent < 0 ? QuaternionD.Identity : QuaternionD.Load(turned, parent);
                QuaternionD local = QuaternionD.Load(skeleton.BindRotations, joint);
                if (joints[joint] != null)
                {
                    local = (above.Conjugate * AvatarSpace.Rotation(back * joints[joint].rotation)).Normalized();
                }
                local.Store(rotations, joint);
                QuaternionD world = above * local;
                world.Store(turned, joint);
                Vector3D start = parent < 0 ? new Vector3D() : Vector3D.Load(placed, parent);
                Vector3D offset = Vector3D.Load(skeleton.BindTranslations, joint);
                if (moves[joint] && joints[joint] != null)
                {
                    Vector3D at = shrink * AvatarSpace.Position(back * (joints[joint].position - origin));
                    offset = above.Conjugate.Rotate(at - start);
                }
                offset.Store(translations, joint);
                (start + above.Rotate(offset)).Store(placed, joint);
            }
        }

        public void ReadWindow(Span<double> rotations, Span<double> translations)
        {
        }

        public float Weight(int expression)
        {
            return 0;
        }

        private int Find()
        {
            var byName = new Dictionary<string, Transform>();
            foreach (Transform transform in root.GetComponentsInChildren<Transform>())
            {
                if (!byName.ContainsKey(transform.name))
                {
                    byName.Add(transform.name, transform);
                }
            }
            int found = 0;
            for (int joint = 0; joint < joints.Length; joint++)
            {
                found += byName.TryGetValue(skeleton.Names[joint], out joints[joint]) ? 1 : 0;
            }
            return found;
        }

        private string DescribeMissing(int count)
        {
            IEnumerable<string> names = skeleton.Names.Where((name, joint) => joints[joint] == null).Take(Named);
            return "the rig " + root.name + " lacks " + count + " of the avatar's " + joints.Length
                + " joints, which keep their bind pose: " + string.Join(", ", names) + (count > Named ? ", ..." : "");
        }
    }
}
