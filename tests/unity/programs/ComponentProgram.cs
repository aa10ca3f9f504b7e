// Runs AvatarRenderer in the stand-ins' player loop. Arguments: the folder of the kernels, the story, avatars. It prints what
// tests/unity/test_component*.py ask about; a story ends with all objects destroyed.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
using System.Threading;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private const int Patience = 4000; // frames, with a millisecond each, until loading must be over
        private const float Step = 1f / 72;
        private const int Turns = 2 * (ChannelDecoder.Parts + 1); // frames in which two avatars are decoded

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
            Say("asked", Machine.Asked);
            Say("clips", string.Join(" ", new List<string>(shown.Clips).ToArray()));
            Frames(10);
            int dispatches = Recorder.Dispatches, draws = Recorder.Draws;
            Frames(72);
            Say("dispatches", Recorder.Dispatches - dispatches);
            Say("draws", Recorder.Draws - draws);
            int lookups = Recorder.Lookups;
            long before = GC.GetAllocatedBytesForCurrentThread();
            Frames(72);
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            Say("lookups", Recorder.Lookups - lookups);
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
            Frames(Turns);
            Say("both", AvatarWorld.Current.SplatCount);
            second.Views = AvatarViews.Template;
            Frames(2);
            Say("one", AvatarWorld.Current.SplatCount);
            int alive = Recorder.AliveCount;
            second.enabled = false;
            Frames(2);
            Say("fewer", Recorder.AliveCount < alive ? 1 : 0);
            second.enabled = true;
            Until(second);
            Frames(Turns);
            Say("again", Recorder.AliveCount == alive ? 1 : 0);
            first.Load(files[1]);
            Until(first);
            Say("state", first.State + " " + second.State);
        }

        private static void StaysBehind()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            first.IsPlaying = second.IsPlaying = false;
            Frames(Turns);
            second.enabled = false;
            Say("left", Dispatches(1));
            Say("idle", Dispatches(1));
        }

        /// <summary>Two avatars before the camera, then one behind it, then both.</summary>
        private static void StandsOutOfView()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            first.IsPlaying = second.IsPlaying = false;
            Frames(Turns);
            Say("both", Dispatches(1));
            Vector3 near = new Vector3(0, 0, -1.5f * second.Bounds.size.magnitude), far = 4 * near;
            second.transform.position = near;
            second.Frame = 3;
            Say("shadow", Dispatches(1));
            Frames(Turns);
            Say("one", Dispatches(1));
            second.transform.position = far;
            second.Frame = 5;
            Say("far", Dispatches(1));
            Say("stands", second.Bounds.max.z < 3 * near.z ? 1 : 0);
            second.Views = AvatarViews.Splats;
            Frames(2);
            second.transform.position = near;
            Say("without", Dispatches(1));
            first.transform.position = far;
            Frames(2);
            Say("none", Dispatches(1));
            Say("drawn", AvatarWorld.Current.Draws.Count);
            first.transform.position = second.transform.position = Vector3.zero;
            Say("again", Dispatches(1));
            Frames(Turns);
            Say("back", Dispatches(1));
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

        /// <summary>What is drawn of an avatar between whose texels there is no triangle.</summary>
        private static void ShowsSparse()
        {
            Show(files[0]).Views = (AvatarViews)31;
            for (int i = 0; i < 60; i++)
            {
                Frames(1);
                Thread.Sleep(1);
            }
            foreach (AvatarDraw draw in AvatarWorld.Current.Draws)
            {
                Say("order", draw.Material.shader.name + " " + draw.Pass);
            }
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

        /// <summary>What is said of the progress in each frame until the avatar is there.</summary>
        private static void MakesProgress()
        {
            AvatarRenderer shown = Begin(files[0]);
            for (int i = 0; i < Patience && shown.State == AvatarState.Loading; i++)
            {
                Say("progress", shown.Progress);
                Frames(1);
                Thread.Sleep(1);
            }
            Say("progress", shown.Progress);
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
            Machine.Paths(Path.Combine(folder, "others"), folder);
            Say("of both", Show(name).AvatarName);
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
            Say("held", Recorder.AliveCount + Requests.Open);
        }

        private static void FailsAtAddress()
        {
            files[0] = "https://";
            Fails();
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

        private static void LacksThreads()
        {
            Machine.Platform(RuntimePlatform.WebGLPlayer);
            Fails();
        }

        private static void LacksBuffers()
        {
            Machine.ComputeBuffers(4);
            Fails();
        }

        private static void LacksVertexBuffers()
        {
            Machine.VertexBuffers(2);
            Fails();
        }

        private static void HasJustEnoughBuffers()
        {
            Machine.ComputeBuffers(8);
            Machine.VertexBuffers(3);
            Say("state", Show(files[0]).State);
        }

        private static void LacksGraphics()
        {
            Machine.ComputeShaders(false);
            Machine.GraphicsDevice(UnityEngine.Rendering.GraphicsDeviceType.Null);
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
            Machine.BufferSize(2 * 32 * AvatarWorld.Current.SplatCount - 1);
            AvatarRenderer second = Show(files[0]);
            Frames(20);
            Say("state", first.State + " " + second.State);
            Say("message", second.Message);
            Say("shown", AvatarWorld.Current.Draws.Count);
        }

        /// <summary>Of so many frames.</summary>
        private static int Dispatches(int frames)
        {
            int before = Recorder.Dispatches;
            Frames(frames);
            return Recorder.Dispatches - before;
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
