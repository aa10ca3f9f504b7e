// Draws avatars in a pipeline of stand-ins, and notes each frame in the recording. Arguments: the folder of the kernels, the
// path of the recording, builtin | urp, a StereoMode or None, a file with the eyes, an avatar. Lines of
// that file: `screen WIDTH HEIGHT NEAR`, then `eye VIEW[16] PROJECTION[16]` for each, Unity's matrices row by row.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Threading;
using StandIns;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.Universal;

namespace Mua
{
    internal sealed class OtherPipelineAsset : RenderPipelineAsset
    {
    }

    internal static class PipelineProgram
    {
        private const int Patience = 4000; // frames, with a millisecond each, until loading must be over
        private const int Measured = 100; // frames
        private const float Step = 1f / 72;

        private static readonly List<AvatarRenderer> Avatars = new List<AvatarRenderer>();
        private static Camera main;
        private static Universal universal;
        private static string file;
        private static int frame;

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            Recorder.Start(arguments[1]);
            PackageResources.Place(arguments[0]);
            main = MakeCamera("main");
            Look(File.ReadAllLines(arguments[4]));
            if (arguments[3] != "None")
            {
                Eyes.Wear((StereoMode)Enum.Parse(typeof(StereoMode), arguments[3]));
            }
            if (arguments[2] == "urp")
            {
                PlayerLoop.StartGame();
                PlayerLoop.StartGame(); // again, in the same domain
                universal = new Universal();
            }
            file = arguments[5];
            Show();
            Tell();
            Say("alive", Recorder.AliveCount);
            Say("attached", main.AttachedBuffers);
            foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
            {
                Say("log", line.Key + " " + line.Value);
            }
            Recorder.Stop();
            return 0;
        }

        private static void Tell()
        {
            Frame("moved", true);
            Frame("still", false);
            Measure();
            Scale();
            Avatars[0].Views = AvatarViews.Splats | AvatarViews.Geometry | AvatarViews.Template | AvatarViews.Skeleton;
            bool twice = Eyes.IsMultiPass;
            AwaitDraws(twice ? 8 : 4);
            Frame("all views", true);
            Avatars[0].Views = AvatarViews.Splats;
            Camera other = MakeCamera("other");
            Frame("two", true);
            other.cameraType = CameraType.SceneView;
            Frame("scene view", true);
            other.cameraType = CameraType.Reflection;
            Frame("reflection", true);
            other.cameraType = CameraType.Preview;
            Frame("preview", true);
            other.cameraType = CameraType.Game;
            other.cullingMask = ~1;
            Frame("other layers", true);
            other.cullingMask = -1;
            other.orthographic = true;
            Frame("orthographic", true);
            other.orthographic = false;
            if (universal != null)
            {
                TellUniversal(other);
            }
            UnityEngine.Object.DestroyImmediate(other.gameObject);
            Direct();
            DestroyOne();
            Destroy();
            Pipelines.Use(ScriptableObject.CreateInstance<OtherPipelineAsset>());
            Pipelines.Render = null;
            Avatars.Clear();
            Show();
            Frame("other pipeline", true);
            UnityEngine.Object.DestroyImmediate(Avatars[0].gameObject);
        }

        /// <summary>What only URP does with cameras.</summary>
        private static void TellUniversal(Camera other)
        {
            UniversalAdditionalCameraData settings = other.gameObject.AddComponent<UniversalAdditionalCameraData>();
            settings.Own = new ScriptableRenderer();
            Frame("own renderer", true);
            other.cameraType = CameraType.SceneView;
            Frame("scene view with settings", true);
            other.cameraType = CameraType.Game;
            settings.Own = null;
            universal.Culled.Add(main);
            Frame("culled", true);
            other.cullingMask = ~1;
            Frame("culled before another", true);
            other.cullingMask = -1;
            universal.Culled.Clear();
            settings.renderType = CameraRenderType.Overlay;
            main.gameObject.AddComponent<UniversalAdditionalCameraData>().cameraStack.Add(other);
            Frame("overlay", true);
            universal.HasColor = false;
            Frame("depth only", true);
            universal.HasColor = true;
            var graph = new RenderGraphSettings { enableRenderCompatibilityMode = true };
            Pipelines.Set(graph);
            Frame("compatibility", true);
            Frame("compatibility", true);
            graph.enableRenderCompatibilityMode = false;
            UnityEngine.Object.DestroyImmediate(main.GetComponent<UniversalAdditionalCameraData>());
        }

        private static void Measure()
        {
            Avatars[0].IsPlaying = true;
            Advance(Measured); // whoever replays knows of the second set of channels
            Recorder.Pause();
            long before = GC.GetAllocatedBytesForCurrentThread();
            Advance(Measured);
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            Recorder.Resume();
            Avatars[0].IsPlaying = false;
        }

        private static void Scale()
        {
            main.allowDynamicResolution = true;
            if (universal != null)
            {
                universal.UsesDynamicScale = true;
                universal.RenderScale = 0.8f;
            }
            Resize(0.5f, 0.5f);
            Frame("scaled", true);
            Resize(0.33f, 0.33f);
            Frame("scaled between pixels", true);
            Resize(0.5f, 0.5f);
            Machine.Platform(RuntimePlatform.Android);
            Frame("scaled on a Quest", true);
            if (universal != null)
            {
                universal.IsBackBuffer = true;
                Frame("scaled without a copy on a Quest", true);
                universal.IsBackBuffer = false;
            }
            Resize(1, 0.5f); // a scale that something else left, which is not the headset's
            Frame("whole on a Quest", true);
            Resize(1, 1);
            Machine.Platform(RuntimePlatform.LinuxPlayer);
            main.allowDynamicResolution = false;
            if (universal != null)
            {
                universal.UsesDynamicScale = false;
                universal.RenderScale = 1;
            }
        }

        private static void Resize(float headset, float buffers)
        {
            Eyes.Scale = headset;
            ScalableBufferManager.ResizeBuffers(buffers, buffers * buffers); // width and height on their own
        }

        /// <summary>All avatars again, on a device that takes no counts from a buffer.</summary>
        private static void Direct()
        {
            Machine.IndirectArguments(false);
            foreach (AvatarRenderer avatar in Avatars)
            {
                avatar.enabled = false;
            }
            foreach (AvatarRenderer avatar in Avatars)
            {
                avatar.enabled = true;
                Await(avatar);
            }
            Frame("direct", true);
            Machine.IndirectArguments(true);
        }

        /// <summary>One of two, when a camera was asked to draw its buffers.</summary>
        private static void DestroyOne()
        {
            Show();
            Avatars[1].Views = AvatarViews.Template;
            Advance(2 * (ChannelDecoder.Parts + 1)); // each has its turn
            Frame("one of two", true);
            Camera.onPreRender += EndSecond;
            Frame("one destroyed", true);
            Camera.onPreRender -= EndSecond;
            EndSecond(null);
            Frame("one left", false);
        }

        private static void EndSecond(Camera camera)
        {
            if (Avatars.Count > 1)
            {
                UnityEngine.Object.DestroyImmediate(Avatars[1].gameObject);
                Avatars.RemoveAt(1);
            }
        }

        /// <summary>The avatars, when a camera has begun with them, or its passes are recorded.</summary>
        private static void Destroy()
        {
            Camera.onPreRender += EndWith;
            if (Eyes.IsWorn && universal != null)
            {
                universal.BeforeExecute = End;
            }
            else
            {
                RenderPipelineManager.beginCameraRendering += EndWith;
            }
            Frame("destroyed", true);
            Camera.onPreRender -= EndWith;
            RenderPipelineManager.beginCameraRendering -= EndWith;
            Frame("empty", false);
        }

        private static void EndWith(ScriptableRenderContext context, Camera camera)
        {
            End();
        }

        private static void EndWith(Camera camera)
        {
            End();
        }

        private static void End()
        {
            foreach (AvatarRenderer avatar in Avatars)
            {
                if (avatar != null)
                {
                    UnityEngine.Object.DestroyImmediate(avatar.gameObject);
                }
            }
        }

        /// <summary>One frame after a note of its label; `moves`: the first avatar shows another frame of its clip.</summary>
        private static void Frame(string label, bool moves)
        {
            if (moves)
            {
                frame = 1 + frame % 5;
                Avatars[0].Frame = frame;
            }
            Recorder.Note("frame " + label);
            Advance(1);
            Recorder.Note("end");
        }

        private static void Show()
        {
            AvatarRenderer avatar = new GameObject("avatar").AddComponent<AvatarRenderer>();
            avatar.IsPlaying = false;
            avatar.Views = AvatarViews.Splats;
            avatar.Load(file);
            Avatars.Add(avatar);
            Await(avatar);
        }

        private static void Await(AvatarRenderer avatar)
        {
            for (int i = 0; i < Patience && avatar.State != AvatarState.Ready; i++)
            {
                Advance(1);
                Thread.Sleep(1);
            }
            avatar.IsPlaying = false;
            Advance(1);
        }

        /// <summary>Waits for what is made beside the frames.</summary>
        private static void AwaitDraws(int wanted)
        {
            int drawn = 0;
            for (int i = 0; i < Patience && drawn < wanted; i++)
            {
                Thread.Sleep(1);
                int before = Recorder.Draws;
                Advance(1);
                drawn = Recorder.Draws - before;
            }
        }

        private static void Look(string[] lines)
        {
            int eye = 0;
            foreach (string line in lines)
            {
                string[] words = line.Split(' ');
                if (words[0] == "screen")
                {
                    Eyes.Resolution((int)Scenario.Number(words, 1), (int)Scenario.Number(words, 2));
                    main.nearClipPlane = Scenario.Number(words, 3);
                    continue;
                }
                Eyes.Look(eye++, Scenario.Matrix(words, 1), Scenario.Matrix(words, 17));
                if (eye == 1)
                {
                    main.worldToCameraMatrix = Scenario.Matrix(words, 1);
                    main.projectionMatrix = Scenario.Matrix(words, 17);
                }
            }
        }

        private static Camera MakeCamera(string name)
        {
            Camera camera = new GameObject(name).AddComponent<Camera>();
            camera.transform.position = new Vector3(0, 1, -3);
            return camera;
        }

        private static void Advance(int frames)
        {
            for (int i = 0; i < frames; i++)
            {
                PlayerLoop.Frame(Step);
            }
        }

        private static void Say(string name, object value)
        {
            System.Console.WriteLine(name + "\t" + value);
        }
    }
}
