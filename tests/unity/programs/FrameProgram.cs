// Plays avatars by the package's own frames over the stand-ins, which record it. Arguments: the folder of the kernels, the
// path of the recording, the scenario, the avatars. The scenario has one line for each step:
//   screen WIDTH HEIGHT NEAR INSTANCES eyes after it are of this screen; an indirect draw is of so many instances
//   eye VIEW[16] PROJECTION[16]        Unity's matrices, row by row
//   decode AVATAR SECONDS PLACE[7]     Unity's position, then rotation (x, y, z, w)
//   sort LABEL                         sort, execute, and keep what the frame left
//   draw MODE                          draw what was sorted, `indirect` or `direct`
//   again COUNT                        without recording: decode and sort so often, and print what was allocated
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using Mua.Format;
using StandIns;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    internal static class FrameProgram
    {
        private const int WarmUp = 10;

        private static readonly AvatarEyes Eyes = new AvatarEyes();
        private static readonly CommandBuffer Commands = new CommandBuffer();
        private static readonly List<Actor> Actors = new List<Actor>();
        private static int width, height;
        private static int instances;
        private static float near;
        private static bool newEyes;

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            Recorder.Start(arguments[1]);
            AvatarResources resources = PackageResources.Place(arguments[0]);
            for (int i = 3; i < arguments.Length; i++)
            {
                Actors.Add(new Actor(resources, arguments[i]));
            }
            SplatFrame splats = new SplatFrame(resources, Actors.ConvertAll(actor => actor.Frame));
            int made = Recorder.Made;
            string[] steps = File.ReadAllLines(arguments[2]);
            foreach (string step in steps)
            {
                Run(step.Split(' '), splats);
            }
            System.Console.WriteLine("made " + (Recorder.Made - made));
            splats.Dispose();
            splats.Dispose();
            foreach (Actor actor in Actors)
            {
                actor.Dispose();
                actor.Dispose();
            }
            Recorder.Stop();
            System.Console.WriteLine("alive " + Recorder.AliveCount + " " + Recorder.AliveNames());
            return 0;
        }

        private static void Run(string[] words, SplatFrame splats)
        {
            if (words[0] == "screen")
            {
                width = (int)Scenario.Number(words, 1);
                height = (int)Scenario.Number(words, 2);
                near = Scenario.Number(words, 3);
                instances = (int)Scenario.Number(words, 4);
                newEyes = true;
            }
            else if (words[0] == "eye")
            {
                if (newEyes)
                {
                    Eyes.Begin(width, height, near, instances);
                }
                newEyes = false;
                Eyes.Add(Scenario.Matrix(words, 1), Scenario.Matrix(words, 17));
            }
            else if (words[0] == "decode")
            {
                double seconds = double.Parse(words[2], CultureInfo.InvariantCulture);
                Actors[(int)Scenario.Number(words, 1)].Decode(Commands, seconds, Scenario.Place(words, 3), words.Length > 11 ? (int)Scenario.Number(words, 11) : 0);
            }
            else if (words[0] == "sort")
            {
                int before = Recorder.Dispatches;
                Execute(splats);
                System.Console.WriteLine("dispatches " + words[1] + " " + (Recorder.Dispatches - before));
                Keep(splats, words[1]);
            }
            else if (words[0] == "draw")
            {
                Draw(splats, words[1] == "indirect");
            }
            else
            {
                Recorder.Pause();
                System.Console.WriteLine("allocated " + Again((int)Scenario.Number(words, 1), splats));
                Recorder.Resume();
            }
        }

        private static void Execute(SplatFrame splats)
        {
            splats.Project(Commands, Eyes);
            splats.Sort(Commands);
            Graphics.ExecuteCommandBuffer(Commands);
            Commands.Clear();
        }

        private static void Draw(SplatFrame splats, bool indirect)
        {
            typeof(SystemInfo).GetProperty("supportsIndirectArgumentsBuffer").SetValue(null, indirect);
            using (var draw = new SplatDraw(Recorder.Drawing("Hidden/MUA/Splat")))
            {
                draw.Bind(splats).Append(Commands);
                Graphics.ExecuteCommandBuffer(Commands);
                Commands.Clear();
            }
        }

        private static void Keep(SplatFrame splats, string label)
        {
            Recorder.Keep(splats.Splats, label + " splats");
            Recorder.Keep(splats.Order, label + " order");
            Recorder.Keep(splats.Keys, label + " keys");
            Recorder.Keep(splats.Arguments, label + " arguments");
        }

        /// <summary>Bytes that so many frames ask of the managed heap.</summary>
        private static long Again(int count, SplatFrame splats)
        {
            var place = new AvatarPlace(Vector3.zero, Quaternion.identity);
            long before = 0;
            for (int i = -WarmUp; i < count; i++)
            {
                if (i == 0)
                {
                    before = GC.GetAllocatedBytesForCurrentThread();
                }
                foreach (Actor actor in Actors)
                {
                    actor.Decode(Commands, i / 50.0, place, (i + WarmUp) / 7 % 3);
                }
                Execute(splats);
            }
            return GC.GetAllocatedBytesForCurrentThread() - before;
        }
    }
}
