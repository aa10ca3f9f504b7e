// Runs the engine-free part of unity-package/Editor for tests/unity/test_summary.py.
using System;
using System.Globalization;
using System.IO;
using Mua.Editor;
using Mua.Format;

internal static class EditorProgram
{
    /// <summary>Prints the summary of a file, its one argument.</summary>
    private static int Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = new CultureInfo("de-DE"); // which writes decimals with a comma
        Console.Out.Write(AvatarSummary.Of(AvatarFile.Read(File.ReadAllBytes(arguments[0]))));
        return 0;
    }
}
