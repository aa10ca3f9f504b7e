using System.IO;
using UnityEditor;

namespace Mua.Editor
{
    /// <summary>Folders of a project for what set-up and the build make.</summary>
    internal static class ProjectAssets
    {
        public const string Folder = "Assets/MUA";

        /// <summary>Makes a folder, and those above it, where there is none.</summary>
        public static void MakeFolder(string path)
        {
            path = path.Replace('\\', '/');
            if (AssetDatabase.IsValidFolder(path))
            {
                return;
            }
            string parent = Path.GetDirectoryName(path);
            MakeFolder(parent);
            AssetDatabase.CreateFolder(parent.Replace('\\', '/'), Path.GetFileName(path));
        }
    }
}
