// Expressions for tests/unity/test_mapped_expressions.py, of a file of two lines each: `names`, those of an avatar and of a
// source, split by tabs, give the shares of each pair in a line; `rules`, and weights, give what shows of these.

using System;
using System.Collections;
using System.Globalization;
using System.IO;
using System.Text;
using Mua.Motion;

internal static class ExpressionsProgram
{
    private static void Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        string[] lines = File.ReadAllLines(arguments[1], Encoding.UTF8);
        for (int i = 0; i < lines.Length; i += 2)
        {
            Write(arguments[0] == "names"
                ? (IEnumerable)ExpressionNames.Match(Names(lines[i]), Names(lines[i + 1]))
                : Shown(Words(lines[i]), Words(lines[i + 1])));
        }
    }

    private static float[] Shown(string[] rules, string[] weights)
    {
        float[] shown = Array.ConvertAll(weights, float.Parse);
        ExpressionRules.Apply(Array.ConvertAll(rules, int.Parse), shown);
        return shown;
    }

    private static void Write(IEnumerable values)
    {
        var written = new StringBuilder();
        foreach (float value in values)
        {
            written.Append(value.ToString("R")).Append(' ');
        }
        Console.WriteLine(written.ToString().TrimEnd());
    }

    private static string[] Names(string line)
    {
        return line == "none" ? new string[0] : line.Split('\t');
    }

    private static string[] Words(string line)
    {
        return line.Split(new[] { ' ' }, StringSplitOptions.RemoveEmptyEntries);
    }
}
