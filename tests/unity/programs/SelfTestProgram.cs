// Runs the self-test in the stand-ins' player loop. Arguments: the folder of the kernels, StreamingAssets, a recording to
// write or "-", the folder of its answers or "-", the story, words of the command line. It prints the log.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
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

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            resources = MakeResources(arguments[0]);
            Machine.Place("MuaAvatarResources", resources);
            streaming = arguments[1];
            Machine.Paths(streaming, streaming);
            Readbacks.Folder = arguments[3] == "-" ? null : arguments[3];
            words = new List<string>(arguments).GetRange(5, arguments.Length - 5).ToArray();
            if (arguments[2] != "-")
            {
                Recorder.Start(arguments[2]);
            }
            typeof(SelfTestProgram).GetMethod(arguments[4], BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, null);
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
            PlayerRun run = PlayerRun.Begin(words);
            int frames = 0;
            while (run != null && frames < Patience)
            {
                PlayerLoop.Frame(Step);
                frames++;
            }
            Say("frames", frames);
            Say("over", run == null);
            Say("exit", Machine.ExitCode);
        }

        private static void PlaysFromPackage()
        {
            Machine.Paths("jar:file://" + streaming, streaming);
            Plays();
        }

        private static void WaitsForNothing()
        {
            Machine.Readback(false);
            Plays();
        }

        private static void WaitsInEditor()
        {
            var run = new SelfTestRun("0123abcd", streaming + "/" + GoldenFolder.Name, true);
            IEnumerator steps = run.Run();
            while (steps.MoveNext())
            {
            }
            Say("passed", run.HasPassed);
        }

        private static void IsStuck()
        {
            Readbacks.Stuck = true;
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
            Set("splatSort", null);
            Plays();
        }

        private static AvatarResources MakeResources(string folder)
        {
            resources = ScriptableObject.CreateInstance<AvatarResources>();
            foreach (string stem in GoldenFile.Stems)
            {
                string[] parts = stem.Split('_');
                string field = parts[0] + char.ToUpperInvariant(parts[1][0]) + parts[1].Substring(1);
                Set(field, Recorder.Compute(Path.Combine(folder, stem + ".compute")));
            }
            foreach (FieldInfo field in typeof(AvatarResources).GetFields(BindingFlags.Instance | BindingFlags.NonPublic))
            {
                if (field.FieldType == typeof(Shader))
                {
                    field.SetValue(resources, Recorder.Drawing(field.Name));
                }
            }
            return resources;
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
