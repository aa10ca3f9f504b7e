// Matches names of expressions for tests/unity/test_expression_names.py: a line of an avatar's names, then one of a source's,
// split by tabs; writes the shares of each pair in a line.

using System;
using System.Globalization;
using System.IO;
using System.Text;
using Mua.Motion;

internal static class NamesProgram
{
    private static void Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        string[] lines = File.ReadAllLines(arguments[0], Encoding.UTF8);
        for (int i = 0; i < lines.Length; i += 2)
        {
            float[,] shares = ExpressionNames.Match(Names(lines[i]), Names(lines[i + 1]));
            var written = new StringBuilder();
            foreach (float share in shares)
            {
                written.Append(share.ToString("R")).Append(' ');
            }
            Console.WriteLine(written.ToString().TrimEnd());
        }
    }

    private static string[] Names(string line)
    {
        return line == "none" ? new string[0] : line.Split('\t');
    }
}
