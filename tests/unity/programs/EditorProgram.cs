// Runs the engine-free part of unity-package/Editor for tests/unity/test_summary.py.
using System;
using System.Globalization;
using System.IO;
using Mua.Editor;
using Mua.Format;

internal static class EditorProgram
{
    /// <summary>Arguments: `summary` and a file, or `portrait`, a file, its side and where its pixels go.</summary>
    private static int Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = new CultureInfo("de-DE"); // which writes decimals with a comma
        AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(arguments[1]));
        if (arguments[0] == "summary")
        {
            Console.Out.Write(AvatarSummary.Of(avatar));
            return 0;
        }
        File.WriteAllBytes(arguments[3], Portrait.Draw(avatar, int.Parse(arguments[2])));
        return 0;
    }
}
