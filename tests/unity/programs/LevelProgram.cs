// Prints the levels of detail of a file and what is uploaded of them, the filters of levels without details, and the levels
// that are chosen for avatars, for tests/unity/test_levels.py.

using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
using Mua;
using Mua.Format;

internal static class LevelProgram
{
    private static void Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        if (arguments[0] == "choose")
        {
            foreach (string line in File.ReadAllLines(arguments[1]))
            {
                Console.WriteLine(Chosen(line.Split(' ')));
            }
            return;
        }
        if (arguments[0] == "upsampling")
        {
            double[] taps = Array.ConvertAll(arguments[3].Split(','), double.Parse);
            var filter = new Upsampling(taps, int.Parse(arguments[1]), int.Parse(arguments[2]));
            Console.WriteLine("filter " + filter.Delay + " " + filter.Reach + " " + filter.Factor);
            Print("taps", Elements(filter.Taps));
            return;
        }
        AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(arguments[0]));
        var targets = new ExpressionTargets(avatar);
        Console.WriteLine("texel " + ((double)avatar.Texels.Length).ToString("R"));
        new ExpressionBuffers(targets, Uploaded);
        foreach (DetailLevel level in DetailLevel.All(avatar))
        {
            Console.WriteLine("level " + level.Number + " " + level.Size + " " + level.Count);
            Print("texels", level.Texels);
            Print("triangles", level.Triangles);
            Print("barycentrics", level.Barycentrics);
            Print("geometry", level.Geometry);
            Print("appearance", level.Appearance);
            Print("one_sided", level.OneSided);
            new LevelBuffers(level, targets, Uploaded);
        }
    }

    private static Upload Uploaded(Upload upload)
    {
        Array elements = Elements(upload);
        Print("uploaded", elements is TexelTiles.Row[] ? Words((TexelTiles.Row[])elements) : elements);
        return upload;
    }

    private static int[] Words(TexelTiles.Row[] rows)
    {
        var words = new List<int>();
        foreach (TexelTiles.Row row in rows)
        {
            words.Add(row.First);
            words.Add(row.Columns);
        }
        return words.ToArray();
    }

    /// <summary>Levels of a line: budget, then for each avatar distance, texel, shown, count of levels, counts.</summary>
    private static string Chosen(string[] numbers)
    {
        var avatars = new List<AvatarSeen>();
        int at = 1;
        while (at < numbers.Length)
        {
            var seen = new AvatarSeen
            {
                Distance = double.Parse(numbers[at]),
                Texel = double.Parse(numbers[at + 1]),
                Level = int.Parse(numbers[at + 2]),
                Counts = new int[int.Parse(numbers[at + 3])],
            };
            at += 4;
            for (int i = 0; i < seen.Counts.Length; i++)
            {
                seen.Counts[i] = int.Parse(numbers[at++]);
            }
            avatars.Add(seen);
        }
        AvatarSeen[] chosen = avatars.ToArray();
        LevelChoice.Choose(chosen, new int[chosen.Length], long.Parse(numbers[0]));
        return "levels " + string.Join(" ", Array.ConvertAll(chosen, seen => seen.Level.ToString()));
    }

    private static Array Elements(Upload upload)
    {
        FieldInfo field = typeof(Upload).GetField("elements", BindingFlags.Instance | BindingFlags.NonPublic);
        return (Array)field.GetValue(upload);
    }

    private static void Print(string name, Array values)
    {
        var bytes = new byte[Buffer.ByteLength(values)];
        Buffer.BlockCopy(values, 0, bytes, 0, bytes.Length);
        Console.WriteLine(name + " " + BitConverter.ToString(bytes).Replace("-", ""));
    }
}
