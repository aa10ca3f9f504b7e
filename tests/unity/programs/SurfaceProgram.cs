// What the package draws of avatars beside their splats. Arguments: `grid AVATAR TARGET` writes the three arrays of the texel
// grid, each after its length, or says why there is none; `draw KERNELS RECORDING SCENARIO AVATARS..` records the surfaces of the last avatar, which
// shares its splats with those before it. The scenario: `screen WIDTH HEIGHT NEAR`, then up to two lines `eye VIEW[16]
// PROJECTION[16]` of Unity's matrices, row by row, then `decode SECONDS PLACE[8]`: Unity's position, rotation (x, y, z, w), size.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Threading;
using Mua.Format;
using StandIns;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    internal static class SurfaceProgram
    {
        private const AvatarViews All = AvatarViews.Geometry | AvatarViews.Template | AvatarViews.Skeleton | AvatarViews.Shadow;
        private const int WarmUp = 10, Frames = 200;
        private const int Patience = 10000; // milliseconds

        private static readonly AvatarEyes Eyes = new AvatarEyes();
        private static readonly CommandBuffer Commands = new CommandBuffer();
        private static readonly List<AvatarDraw> Draws = new List<AvatarDraw>();
        private static readonly GameObject Owner = new GameObject("shown");

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            if (arguments[0] == "grid")
            {
                WriteGrid(AvatarFile.Read(File.ReadAllBytes(arguments[1])), arguments[2]);
            }
            else
            {
                DrawAll(arguments);
            }
            return 0;
        }

        private static void WriteGrid(AvatarFile avatar, string path)
        {
            TexelGrid grid;
            try
            {
                grid = TexelGrid.Build(avatar);
            }
            catch (InvalidOperationException error)
            {
                System.Console.WriteLine(error.Message);
                return;
            }
            using (var writer = new BinaryWriter(File.Create(path)))
            {
                foreach (int[] values in new[] { grid.Triangles, grid.RingStarts, grid.Ring })
                {
                    writer.Write(values.Length);
                    foreach (int value in values)
                    {
                        writer.Write(value);
                    }
                }
            }
        }

        private static void DrawAll(string[] arguments)
        {
            Recorder.Start(arguments[2]);
            AvatarResources resources = PackageResources.Place(arguments[1]);
            var actors = new List<Actor>();
            for (int i = 4; i < arguments.Length; i++)
            {
                actors.Add(new Actor(resources, arguments[i]));
            }
            var splats = new SplatFrame(resources, actors.ConvertAll(actor => actor.Frame));
            AvatarFrame frame = actors[actors.Count - 1].Frame;
            var surface = new AvatarSurface(resources, frame);
            int made = Recorder.Made;
            surface.CastShadow(All, new Bounds(), Owner); // before there is a pose
            Collect(surface, AvatarViews.Splats);
            Say("idle", Recorder.Made - made, Recorder.Renders, Draws.Count);
            Follow(arguments[3], actors[actors.Count - 1]);
            splats.Project(Commands, Eyes);
            Graphics.ExecuteCommandBuffer(Commands);
            Commands.Clear();
            Machine.Playing(true);
            Collect(surface, All);
            Say("first", Draws.Count); // the grid is made on another thread
            for (int waited = 0; Draws.Count < 3 && waited < Patience; waited++)
            {
                Thread.Sleep(1);
                Collect(surface, All);
            }
            Say("made", Recorder.Made - made, Recorder.Made);
            Run(surface);
            Say("again", Recorder.Made - made);
            Machine.Playing(false);
            using (var still = new AvatarSurface(resources, frame))
            {
                Collect(still, AvatarViews.Geometry);
                Say("still", Draws.Count);
            }
            Machine.Playing(true);
            Recorder.Pause();
            long before = 0;
            for (int i = -WarmUp; i < Frames; i++)
            {
                before = i == 0 ? GC.GetAllocatedBytesForCurrentThread() : before;
                Run(surface);
            }
            long allocated = GC.GetAllocatedBytesForCurrentThread() - before;
            Say("allocated", allocated);
            Recorder.Resume();
            for (int twice = 0; twice < 2; twice++)
            {
                surface.Dispose();
                splats.Dispose();
                actors.ForEach(actor => actor.Dispose());
            }
            Recorder.Stop();
            Say("alive", Recorder.AliveCount);
        }

        private static void Collect(AvatarSurface surface, AvatarViews views)
        {
            Draws.Clear();
            surface.AddOpaque(Draws, Eyes, views);
            surface.AddOverlay(Draws, Eyes, views);
        }

        /// <summary>Draws all, in the order of a frame: first what the lights see.</summary>
        private static void Run(AvatarSurface surface)
        {
            surface.CastShadow(All, new Bounds(), Owner);
            Collect(surface, All);
            for (int i = 0; i < Draws.Count; i++)
            {
                Draws[i].Append(Commands);
            }
            Graphics.ExecuteCommandBuffer(Commands);
            Commands.Clear();
        }

        private static void Follow(string scenario, Actor actor)
        {
            foreach (string line in File.ReadAllLines(scenario))
            {
                string[] words = line.Split(' ');
                if (words[0] == "screen")
                {
                    Eyes.Begin((int)Scenario.Number(words, 1), (int)Scenario.Number(words, 2), Scenario.Number(words, 3));
                }
                else if (words[0] == "eye")
                {
                    Eyes.Add(Scenario.Matrix(words, 1), Scenario.Matrix(words, 17));
                }
                else
                {
                    actor.Decode(Commands, Scenario.Number(words, 1), Scenario.Place(words, 2));
                }
            }
        }

        private static void Say(string what, params long[] numbers)
        {
            System.Console.WriteLine(what + " " + string.Join(" ", numbers));
        }
    }
}
