// Prints the portrait of an avatar as base64. Arguments: the file, pixels along a side. Asked for by tests/unity/test_portrait.py.
using System;
using System.IO;
using Mua.Format;

namespace Mua.Editor
{
    internal static class PortraitProgram
    {
        public static int Main(string[] arguments)
        {
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(arguments[0]));
            Console.WriteLine(Convert.ToBase64String(Portrait.Draw(avatar, int.Parse(arguments[1]))));
            return 0;
        }
    }
}
