// Stories of ComponentProgram.cs: what an AvatarRenderer does where its surroundings change: parents, assets, eyes, games that
// start without a reload.
using System;
using System.Collections.Generic;
using System.IO;
using System.Reflection;
using System.Threading;
using Mua.Format;
using Mua.Motion;
using StandIns;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private const BindingFlags Hidden = BindingFlags.Instance | BindingFlags.NonPublic;

        /// <summary>A game that starts again in the domain of the one before, with an avatar that fails in both.</summary>
        private static void StartsWithoutReload()
        {
            Show(files[0]);
            Show("nowhere.muaavatar");
            Show("nowhere.muaavatar");
            Frames(2);
            PlayerLoop.StartGame();
            int draws = Recorder.Draws;
            Frames(10);
            Say("draws", Recorder.Draws - draws);
            Show("nowhere.muaavatar");
        }

        /// <summary>Eyes of which one looks at the avatar and the other one away from it.</summary>
        private static void IsSeenByOneEye()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.IsPlaying = false;
            Frames(2);
            var eyes = new AvatarEyes();
            Matrix4x4 projection = Matrix4x4.Perspective(60, 1, 0.05f, 100);
            Matrix4x4 towards = Matrix4x4.Scale(new Vector3(1, 1, -1))
                * Matrix4x4.Translate(new Vector3(0, 0, shown.Bounds.size.magnitude) - shown.Bounds.center);
            Matrix4x4 away = Matrix4x4.Scale(new Vector3(-1, 1, -1)) * towards;
            foreach (bool[] sees in new[] { new[] { true, false }, new[] { false, true }, new[] { false, false } })
            {
                eyes.Begin(64, 64, 0.05f);
                eyes.Add(sees[0] ? towards : away, projection);
                eyes.Add(sees[1] ? towards : away, projection);
                int before = Recorder.Dispatches;
                var commands = new CommandBuffer();
                bool isDrawn = AvatarWorld.Current.Record(commands, Scene[0].GetComponent<Camera>(), eyes);
                Graphics.ExecuteCommandBuffer(commands);
                commands.Dispose();
                Say("seen", isDrawn + " " + (Recorder.Dispatches - before) + " " + (AvatarWorld.Current.SplatCount > 0));
            }
        }

        /// <summary>Where the avatar stands below another object, which is moved, turned and scaled.</summary>
        private static void HasParent()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.IsPlaying = false;
            Frames(2);
            SayBox(shown);
            GameObject parent = Make("parent");
            shown.transform.SetParent(parent.transform, false);
            parent.transform.position = new Vector3(5, 1, 0);
            Frames(1);
            SayBox(shown);
            shown.transform.localRotation = Quaternion.Euler(0, 90, 0); // without another position
            Say("turned", Dispatches(1));
            SayBox(shown);
            parent.transform.localScale = new Vector3(1, 2, 1);
            Frames(2);
            Say("message", shown.Message);
        }

        private static void SayBox(AvatarRenderer shown)
        {
            Bounds box = shown.Bounds;
            Say("box", string.Join(" ", Array.ConvertAll(
                new[] { box.center.x, box.center.y, box.center.z, box.size.x, box.size.y, box.size.z }, one => one.ToString())));
        }

        /// <summary>Bytes that are sound, switched off and on, damaged, none; then a field of the inspector.</summary>
        private static void LoadsBytes()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.Load(File.ReadAllBytes(files[1]), "downloaded");
            Settle(shown);
            shown.enabled = false;
            Frames(1);
            Say("state", shown.State);
            shown.enabled = true;
            Settle(shown);
            shown.Load(File.ReadAllBytes(files[2]), "downloaded");
            Settle(shown);
            Say("message", shown.Message);
            shown.Load(files[2]);
            Settle(shown);
            Say("message", shown.Message);
            shown.Load((byte[])null);
            Frames(1);
            Say("state", shown.State);
            shown.Load(File.ReadAllBytes(files[2]), "downloaded");
            Settle(shown);
            typeof(AvatarRenderer).GetField("avatar", Hidden).SetValue(shown, null);
            typeof(AvatarRenderer).GetField("file", Hidden).SetValue(shown, files[0]);
            StandIns.Messages.Send(shown, "OnValidate");
            Frames(1);
            Settle(shown);
        }

        private static void Settle(AvatarRenderer shown)
        {
            for (int i = 0; i < Patience && shown.State == AvatarState.Loading; i++)
            {
                Thread.Sleep(1);
                Frames(1);
            }
            Say("state", shown.State + " " + shown.AvatarName);
        }

        /// <summary>A file, an asset, a file, an asset that cannot be shown, nothing; then a field of the inspector.</summary>
        private static void ShowsOneAfterAnother()
        {
            AvatarRenderer shown = Show(files[0]);
            AvatarAsset second = AvatarAsset.Create(File.ReadAllBytes(files[1]));
            SayShown(shown, second);
            shown.Load(second);
            SayShown(shown, second);
            shown.Load(files[0]);
            SayShown(shown, second);
            shown.Load(AvatarAsset.CreateFaulty("it is no avatar."));
            SayShown(shown, second);
            Say("message", shown.Message);
            shown.Load(files[0]);
            SayShown(shown, second);
            shown.Load((AvatarAsset)null);
            SayShown(shown, second);
            typeof(AvatarRenderer).GetField("avatar", Hidden).SetValue(shown, second);
            StandIns.Messages.Send(shown, "OnValidate");
            Frames(1);
            SayShown(shown, second);
        }

        private static void SayShown(AvatarRenderer shown, AvatarAsset asset)
        {
            Until(shown);
            Frames(1);
            Say("shown", shown.State + " " + shown.SplatCount + " " + (shown.Avatar == asset));
        }

        /// <summary>Views of two avatars beside their splats, as they reach the device in one frame.</summary>
        private static void ShowsViewsOfTwo()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[0]);
            first.Views = second.Views = AvatarViews.Geometry | AvatarViews.Template | AvatarViews.Skeleton;
            for (int i = 0; i < Patience && (i < 2 || AvatarWorld.Current.Draws.Count < 6); i++)
            {
                Frames(1);
                Thread.Sleep(1);
            }
            Recorder.Start(Path.ChangeExtension(files[0], null) + " of two");
            Frames(1);
            Recorder.Stop();
        }

        /// <summary>A file that is asked for while the component is off, which then goes on.</summary>
        private static void LoadsWhileDisabled()
        {
            AvatarRenderer shown = Make("avatar").AddComponent<AvatarRenderer>();
            shown.enabled = false;
            shown.Load(files[0]);
            Frames(5);
            Say("state", shown.State);
            shown.enabled = true;
            Until(shown);
            Say("state", shown.State);
            shown.gameObject.SetActive(false);
            shown.Load(files[0]);
            Frames(5);
            Say("state", shown.State);
        }

        /// <summary>Settings of a component, and those of one that Unity makes of its serialized fields.</summary>
        private static void IsCopied()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.Speed = 0.5f;
            shown.Views = AvatarViews.Template;
            shown.Level = AvatarLevel.Half;
            shown.SpreadDecode = false;
            shown.Rig = Make("rig").transform;
            AvatarRenderer copy = Clone(shown);
            Until(copy);
            Say("copy", copy.State + " " + copy.Speed + " " + copy.Views + " " + copy.Level + " " + copy.SpreadDecode + " " + (copy.Rig == shown.Rig));
        }

        /// <summary>What Unity makes of a component's serialized fields.</summary>
        private static AvatarRenderer Clone(AvatarRenderer shown)
        {
            GameObject clone = Make("clone");
            clone.SetActive(false);
            AvatarRenderer copy = clone.AddComponent<AvatarRenderer>();
            foreach (FieldInfo field in typeof(AvatarRenderer).GetFields(Hidden | BindingFlags.Public))
            {
                if (field.IsPublic || Attribute.IsDefined(field, typeof(SerializeField)))
                {
                    field.SetValue(copy, field.GetValue(shown));
                }
            }
            clone.SetActive(true);
            return copy;
        }

        /// <summary>Clones of an avatar of bytes, of which one waits while all others go or show something else.</summary>
        private static void IsClonedFromBytes()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.Load(File.ReadAllBytes(files[1]), "downloaded");
            AvatarAsset made = shown.Avatar;
            AvatarRenderer first = Clone(shown), second = Clone(shown);
            Settle(first);
            second.gameObject.SetActive(false);
            UnityEngine.Object.DestroyImmediate(shown.gameObject);
            first.Load(files[0]);
            Settle(first);
            second.gameObject.SetActive(true);
            Settle(second);
            UnityEngine.Object.DestroyImmediate(second.gameObject);
            Say("kept", made != null);
        }

        /// <summary>Two avatars, the clip of one of which ends early.</summary>
        private static void EndsEarly()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            first.Seconds = second.Seconds = 0;
            Say("counts", first.FrameCount + " " + second.FrameCount);
            for (int i = 0; i < 3; i++)
            {
                Frames(12);
                Say("frames", first.Frame + " " + second.Frame);
            }
        }

        /// <summary>Poses of a clip after its last frame's beginning, and those of frames.</summary>
        private static void StaysAtItsEnd()
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            var clip = new ClipSampler(avatar.Clips[0], avatar.Skeleton, avatar.Encoding.Rate);
            var pose = new AvatarPose(avatar);
            var exact = new double[pose.Current.Length];
            var translations = new double[pose.CurrentTranslations.Length];
            int last = clip.FrameCount - 1;
            foreach (double at in new[] { last, last + 0.25, last + 0.75, last + 1.0, 0.5 })
            {
                pose.Sample(clip, at / avatar.Encoding.Rate, 1.0 / 72);
                var found = new List<int>();
                foreach (int frame in new[] { 0, last })
                {
                    clip.ReadFrame(frame, exact, translations);
                    if (pose.Current.SequenceEqual(exact) && pose.CurrentTranslations.SequenceEqual(translations))
                    {
                        found.Add(frame == 0 ? 0 : 1);
                    }
                }
                Say("at", string.Join(" ", found.ConvertAll(one => one == 0 ? "first" : "last").ToArray()));
            }
        }

        private static void StandsStillInEditor()
        {
            AvatarRenderer shown = Show(files[0]);
            Machine.Playing(false);
            shown.Seconds = 0.1;
            Frames(10);
            Say("seconds", shown.Seconds);
            Machine.Playing(true);
            Frames(10);
            Say("seconds", shown.Seconds);
        }

        /// <summary>A joint's GameObject is destroyed while it poses the avatar; another one has the name of a joint.</summary>
        private static void LosesJoint()
        {
            var rig = new Rig();
            Transform twin = new GameObject(rig.Avatar.Skeleton.Names[rig.Joints.Length - 1]).transform;
            twin.SetParent(rig.Root, false);
            twin.localRotation = Quaternion.Euler(70, 0, 0);
            var joints = rig.Bind();
            var pose = new AvatarPose(rig.Avatar);
            pose.Sample(joints, 0);
            SayLast(pose, rig.Avatar);
            UnityEngine.Object.DestroyImmediate(rig.Last.gameObject);
            pose.Sample(joints, 1);
            SayLast(pose, rig.Avatar);
        }

        /// <summary>An avatar that no camera has drawn yet, then one does.</summary>
        private static void IsNotDrawnYet()
        {
            Camera camera = Scene[0].GetComponent<Camera>();
            camera.enabled = false;
            AvatarRenderer shown = Show(files[0]);
            Frames(3);
            Say("shadows", shown.State + " " + Recorder.Renders);
            camera.enabled = true;
            Frames(3);
            Say("shadows", shown.State + " " + Recorder.Renders);
        }

        /// <summary>A rig one of whose joints is inactive.</summary>
        private static void HasInactiveJoint()
        {
            var rig = new Rig();
            rig.Last.gameObject.SetActive(false);
            Say("missing", rig.Bind().Missing);
        }

        /// <summary>The rotation of the last joint.</summary>
        private static void SayLast(AvatarPose pose, AvatarFile avatar)
        {
            QuaternionD q = QuaternionD.Load(pose.Current, avatar.Skeleton.JointCount - 1);
            Say("last", q.W + " " + q.X + " " + q.Y + " " + q.Z);
        }

        /// <summary>Cameras that draw one layer alone, of two avatars on layers of their own.</summary>
        private static void LiesOnLayers()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            first.Views = second.Views = AvatarViews.Splats | AvatarViews.Shadow;
            first.gameObject.layer = 3;
            second.gameObject.layer = 7;
            Camera camera = Scene[0].GetComponent<Camera>();
            foreach (int layer in new[] { 3, 7, 5 })
            {
                camera.cullingMask = 1 << layer;
                int draws = Recorder.Draws;
                Frames(1);
                Say("drawn", Recorder.Draws - draws);
                Say("splats", Recorder.Draws == draws ? 0 : AvatarWorld.Current.SplatCount);
            }
            second.transform.position = new Vector3(4, 0, 0);
            Frames(1);
            Say("shadow", Recorder.LastRender.layer + " " + (Recorder.LastRender.worldBounds.center - second.Bounds.center).magnitude);
            Say("shadow size", Recorder.LastRender.worldBounds.size.magnitude / second.Bounds.size.magnitude);
        }
    }
}
