using System;
using System.Linq;
using System.Reflection;
using UnityEditor.Build;
using UnityEditor.PackageManager.UI;

namespace Mua.Editor
{
    /// <summary>
    /// The package's sample VR Player: brought into the project, and its scene. Its scripts are there only after the
    /// editor's next start, so that they are found by name.
    /// </summary>
    internal static class PlayerSample
    {
        public const string Name = "VR Player";

        private const string Package = "com.mua.avatar";
        private const string SceneType = "Mua.Samples.VrPlayer.Editor.PlayerScene";
        private const string SceneMethod = "Create";
        private const string ScenePath = ProjectAssets.Folder + "/Player.unity";

        public static bool IsCompiled => FindScene() != null;

        /// <summary>Copies it into Assets/Samples. Errors: BuildFailedException where that is of no use.</summary>
        public static bool Import()
        {
            Sample[] found = Sample.FindByPackage(Package, "").Where(each => each.displayName == Name).ToArray();
            if (found.Length == 0)
            {
                throw new BuildFailedException($"package {Package} has no sample '{Name}': reinstall the package");
            }
            if (found[0].isImported)
            {
                throw new BuildFailedException(
                    $"the sample '{Name}' in {found[0].importPath} has no {SceneType}: delete that folder and run again");
            }
            if (!found[0].Import(Sample.ImportOptions.HideImportWindow | Sample.ImportOptions.OverridePreviousImports))
            {
                throw new BuildFailedException($"the sample '{Name}' could not be copied to {found[0].importPath}");
            }
            return true;
        }

        /// <summary>Writes the player's scene anew and returns its path.</summary>
        public static string CreateScene()
        {
            ProjectAssets.MakeFolder(ProjectAssets.Folder);
            try
            {
                FindScene().Invoke(null, new object[] { ScenePath });
            }
            catch (TargetInvocationException error)
            {
                throw new BuildFailedException($"{SceneType} made no scene: {error.InnerException.Message}");
            }
            return ScenePath;
        }

        private static MethodInfo FindScene()
        {
            Type type = AppDomain.CurrentDomain.GetAssemblies()
                .Select(assembly => assembly.GetType(SceneType)).FirstOrDefault(each => each != null);
            return type?.GetMethod(SceneMethod, new[] { typeof(string) });
        }
    }
}
