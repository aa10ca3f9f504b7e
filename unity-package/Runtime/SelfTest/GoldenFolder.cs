using UnityEngine;
#if UNITY_EDITOR
using System;
using System.IO;
using UnityEditor.PackageManager;
#endif

namespace Mua.SelfTest
{
    /// <summary>Where golden files lie: in StreamingAssets of a player; for the editor, in or beside the package.</summary>
    internal static class GoldenFolder
    {
        /// <summary>In StreamingAssets; the editor puts it into players (Editor/SelfTestData.cs).</summary>
        public const string Name = "MuaGolden";

        public static string InPlayer => Application.streamingAssetsPath + "/" + Name;
#if UNITY_EDITOR
        /// <summary>What is wrong where Find finds nothing.</summary>
        public const string Missing =
            "com.mua.avatar was installed without the self-test's files; install it from its tarball or from a clone.";

        /// <summary>In a tarball all lie together; in the repository, kernels' and avatars' lie apart.</summary>
        private static readonly string[] Places = { "Tests/Golden~", "../tests/parity/golden", "../tests/golden" };

        /// <summary>The folder that holds a golden file; null where the package came without.</summary>
        public static string Find(string file)
        {
            PackageInfo package = PackageInfo.FindForAssembly(typeof(GoldenFolder).Assembly);
            if (package == null)
            {
                return null;
            }
            string place = Array.Find(Places, found => File.Exists(Path.Combine(package.resolvedPath, found, file)));
            return place == null ? null : Path.GetFullPath(Path.Combine(package.resolvedPath, place));
        }
#endif
    }
}
