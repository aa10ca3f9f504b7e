// Stories of ComponentProgram.cs: a rig of another skeleton poses an avatar. The rig is the skeleton of the second avatar and
// moves as its first clip does.
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using Mua.Format;
using Mua.Motion;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private static readonly Dictionary<string, string> Bones = new Dictionary<string, string>
        {
            { "Hips", "Hips" }, { "Spine", "Spine" }, { "Spine1", "Chest" }, { "Spine2", "UpperChest" }, { "Neck", "Neck" },
            { "Head", "Head" }, { "Shoulder", "Shoulder" }, { "Arm", "UpperArm" }, { "ForeArm", "LowerArm" },
            { "Hand", "Hand" }, { "HandMiddle1", "MiddleProximal" }, { "UpLeg", "UpperLeg" }, { "Leg", "LowerLeg" },
            { "Foot", "Foot" }, { "ToeBase", "Toes" },
        };

        private sealed class OtherRig
        {
            public readonly Transform Root = Make("figure").transform;
            public readonly Transform[] Joints;
            public readonly AvatarFile Avatar = AvatarFile.Read(File.ReadAllBytes(files[1]));

            public OtherRig()
            {
                Skeleton skeleton = Avatar.Skeleton;
                Joints = new Transform[skeleton.JointCount];
                for (int i = 0; i < Joints.Length; i++)
                {
                    Joints[i] = new GameObject(skeleton.Names[i]).transform;
                    Joints[i].SetParent(skeleton.Parents[i] < 0 ? Root : Joints[skeleton.Parents[i]], false);
                }
                Stand(skeleton.BindRotations, skeleton.BindTranslations);
                new GameObject("Head").AddComponent<SkinnedMeshRenderer>().transform.SetParent(Root, false); // not a joint
                Root.GetChild(Root.childCount - 1).localPosition = new Vector3(5, 5, 5);
            }

            public void Move(int frame)
            {
                var rotations = new double[4 * Joints.Length];
                var translations = new double[3 * Joints.Length];
                new ClipSampler(Avatar.Clips[0], Avatar.Skeleton, Avatar.Clips[0].Rate).ReadFrame(frame, rotations, translations);
                Stand(rotations, translations);
            }

            /// <summary>An Animator that knows its joints, whose names then tell nothing, and how they lie at rest.</summary>
            public void BecomeHumanoid()
            {
                Animator animator = Root.gameObject.AddComponent<Animator>();
                var known = new Dictionary<HumanBodyBones, Transform>();
                var rest = new List<SkeletonBone>();
                for (int i = 0; i < Joints.Length; i++)
                {
                    string name = Joints[i].name, side = name.StartsWith("Left") ? "Left" : name.StartsWith("Right") ? "Right" : "";
                    if (Bones.TryGetValue(name.Substring(side.Length), out string bone))
                    {
                        known[(HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), side + bone)] = Joints[i];
                    }
                    Joints[i].gameObject.name = "bone " + i;
                    rest.Add(new SkeletonBone
                    {
                        name = Joints[i].name, position = Joints[i].localPosition, rotation = Joints[i].localRotation,
                        scale = Vector3.one,
                    });
                }
                Humanoid.Make(animator, known, rest.ToArray());
            }

            private void Stand(double[] rotations, double[] translations)
            {
                for (int i = 0; i < Joints.Length; i++)
                {
                    Joints[i].localPosition = AvatarSpace.Position(Vector3D.Load(translations, i));
                    Joints[i].localRotation = AvatarSpace.Rotation(QuaternionD.Load(rotations, i));
                }
            }
        }

        private static void RetargetsNamed()
        {
            var rig = new OtherRig();
            RetargetedRig retargeted = rig.Root.gameObject.AddComponent<RetargetedRig>();
            SayPoses(rig, retargeted);
        }

        /// <summary>The component awakes while the rig moves: its Animator tells how it lies at rest.</summary>
        private static void RetargetsHumanoid()
        {
            var rig = new OtherRig();
            rig.BecomeHumanoid();
            rig.Move(3);
            SayPoses(rig, rig.Root.gameObject.AddComponent<RetargetedRig>());
        }

        /// <summary>A clone of a rig that moves: Unity gives it the serialized fields, with transforms of its own.</summary>
        private static void RetargetsClone()
        {
            RetargetedRig first = new OtherRig().Root.gameObject.AddComponent<RetargetedRig>();
            var clone = new OtherRig();
            clone.Move(3);
            clone.Root.gameObject.SetActive(false);
            RetargetedRig second = clone.Root.gameObject.AddComponent<RetargetedRig>();
            FieldInfo rest = typeof(RetargetedRig).GetField("rest", Hidden);
            var copy = new RigRest(clone.Root);
            foreach (FieldInfo field in typeof(RigRest).GetFields(Hidden).Where(field => field.FieldType != typeof(Transform[])))
            {
                if (Attribute.IsDefined(field, typeof(SerializeField)))
                {
                    field.SetValue(copy, field.GetValue(rest.GetValue(first)));
                }
            }
            rest.SetValue(second, Attribute.IsDefined(rest, typeof(SerializeField)) ? copy : null);
            clone.Root.gameObject.SetActive(true);
            SayPoses(clone, second);
        }

        private static void RetargetsMapped()
        {
            var rig = new OtherRig();
            foreach (Transform joint in rig.Joints.Where(joint => joint.name == "LeftHandMiddle1"))
            {
                joint.gameObject.name = "hook";
            }
            RetargetedRig retargeted = rig.Root.gameObject.AddComponent<RetargetedRig>();
            retargeted.Map("LeftHandMiddle1", "nothing");
            retargeted.Map("LeftHandMiddle1", "hook");
            SayPoses(rig, retargeted);
        }

        private static void SayPoses(OtherRig rig, RetargetedRig retargeted)
        {
            rig.Root.SetPositionAndRotation(new Vector3(3, -1, 2), Quaternion.Euler(10, 200, -30));
            rig.Root.localScale = new Vector3(3, 3, 3);
            Skeleton skeleton = AvatarFile.Read(File.ReadAllBytes(files[0])).Skeleton;
            var joints = new RetargetedJoints(skeleton, retargeted);
            var rotations = new double[4 * skeleton.JointCount];
            var translations = new double[3 * skeleton.JointCount];
            for (int frame = 0; frame < rig.Avatar.Clips[0].FrameCount; frame++)
            {
                rig.Move(frame);
                joints.Read(rotations, translations);
                Say("rotations", string.Join(" ", rotations));
                Say("translations", string.Join(" ", translations));
            }
        }

        /// <summary>An avatar in the player loop: allocation, in place, and a rig that goes.</summary>
        private static void FollowsOtherRig()
        {
            var rig = new OtherRig();
            RetargetedRig retargeted = rig.Root.gameObject.AddComponent<RetargetedRig>();
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = rig.Root;
            Frames(20);
            Vector3 start = shown.Bounds.center;
            rig.Joints[0].localPosition += new Vector3(0, 0, 2);
            Frames(20);
            Say("goes", (shown.Bounds.center - start).z);
            retargeted.InPlace = true;
            Frames(20);
            Say("stays", (shown.Bounds.center - start).z);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int frame = 0; frame < 72; frame++)
            {
                rig.Joints[1].localRotation = Quaternion.Euler(0, frame, 0);
                Frames(1);
            }
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            UnityEngine.Object.DestroyImmediate(rig.Root.gameObject);
            Frames(20);
            Say("state", shown.State);
        }

        /// <summary>A rig that lies at rest as nobody stands, then one that is told to take its present pose for rest.</summary>
        private static void RefusesRest()
        {
            var rig = new OtherRig();
            Transform arm = rig.Joints.First(joint => joint.name == "LeftArm");
            Quaternion stands = arm.localRotation;
            arm.localRotation = Quaternion.Euler(0, 0, -80) * stands;
            RetargetedRig retargeted = rig.Root.gameObject.AddComponent<RetargetedRig>();
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = rig.Root;
            Say("message", shown.Message);
            arm.localRotation = stands;
            retargeted.TakeRest();
            shown.Rig = rig.Root;
            Frames(20);
            Say("state", shown.State);
        }

        /// <summary>A rig, given before the avatar is there, whose script pairs nothing with a joint.</summary>
        private static void RefusesNothing()
        {
            RetargetedRig retargeted = new OtherRig().Root.gameObject.AddComponent<RetargetedRig>();
            retargeted.Map(null, "hook");
            AvatarRenderer shown = Begin(files[0]);
            shown.Rig = retargeted.transform;
            Until(shown);
            Say("state", shown.State);
            Say("message", shown.Message);
            Say("held", Recorder.AliveCount);
        }
    }
}
