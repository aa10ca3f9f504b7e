// Builds the texel grid of an avatar file and writes its three arrays after their lengths.
using System;
using System.IO;
using Mua.Format;

namespace Mua
{
    internal static class SurfaceProgram
    {
        public static int Main(string[] arguments)
        {
            AvatarFile file = AvatarFile.Read(File.ReadAllBytes(arguments[0]));
            var clock = System.Diagnostics.Stopwatch.StartNew();
            TexelGrid grid = TexelGrid.Build(file);
            System.Console.WriteLine(clock.ElapsedMilliseconds);
            using (var writer = new BinaryWriter(File.Create(arguments[1])))
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
            return 0;
        }
    }
}
