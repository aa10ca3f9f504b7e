// What the package draws of avatars beside their splats. Arguments: `grid AVATAR TARGET` writes the three arrays of the texel
// grid, each after its length, or says why there is none; `draw KERNELS RECORDING SCENARIO AVATARS..` records the surfaces of the last avatar, which
// shares its splats with those before it. The scenario: `screen WIDTH HEIGHT NEAR`, then up to two lines `eye VIEW[16]
// PROJECTION[16]` of Unity's matrices, row by row, then `decode SECONDS PLACE[7]`: Unity's position and rotation (x, y, z, w).
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Threading;
using Mua.Format;
using Mua.Motion;
using StandIns;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    internal static class SurfaceProgram
    {
        private const AvatarViews All = AvatarViews.Geometry | AvatarViews.Mesh | AvatarViews.Skeleton | AvatarViews.Shadow;
        private const int WarmUp = 10, Frames = 200;
        private const int Patience = 10000; // milliseconds

        private static readonly AvatarEyes Eyes = new AvatarEyes();
        private static readonly CommandBuffer Commands = new CommandBuffer();
        private static readonly List<AvatarDraw> Draws = new List<AvatarDraw>();

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
            var buffers = new List<AvatarBuffers>();
            var frames = new List<AvatarFrame>();
            for (int i = 4; i < arguments.Length; i++)
            {
                buffers.Add(new AvatarBuffers(AvatarFile.Read(File.ReadAllBytes(arguments[i]))));
                while (!buffers[i - 4].Upload(1 << 16))
                {
                }
                frames.Add(new AvatarFrame(resources, buffers[i - 4]));
            }
            var splats = new SplatFrame(resources, frames);
            AvatarFrame frame = frames[frames.Count - 1];
            var surface = new AvatarSurface(resources, frame);
            int made = Recorder.Made;
            surface.CastShadow(All, new Bounds(), 0); // before there is a pose
            Collect(surface, AvatarViews.Splats);
            Say("idle", Recorder.Made - made, Recorder.Renders, Draws.Count);
            Follow(arguments[3], frame);
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
                frames.ForEach(each => each.Dispose());
                buffers.ForEach(each => each.Dispose());
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
            surface.CastShadow(All, new Bounds(), 0);
            Collect(surface, All);
            for (int i = 0; i < Draws.Count; i++)
            {
                Draws[i].Append(Commands);
            }
            Graphics.ExecuteCommandBuffer(Commands);
            Commands.Clear();
        }

        private static void Follow(string scenario, AvatarFrame frame)
        {
            foreach (string line in File.ReadAllLines(scenario))
            {
                string[] words = line.Split(' ');
                if (words[0] == "screen")
                {
                    Eyes.Begin((int)Number(words, 1), (int)Number(words, 2), Number(words, 3));
                }
                else if (words[0] == "eye")
                {
                    Eyes.Add(Matrix(words, 1), Matrix(words, 17));
                }
                else
                {
                    Decode(frame, words);
                }
            }
        }

        private static void Decode(AvatarFrame frame, string[] words)
        {
            AvatarFile file = frame.Avatar.Avatar;
            var clip = new ClipSampler(file.Clips[0], file.Skeleton, file.Encoding.Rate);
            var rotations = new double[4 * file.Encoding.Window * file.Skeleton.JointCount];
            var translations = new double[3 * file.Encoding.Window * file.Skeleton.JointCount];
            clip.ReadWindow((int)clip.Position(Number(words, 1)), file.Encoding.Window, rotations, translations);
            var position = new Vector3(Number(words, 2), Number(words, 3), Number(words, 4));
            var rotation = new Quaternion(Number(words, 5), Number(words, 6), Number(words, 7), Number(words, 8));
            frame.Decode(Commands, rotations, translations, AvatarSpace.Place(position, rotation));
        }

        private static void Say(string what, params long[] numbers)
        {
            System.Console.WriteLine(what + " " + string.Join(" ", numbers));
        }

        private static Matrix4x4 Matrix(string[] words, int first)
        {
            var matrix = new Matrix4x4();
            for (int i = 0; i < 16; i++)
            {
                matrix[i / 4, i % 4] = Number(words, first + i);
            }
            return matrix;
        }

        private static float Number(string[] words, int index)
        {
            return float.Parse(words[index], CultureInfo.InvariantCulture);
        }
    }
}
