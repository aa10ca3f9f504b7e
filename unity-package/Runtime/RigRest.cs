using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// The transforms of a rig and how they lie at rest in its root's space: as they are when it is made, or as a humanoid
    /// avatar has them in its T-pose.
    /// </summary>
    [Serializable]
    internal sealed class RigRest
    {
        [SerializeField] private Transform[] joints; // so that a clone of the rig has its own
        [SerializeField] private Vector3[] at, sizes; // in their parents
        [SerializeField] private Quaternion[] turns; // in their parents
        [SerializeField] private int[] parents;

        private RigRest()
        {
            // for Unity's serializer, which fills the fields
        }

        public RigRest(Transform root)
        {
            bool isInactive = !root.gameObject.activeInHierarchy; // then none of its transforms is active
            joints = root.GetComponentsInChildren<Transform>(isInactive)
                .Where(joint => joint == root || !joint.TryGetComponent(out SkinnedMeshRenderer _)).ToArray(); // parents first
            at = Joints.Select(joint => joint.localPosition).ToArray();
            turns = Joints.Select(joint => joint.localRotation).ToArray();
            sizes = Joints.Select(joint => joint.localScale).ToArray();
            parents = Joints.Select(joint => joint == root ? -1 : Array.IndexOf(Joints, joint.parent)).ToArray();
            at[0] = Vector3.zero;
            turns[0] = Quaternion.identity;
            sizes[0] = Vector3.one;
        }

        /// <summary>The root and what is below it, without meshes that bones move.</summary>
        public Transform[] Joints => joints;

        /// <summary>Whether it was taken, of transforms that are still there.</summary>
        public bool IsTaken => joints != null && joints.Length > 0 && Array.TrueForAll(joints, joint => joint != null);

        /// <summary>The skeleton at rest, right-handed, metres of the unscaled rig.</summary>
        public Skeleton Skeleton(Animator animator)
        {
            Stand(animator);
            var rotations = new double[4 * Joints.Length];
            var translations = new double[3 * Joints.Length];
            for (int joint = 0; joint < Joints.Length; joint++)
            {
                AvatarSpace.Rotation(turns[joint]).Store(rotations, joint);
                AvatarSpace.Position(Vector3.Scale(Size(parents[joint]), at[joint])).Store(translations, joint);
            }
            return new Skeleton(Joints.Select(joint => joint.name).ToArray(), parents, rotations, translations, 0);
        }

        /// <summary>[S] the role of each joint by a humanoid Animator, null for those that it does not know.</summary>
        public string[] Roles(Animator animator)
        {
            var roles = new string[Joints.Length];
            for (var bone = HumanBodyBones.Hips; IsHumanoid(animator) && bone < HumanBodyBones.LastBone; bone++)
            {
                int joint = Array.IndexOf(Joints, animator.GetBoneTransform(bone));
                if (joint >= 0)
                {
                    roles[joint] = Retargeter.HumanoidRole(bone.ToString());
                }
            }
            return roles;
        }

        private static bool IsHumanoid(Animator animator)
        {
            return animator != null && animator.isHuman && animator.avatar != null;
        }

        /// <summary>Takes the T-pose of a humanoid avatar, which names its transforms.</summary>
        private void Stand(Animator animator)
        {
            if (!IsHumanoid(animator))
            {
                return;
            }
            var known = new Dictionary<string, SkeletonBone>();
            foreach (SkeletonBone bone in animator.avatar.humanDescription.skeleton ?? new SkeletonBone[0])
            {
                known[bone.name] = bone;
            }
            for (int joint = 1; joint < Joints.Length; joint++)
            {
                if (known.TryGetValue(Joints[joint].name, out SkeletonBone bone))
                {
                    at[joint] = bone.position;
                    turns[joint] = bone.rotation;
                    sizes[joint] = bone.scale;
                }
            }
        }

        /// <summary>How large a joint is in the root's space.</summary>
        private Vector3 Size(int joint)
        {
            return joint < 0 ? Vector3.one : Vector3.Scale(Size(parents[joint]), sizes[joint]);
        }
    }
}
