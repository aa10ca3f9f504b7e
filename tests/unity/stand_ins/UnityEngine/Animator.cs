// Stand-in. Source: Unity 6000.0 scripting reference, Animator, Avatar, HumanBodyBones, HumanDescription, SkeletonBone.
using System.Collections.Generic;

namespace UnityEngine
{
    public enum HumanBodyBones
    {
        Hips, LeftUpperLeg, RightUpperLeg, LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot, Spine, Chest, Neck, Head,
        LeftShoulder, RightShoulder, LeftUpperArm, RightUpperArm, LeftLowerArm, RightLowerArm, LeftHand, RightHand, LeftToes,
        RightToes, LeftEye, RightEye, Jaw, LeftThumbProximal, LeftThumbIntermediate, LeftThumbDistal, LeftIndexProximal,
        LeftIndexIntermediate, LeftIndexDistal, LeftMiddleProximal, LeftMiddleIntermediate, LeftMiddleDistal,
        LeftRingProximal, LeftRingIntermediate, LeftRingDistal, LeftLittleProximal, LeftLittleIntermediate, LeftLittleDistal,
        RightThumbProximal, RightThumbIntermediate, RightThumbDistal, RightIndexProximal, RightIndexIntermediate,
        RightIndexDistal, RightMiddleProximal, RightMiddleIntermediate, RightMiddleDistal, RightRingProximal,
        RightRingIntermediate, RightRingDistal, RightLittleProximal, RightLittleIntermediate, RightLittleDistal, UpperChest,
        LastBone,
    }

    public struct SkeletonBone
    {
        public string name;
        public Vector3 position;
        public Quaternion rotation;
        public Vector3 scale;
    }

    public struct HumanDescription { public SkeletonBone[] skeleton; }

    public class Avatar : Object { internal Avatar() { } public HumanDescription humanDescription { get; internal set; } }

    public sealed class Animator : Behaviour
    {
        internal readonly Dictionary<HumanBodyBones, Transform> Bones = new Dictionary<HumanBodyBones, Transform>();

        public bool isHuman { get { return avatar != null && Bones.Count > 0; } }
        public Avatar avatar { get; set; }
        public Transform GetBoneTransform(HumanBodyBones humanBoneId)
        {
            Transform bone;
            return Bones.TryGetValue(humanBoneId, out bone) ? bone : null;
        }
    }
}

namespace StandIns
{
    using UnityEngine;

    /// <summary>Makes an Animator humanoid, as the importer of a model does.</summary>
    public static class Humanoid
    {
        public static void Make(Animator animator, IDictionary<HumanBodyBones, Transform> bones, SkeletonBone[] skeleton)
        {
            foreach (KeyValuePair<HumanBodyBones, Transform> bone in bones)
                animator.Bones[bone.Key] = bone.Value;
            animator.avatar = new Avatar { humanDescription = new HumanDescription { skeleton = skeleton } };
        }
    }
}
