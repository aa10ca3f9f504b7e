// Runs the self-test or a bench in the stand-ins' player loop. Arguments: the folder of the kernels, StreamingAssets, a recording to
// write or "-", the folder of its answers or "-", the story, words of the command line. It prints the log.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
using System.Threading;
using Mua.SelfTest;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static class SelfTestProgram
    {
        private const int Patience = 30000; // frames
        private const float Step = 1f / 72;

        private static AvatarResources resources;
        private static string streaming;
        private static string[] words;
        private static int gone; // frame in which the avatar is destroyed; 0 is none

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            resources = PackageResources.Place(arguments[0]);
            streaming = arguments[1];
            Machine.Paths(streaming, streaming);
            Readbacks.Folder = arguments[3] == "-" ? null : arguments[3];
            words = new List<string>(arguments).GetRange(5, arguments.Length - 5).ToArray();
            if (arguments[2] != "-")
            {
                Recorder.Start(arguments[2]);
            }
            typeof(SelfTestProgram).GetMethod(arguments[4], BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, null);
            foreach (AvatarRenderer shown in Shown())
            {
                UnityEngine.Object.DestroyImmediate(shown.gameObject);
            }
            Say("alive", Recorder.AliveCount);
            Say("requests", Requests.Open);
            if (arguments[2] != "-")
            {
                Recorder.Stop();
            }
            foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
            {
                Say(line.Key.ToString(), line.Value);
            }
            return 0;
        }

        private static void Plays()
        {
            WaitFor(PlayerRun.Begin(words));
        }

        /// <summary>As the engine starts it, by the command line of this program.</summary>
        private static void PlaysOnLoad()
        {
            typeof(PlayerRun).GetMethod("BeginOnLoad", BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, null);
            WaitFor(UnityEngine.Object.FindAnyObjectByType<PlayerRun>());
        }

        private static void WaitFor(PlayerRun run)
        {
            int frames = 0;
            while (run != null && frames < Patience)
            {
                PlayerLoop.Frame(Step);
                frames++;
                if (Array.Exists(Shown(), shown => shown.State == AvatarState.Loading))
                {
                    Thread.Sleep(1); // another thread reads
                }
                if (frames == gone)
                {
                    UnityEngine.Object.DestroyImmediate(Shown()[0].gameObject);
                }
            }
            Say("frames", frames);
            Say("over", run == null);
            Say("exit", Machine.ExitCode);
            Say("shown", Shown().Length);
            Camera eye = UnityEngine.Object.FindAnyObjectByType<Camera>();
            foreach (AvatarRenderer shown in eye == null ? new AvatarRenderer[0] : Shown())
            {
                Vector3 middle = eye.transform.InverseTransformPoint(shown.Bounds.center);
                Say("middle", middle.x + " " + middle.y + " " + middle.z);
            }
        }

        private static void PlaysFromPackage()
        {
            Machine.Paths("jar:file://" + streaming, streaming);
            Plays();
        }

        private static void IsBroken()
        {
            Readbacks.Broken = true;
            Plays();
        }

        private static void LacksCompute()
        {
            Machine.ComputeShaders(false);
            Plays();
        }

        private static void LacksResources()
        {
            Machine.Place("MuaAvatarResources", null);
            Plays();
        }

        private static void LacksKernel()
        {
            const BindingFlags field = BindingFlags.Instance | BindingFlags.NonPublic;
            typeof(AvatarResources).GetField("splatSort", field).SetValue(resources, null);
            Plays();
        }

        private static void LosesAvatar()
        {
            gone = 1000; // frames
            Plays();
        }

        private static void IsTimed()
        {
            Timings.Gpu = 4.5;
            Markers.Measure("MUA sort", 2000000);
            Plays();
        }

        private static void CannotWrite()
        {
            Machine.Paths(streaming, streaming + "/nowhere");
            Plays();
        }

        private static void LooksDown()
        {
            Transform eye = new GameObject("eye").AddComponent<Camera>().transform;
            eye.SetPositionAndRotation(new Vector3(4, 1.6f, -1), Quaternion.Euler(80, 30, 0));
            Plays();
        }

        /// <summary>A scene that shows the avatars of the bench and another.</summary>
        private static void HasScene()
        {
            AvatarRenderer first = Show("first"), second = Show("second");
            first.Speed = 3;
            Plays();
            Say("on", first.enabled + " " + second.enabled + " " + first.Speed);
        }

        private static AvatarRenderer Show(string stem)
        {
            AvatarRenderer shown = new GameObject(stem).AddComponent<AvatarRenderer>();
            shown.Load("avatars/" + stem + ".muaavatar");
            return shown;
        }

        private static AvatarRenderer[] Shown()
        {
            return UnityEngine.Object.FindObjectsByType<AvatarRenderer>(FindObjectsSortMode.None);
        }

        private static void Say(string name, object value)
        {
            System.Console.WriteLine(name + "\t" + value);
        }
    }
}
