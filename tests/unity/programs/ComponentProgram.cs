// Runs AvatarRenderer in the stand-ins' player loop. Arguments: the folder of the kernels, the story, avatars. It prints what
// tests/unity/test_component.py asks about; a story ends with all objects destroyed.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
using System.Threading;
using Mua.Format;
using Mua.Motion;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static class ComponentProgram
    {
        private const int Patience = 4000; // frames, with a millisecond each, until loading must be over
        private const float Step = 1f / 72;

        private static readonly List<GameObject> Scene = new List<GameObject>();
        private static AvatarResources resources;
        private static string[] files;

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            resources = PackageResources.Place(arguments[0]);
            files = new List<string>(arguments).GetRange(2, arguments.Length - 2).ToArray();
            Make("camera").AddComponent<Camera>();
            MethodInfo story = typeof(ComponentProgram).GetMethod(arguments[1], BindingFlags.Static | BindingFlags.NonPublic);
            story.Invoke(null, null);
            foreach (GameObject thing in Scene)
            {
                UnityEngine.Object.DestroyImmediate(thing);
            }
            Say("alive", Recorder.AliveCount);
            Say("requests", Requests.Open);
            Say("world", AvatarWorld.Current == null ? 0 : 1);
            foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
            {
                Say("log", line.Key + " " + line.Value);
            }
            return 0;
        }

        private static void Plays()
        {
            AvatarRenderer shown = Show(files[0]);
            Say("state", shown.State);
            Say("clips", string.Join(" ", new List<string>(shown.Clips).ToArray()));
            Frames(10);
            int dispatches = Recorder.Dispatches, draws = Recorder.Draws;
            Frames(72);
            Say("dispatches", Recorder.Dispatches - dispatches);
            Say("draws", Recorder.Draws - draws);
            long before = GC.GetAllocatedBytesForCurrentThread();
            Frames(72);
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            shown.IsPlaying = false;
            shown.Frame = 3;
            Say("frame", shown.Frame);
            Frames(2);
            dispatches = Recorder.Dispatches;
            Frames(10);
            Say("idle", Recorder.Dispatches - dispatches);
            Bounds box = shown.Bounds;
            shown.transform.position = new Vector3(5, 0, 0);
            Frames(1);
            Say("moved", (shown.Bounds.center - box.center).x);
        }

        private static void Crowd()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            Frames(2);
            Say("both", AvatarWorld.Current.SplatCount);
            second.Views = AvatarViews.Mesh;
            Frames(2);
            Say("one", AvatarWorld.Current.SplatCount);
            int alive = Recorder.AliveCount;
            second.enabled = false;
            Frames(2);
            Say("fewer", Recorder.AliveCount < alive ? 1 : 0);
            second.enabled = true;
            Until(second);
            Frames(2);
            Say("again", Recorder.AliveCount == alive ? 1 : 0);
            first.Load(files[1]);
            Until(first);
            Say("state", first.State + " " + second.State);
        }

        private static void StaysBehind()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            first.IsPlaying = second.IsPlaying = false;
            Frames(2);
            second.enabled = false;
            Say("left", Dispatches(1));
            Say("idle", Dispatches(1));
        }

        private static void ShowsViews()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.Views = (AvatarViews)31;
            for (int i = 0; i < Patience && (i < 2 || AvatarWorld.Current.Draws.Count < 4); i++)
            {
                Frames(1);
                Thread.Sleep(1);
            }
            foreach (AvatarDraw draw in AvatarWorld.Current.Draws)
            {
                Say("order", draw.Material.shader.name + " " + draw.Pass);
            }
            Say("together", Rendered());
            shown.Views = AvatarViews.Shadow;
            Say("shadow", Rendered());
            shown.Views = AvatarViews.None;
            Say("nothing", Rendered());
        }

        /// <summary>Draws of cameras and of lights in a frame.</summary>
        private static string Rendered()
        {
            Frames(2);
            int draws = Recorder.Draws, renders = Recorder.Renders;
            Frames(1);
            return (Recorder.Draws - draws) + " " + (Recorder.Renders - renders);
        }

        private static void LacksSurface()
        {
            Set("surface", null);
            Show(files[0]);
            Say("together", Rendered());
        }

        private static void GoesMidUpload()
        {
            AvatarRenderer shown = Begin(files[0]);
            for (int i = 0; i < Patience && shown.Progress < 0.4f; i++)
            {
                Frames(1);
                Thread.Sleep(1);
            }
            Say("state", shown.State);
            Say("progress", shown.Progress > 0 && shown.Progress < 1 ? 1 : 0);
            Say("held", Recorder.AliveCount > 0 ? 1 : 0);
        }

        private static void GoesMidRead()
        {
            Begin(files[0]);
            Begin("jar:file://" + files[0]);
            Thread.Sleep(200);
        }

        private static void Streams()
        {
            Say("state", Show("jar:file://" + files[0]).State);
            Say("state", Show("jar:file://" + files[0] + ".not").State);
        }

        private static void FindsFiles()
        {
            string folder = Path.GetDirectoryName(files[0]), name = Path.GetFileName(files[0]);
            Machine.Paths(folder, "/nowhere");
            Say("state", Show(name).State);
            Machine.Paths("/nowhere", folder);
            Say("state", Show(name).State);
            var asset = AvatarAsset.Create(File.ReadAllBytes(files[0]));
            AvatarRenderer shown = Make("avatar").AddComponent<AvatarRenderer>();
            shown.Load(asset);
            Until(shown);
            Say("state", shown.State);
        }

        private static void Fails()
        {
            AvatarRenderer shown = Show(files[0]);
            Frames(20);
            Say("state", shown.State);
            Say("message", shown.Message);
        }

        private static void FailsInEditor()
        {
            Machine.Playing(false);
            Fails();
            Machine.Playing(true);
        }

        private static void LacksKernel()
        {
            Set("splatSort", null);
            Fails();
            Show(files[0]);
        }

        private static void LacksResources()
        {
            Machine.Place("MuaAvatarResources", null);
            Fails();
        }

        private static void LacksCompute()
        {
            Machine.ComputeShaders(false);
            Fails();
            Show(files[0]);
        }

        private static void LacksBuffers()
        {
            Machine.ComputeBuffers(4);
            Fails();
        }

        private static void LacksMemory()
        {
            Machine.BufferSize(1 << 12);
            Fails();
        }

        private static void LacksMemoryForTwo()
        {
            AvatarRenderer first = Show(files[0]);
            Frames(2);
            Machine.BufferSize(2 * 64 * AvatarWorld.Current.SplatCount - 1);
            AvatarRenderer second = Show(files[0]);
            Frames(20);
            Say("state", first.State + " " + second.State);
            Say("message", second.Message);
            Say("shown", AvatarWorld.Current.Draws.Count);
        }

        private static void StartsWithoutReload()
        {
            Show(files[0]);
            Frames(2);
            typeof(AvatarWorld).GetMethod("Restart", BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, null);
            int draws = Recorder.Draws;
            Frames(10);
            Say("draws", Recorder.Draws - draws);
        }

        private static void FollowsRig()
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            Transform[] rig = MakeRig(avatar);
            var joints = new AvatarJoints(avatar.Skeleton, Scene[Scene.Count - 1].transform);
            var read = new double[4 * rig.Length];
            var translations = new double[3 * rig.Length];
            joints.Read(read, translations);
            var clip = new ClipSampler(avatar.Clips[0], avatar.Skeleton, avatar.Encoding.Rate);
            var wanted = new double[4 * rig.Length];
            var wantedTranslations = new double[3 * rig.Length];
            clip.ReadFrame(2, wanted, wantedTranslations);
            double turned = 0, moved = 0;
            for (int i = 0; i < rig.Length; i++)
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
            shown.Rig = Scene[Scene.Count - 2].transform;
            Frames(10);
            long before = GC.GetAllocatedBytesForCurrentThread();
            Frames(72);
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            UnityEngine.Object.DestroyImmediate(rig[avatar.Skeleton.Root].gameObject);
            Frames(20);
            Say("state", shown.State);
        }

        private static void RigRests()
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            Transform[] rig = MakeRig(avatar);
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = Scene[Scene.Count - 2].transform;
            Say("settling", Dispatches(72));
            Say("idle", Dispatches(10));
            rig[rig.Length - 1].localRotation = Quaternion.Euler(0, 40, 0);
            Say("woken", Dispatches(72));
            Say("idle", Dispatches(10));
            shown.transform.position = new Vector3(5, 0, 0);
            Say("carried", Dispatches(1));
            Say("idle", Dispatches(10));
            rig[avatar.Skeleton.Root].localPosition += new Vector3(0, 0.1f, 0);
            Say("stepped", Dispatches(72));
            shown.IsPlaying = false;
            shown.Rig = null;
            Say("left", Dispatches(1));
        }

        /// <summary>A pose that is held for long and then left: the window still holds what was before.</summary>
        private static void RemembersRest()
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            Transform[] rig = MakeRig(avatar);
            var joints = new AvatarJoints(avatar.Skeleton, Scene[Scene.Count - 1].transform);
            var pose = new AvatarPose(avatar);
            double frame = 1 / avatar.Encoding.Rate;
            int changes = 0;
            for (int i = 0; i < 100; i++)
            {
                changes += pose.Sample(joints, i * frame) ? 1 : 0;
            }
            Say("changes", changes);
            pose.IsFresh = false;
            double[] rest = pose.Current.ToArray();
            rig[rig.Length - 1].localRotation = Quaternion.Euler(0, 40, 0);
            Say("changes", pose.Sample(joints, 100 * frame) ? 1 : 0);
            Say("fresh", pose.IsFresh ? 1 : 0);
            double[] window = pose.Window.ToArray();
            int same = 0;
            for (int age = 0; age < avatar.Encoding.Window; age++)
            {
                var held = new ReadOnlySpan<double>(window, age * rest.Length, rest.Length);
                same += held.SequenceEqual(rest) ? 1 : 0;
            }
            Say("rests", avatar.Encoding.Window - same);
        }

        /// <summary>Which poses of a rig that moves all the time are in the window, newest first.</summary>
        private static void WindowTakesTurns()
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            Transform[] rig = MakeRig(avatar);
            var joints = new AvatarJoints(avatar.Skeleton, Scene[Scene.Count - 1].transform);
            var pose = new AvatarPose(avatar);
            double frame = 1 / avatar.Encoding.Rate, now = 100;
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
            var clip = new ClipSampler(avatar.Clips[0], avatar.Skeleton, avatar.Encoding.Rate);
            Say("before", clip.FrameCount - AvatarPose.Position(clip, -0.5 * frame));
            Say("before", clip.FrameCount - AvatarPose.Position(clip, -(clip.FrameCount + 1) * frame));
        }

        private static void Turn(Transform[] rig, AvatarJoints joints, AvatarPose pose, double seconds, List<double[]> seen)
        {
            rig[rig.Length - 1].localRotation = Quaternion.Euler(0, 5 * seen.Count, 0);
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

        /// <summary>Of so many frames.</summary>
        private static int Dispatches(int frames)
        {
            int before = Recorder.Dispatches;
            Frames(frames);
            return Recorder.Dispatches - before;
        }

        private static void LacksJoint()
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            Transform[] rig = MakeRig(avatar);
            rig[rig.Length - 1].gameObject.name = "Another";
            AvatarRenderer shown = Show(files[0]);
            shown.Rig = Scene[Scene.Count - 2].transform;
            Frames(20);
            rig[avatar.Skeleton.Root].gameObject.name = "NoRoot";
            shown.Rig = Scene[Scene.Count - 2].transform;
            Frames(20);
            Say("state", shown.State);
        }

        private static void IsScaled()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.transform.localScale = new Vector3(2, 2, 2);
            Frames(20);
            Say("state", shown.State);
        }

        /// <summary>Transforms that stand as frame 2 of the first clip, below a root that is moved and turned.</summary>
        private static Transform[] MakeRig(AvatarFile avatar)
        {
            Skeleton skeleton = avatar.Skeleton;
            var clip = new ClipSampler(avatar.Clips[0], skeleton, avatar.Encoding.Rate);
            var rotations = new double[4 * skeleton.JointCount];
            var translations = new double[3 * skeleton.JointCount];
            clip.ReadFrame(2, rotations, translations);
            GameObject root = Make("rig");
            root.transform.SetPositionAndRotation(new Vector3(3, -1, 2), Quaternion.Euler(10, 200, -30));
            var rig = new Transform[skeleton.JointCount];
            for (int i = 0; i < rig.Length; i++)
            {
                rig[i] = new GameObject(skeleton.Names[i]).transform;
                rig[i].SetParent(skeleton.Parents[i] < 0 ? root.transform : rig[skeleton.Parents[i]], false);
                rig[i].localPosition = AvatarSpace.Position(Vector3D.Load(translations, i));
                rig[i].localRotation = AvatarSpace.Rotation(QuaternionD.Load(rotations, i));
            }
            return rig;
        }

        private static AvatarRenderer Show(string file)
        {
            AvatarRenderer shown = Begin(file);
            Until(shown);
            return shown;
        }

        private static AvatarRenderer Begin(string file)
        {
            AvatarRenderer shown = Make("avatar").AddComponent<AvatarRenderer>();
            shown.Load(file);
            return shown;
        }

        private static void Until(AvatarRenderer shown)
        {
            for (int i = 0; i < Patience && shown.State == AvatarState.Loading; i++)
            {
                Frames(1);
                Thread.Sleep(1);
            }
        }

        private static void Frames(int count)
        {
            for (int i = 0; i < count; i++)
            {
                PlayerLoop.Frame(Step);
            }
        }

        private static GameObject Make(string name)
        {
            var thing = new GameObject(name);
            Scene.Add(thing);
            return thing;
        }

        private static void Set(string field, UnityEngine.Object value)
        {
            typeof(AvatarResources).GetField(field, BindingFlags.Instance | BindingFlags.NonPublic).SetValue(resources, value);
        }

        private static void Say(string name, object value)
        {
            System.Console.WriteLine(name + "\t" + value);
        }
    }
}
