// Stories of avatars that follow a rig, for ComponentProgram.cs.
using System;
using System.Collections.Generic;
using System.IO;
using System.Reflection;
using Mua.Format;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private static void FollowsRig()
        {
            var rig = new Rig();
            var joints = rig.Bind();
            var read = new double[4 * rig.Joints.Length];
            var translations = new double[3 * rig.Joints.Length];
            joints.Read(read, translations);
            var clip = rig.MakeClip();
            var wanted = new double[4 * rig.Joints.Length];
            var wantedTranslations = new double[3 * rig.Joints.Length];
            clip.ReadFrame(2, wanted, wantedTranslations);
            double turned = 0, moved = 0;
            for (int i = 0; i < rig.Joints.Length; i++)
            {
                QuaternionD a = QuaternionD.Load(read, i), b = QuaternionD.Load(wanted, i);
                turned = Math.Max(turned, 1 - Math.Abs(a.W * b.W + a.X * b.X + a.Y * b.Y + a.Z * b.Z));
            }
            for (int i = 0; i < translations.Length; i++)
            {
                moved = Math.Max(moved, Math.Abs(translations[i] - wantedTranslations[i]));
            }
            Say("turned", turned);
            Say("translated", moved);
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = rig.Root;
            Frames(10);
            long before = GC.GetAllocatedBytesForCurrentThread();
            Frames(72);
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            UnityEngine.Object.DestroyImmediate(rig.Hips.gameObject);
            Frames(20);
            Say("state", shown.State);
        }

        private static void RigIsPicked()
        {
            var rig = new Rig();
            AvatarRenderer shown = Show(files[0]);
            shown.IsPlaying = false;
            FieldInfo field = typeof(AvatarRenderer).GetField("rig", BindingFlags.Instance | BindingFlags.NonPublic);
            field.SetValue(shown, rig.Root);
            StandIns.Messages.Send(shown, "OnValidate");
            Frames(72);
            Say("idle", Dispatches(10));
            rig.Last.localRotation = Quaternion.Euler(0, 40, 0);
            Say("woken", Dispatches(10));
        }

        private static void RigRests()
        {
            var rig = new Rig();
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = rig.Root;
            Say("settling", Dispatches(72));
            Say("idle", Dispatches(10));
            rig.Last.localRotation = Quaternion.Euler(0, 40, 0);
            Say("woken", Dispatches(72));
            Say("idle", Dispatches(10));
            shown.transform.position = new Vector3(5, 0, 0);
            Say("carried", Dispatches(1));
            Say("idle", Dispatches(10));
            rig.Hips.localPosition += new Vector3(0, 0.1f, 0);
            Say("stepped", Dispatches(72));
            shown.IsPlaying = false;
            shown.Rig = null;
            Say("left", Dispatches(1));
        }

        /// <summary>An avatar without clips, before it follows a rig, meanwhile, and after it.</summary>
        private static void LeavesRigWithoutClips()
        {
            var rig = new Rig();
            AvatarRenderer shown = Show(files[1]);
            foreach (Transform root in new[] { null, rig.Root, null })
            {
                shown.Rig = root;
                Frames(20);
                Say("middle", shown.Bounds.center.x + " " + shown.Bounds.center.y + " " + shown.Bounds.center.z);
            }
        }

        /// <summary>A pose that is held for long and then left: the window still holds what was before.</summary>
        private static void RemembersRest()
        {
            var rig = new Rig();
            var joints = rig.Bind();
            var pose = new AvatarPose(rig.Avatar);
            double frame = 1 / rig.Avatar.Encoding.Rate;
            int changes = 0;
            for (int i = 0; i < 100; i++)
            {
                changes += pose.Sample(joints, i * frame) ? 1 : 0;
            }
            Say("changes", changes);
            long rested = pose.Due;
            double[] rest = pose.Current.ToArray();
            rig.Last.localRotation = Quaternion.Euler(0, 40, 0);
            Say("changes", pose.Sample(joints, 100 * frame) ? 1 : 0);
            Say("fresh", pose.Due != rested ? 1 : 0);
            double[] window = pose.Window.ToArray();
            int same = 0;
            for (int age = 0; age < rig.Avatar.Encoding.Window; age++)
            {
                var held = new ReadOnlySpan<double>(window, age * rest.Length, rest.Length);
                same += held.SequenceEqual(rest) ? 1 : 0;
            }
            Say("rests", rig.Avatar.Encoding.Window - same);
        }

        /// <summary>Which poses of a rig that moves all the time are in the window, newest first.</summary>
        private static void WindowTakesTurns()
        {
            var rig = new Rig();
            var joints = rig.Bind();
            var pose = new AvatarPose(rig.Avatar);
            double frame = 1 / rig.Avatar.Encoding.Rate, now = 100;
            var seen = new List<double[]>();
            for (int i = 0; i <= 12; i++)
            {
                Turn(rig, joints, pose, now + i * frame / 3, seen);
            }
            Say("window", Indices(pose, seen));
            now += 4 * frame;
            Turn(rig, joints, pose, now + 3.75 * frame, seen);
            Say("window", Indices(pose, seen));
            Turn(rig, joints, pose, now + 7.5 * frame, seen);
            Say("window", Indices(pose, seen));
            Turn(rig, joints, pose, now + 8.5 * frame, seen);
            Say("window", Indices(pose, seen));
            Turn(rig, joints, pose, now + 8 * frame, seen);
            Say("window", Indices(pose, seen));
            var clip = rig.MakeClip();
            Say("before", clip.FrameCount - clip.Position(-0.5 * frame));
            Say("before", clip.FrameCount - clip.Position(-(clip.FrameCount + 1) * frame));
            int taken = 0;
            for (int i = 0; i < 300; i++) // at times whose differences are a frame but for rounding
            {
                long due = pose.Due;
                Turn(rig, joints, pose, 1000.1 + i / (double)rig.Avatar.Encoding.Rate, seen);
                taken += pose.Due != due ? 1 : 0;
            }
            Say("steady", taken);
            pose.Sample(clip, 0, 0);
            long first = pose.Due;
            pose.Sample(rig.MakeClip(), 0, 0);
            Say("other clip", pose.Due != first ? 1 : 0);
        }

        private static void Turn(Rig rig, AvatarJoints joints, AvatarPose pose, double seconds, List<double[]> seen)
        {
            rig.Last.localRotation = Quaternion.Euler(0, 5 * seen.Count, 0);
            pose.Sample(joints, seconds);
            seen.Add(pose.Current.ToArray());
        }

        private static string Indices(AvatarPose pose, List<double[]> seen)
        {
            var found = new List<string>();
            for (int at = 0; at < pose.Window.Length; at += pose.Current.Length)
            {
                double[] held = pose.Window.Slice(at, pose.Current.Length).ToArray();
                found.Add(seen.FindIndex(each => new ReadOnlySpan<double>(each).SequenceEqual(held)).ToString());
            }
            return string.Join(" ", found.ToArray());
        }

        private static void LacksJoint()
        {
            var rig = new Rig();
            rig.Last.gameObject.name = "Another";
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = rig.Root;
            Frames(20);
            rig.Hips.gameObject.name = "NoRoot";
            shown.Rig = rig.Root;
            Frames(20);
            Say("state", shown.State);
        }

        /// <summary>Sizes along with parents, then scales that are not one size.</summary>
        private static void IsScaled()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.IsPlaying = false;
            GameObject parent = Make("parent");
            shown.transform.SetParent(parent.transform, false);
            shown.transform.localPosition = new Vector3(0.5f, 0, 0);
            foreach (Vector3 scale in new[] { new Vector3(1, 1, 1), new Vector3(2, 2, 2), new Vector3(0, 0, 0), new Vector3(1, 2, 1), new Vector3(-2, 2, 2) })
            {
                parent.transform.localScale = scale;
                Say("posed", Dispatches(1));
                SayBox(shown);
                Say("said", shown.Message);
            }
            Say("state", shown.State);
        }

        /// <summary>A rig that is three times as large as the character gives the same pose.</summary>
        private static void FollowsScaledRig()
        {
            var rig = new Rig();
            var joints = rig.Bind();
            var rotations = new double[4 * rig.Joints.Length];
            double[] before = new double[3 * rig.Joints.Length], after = new double[before.Length];
            joints.Read(rotations, before);
            rig.Root.localScale = new Vector3(3, 3, 3);
            joints.Read(rotations, after);
            double most = 0;
            for (int i = 0; i < before.Length; i++)
            {
                most = Math.Max(most, Math.Abs(after[i] - before[i]));
            }
            Say("off", most);
        }
    }
}
