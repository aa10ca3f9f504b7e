// Retargets poses with unity-package/Runtime/Motion/Retargeting for tests/unity/test_retargeted_poses.py, which writes what it reads:
// lines of a word and numbers or names, apart by tabs. An empty line begins another case.

using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    internal static class RetargetProgram
    {
        private const int Repeats = 100;

        private static void Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            var lines = new List<string[]>();
            foreach (string line in File.ReadLines(arguments[0]).Append(""))
            {
                if (line.Length > 0)
                {
                    lines.Add(line.Split('\t'));
                    continue;
                }
                Tell(lines);
                lines.Clear();
            }
        }

        private static void Tell(List<string[]> lines)
        {
            Skeleton source = Read(lines, "source");
            if (!lines.Any(line => line[0] == "target.names"))
            {
                JointRoles roles = Limbs.Find(source);
                Console.WriteLine(string.Join(";", roles.Names.Select(role => role + "=" + string.Join(",", roles[role]))));
                return;
            }
            Skeleton target = Read(lines, "target");
            string[] stated = Strings(lines, "stated");
            var mapping = lines.Where(line => line[0] == "map").ToDictionary(line => line[1], line => line[2]);
            try
            {
                var retargeter = new Retargeter(
                    source, target, stated?.Select(role => role == "" ? null : role).ToArray(), mapping);
                retargeter.InPlace = lines.Any(line => line[0] == "in place");
                Console.WriteLine("used\t" + string.Join(",", retargeter.Used));
                Pose(retargeter, lines, target.JointCount);
            }
            catch (InvalidOperationException error)
            {
                Console.WriteLine("refused\t" + error.Message);
            }
        }

        private static void Pose(Retargeter retargeter, List<string[]> lines, int joints)
        {
            var rotations = new double[4 * joints];
            var translations = new double[3 * joints];
            double[][] turned = All(lines, "turned"), placed = All(lines, "placed");
            double rate = All(lines, "rate")[0][0];
            for (int frame = 0; frame < turned.Length; frame++)
            {
                retargeter.Pose(turned[frame], placed[frame], frame / rate, rotations, translations);
                Print("rotations", rotations);
                Print("translations", translations);
            }
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < Repeats; i++)
            {
                retargeter.Pose(turned[i % turned.Length], placed[i % turned.Length], i / rate, rotations, translations);
            }
            Console.WriteLine("allocated\t" + (GC.GetAllocatedBytesForCurrentThread() - before));
        }

        private static Skeleton Read(List<string[]> lines, string owner)
        {
            int[] parents = Strings(lines, owner + ".parents").Select(int.Parse).ToArray();
            double[] rotations = All(lines, owner + ".rotations")[0], translations = All(lines, owner + ".translations")[0];
            int root = int.Parse(Strings(lines, owner + ".root")[0]);
            return new Skeleton(Strings(lines, owner + ".names"), parents, rotations, translations, root);
        }

        private static string[] Strings(List<string[]> lines, string word)
        {
            return lines.Find(line => line[0] == word)?.Skip(1).ToArray();
        }

        private static double[][] All(List<string[]> lines, string word)
        {
            return lines.Where(line => line[0] == word).Select(line => line.Skip(1).Select(double.Parse).ToArray()).ToArray();
        }

        private static void Print(string name, double[] values)
        {
            var bytes = new byte[Buffer.ByteLength(values)];
            Buffer.BlockCopy(values, 0, bytes, 0, bytes.Length);
            Console.WriteLine(name + "\t" + BitConverter.ToString(bytes).Replace("-", ""));
        }
    }
}
