using System.IO;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>Shows an avatar anew when its file has changed: a component notices only another asset.</summary>
    internal sealed class AvatarReimport : AssetPostprocessor
    {
        private static void OnPostprocessAllAssets(
            string[] importedAssets, string[] deletedAssets, string[] movedAssets, string[] movedFromAssetPaths)
        {
            foreach (string path in importedAssets)
            {
                if (Path.GetExtension(path) == "." + AvatarImporter.Extension)
                {
                    Show(path);
                }
            }
        }

        private static void Show(string path)
        {
            foreach (AvatarRenderer shown in AvatarRenderer.All())
            {
                if (shown.Avatar != null && AssetDatabase.GetAssetPath(shown.Avatar) == path)
                {
                    shown.Load(shown.Avatar);
                }
            }
        }
    }
}
