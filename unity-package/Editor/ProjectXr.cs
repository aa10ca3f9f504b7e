using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEngine;
#if MUA_XR_MANAGEMENT && MUA_OPENXR
using UnityEditor.XR.Management;
using UnityEditor.XR.Management.Metadata;
using UnityEngine.XR.Management;
#endif

namespace Mua.Editor
{
    /// <summary>
    /// OpenXR as the one way to a headset, started with the player; ProjectOpenXr has what it does there. Where its packages
    /// are absent there is nothing to set, and ProjectPackages says so.
    /// </summary>
    internal static class ProjectXr
    {
#if MUA_XR_MANAGEMENT && MUA_OPENXR
        private const string Loader = "UnityEngine.XR.OpenXR.OpenXRLoader";
        private const string SettingsPath = "Assets/XR/XRGeneralSettingsPerBuildTarget.asset"; // the plug-in's own place
        private const string Absent = "absent";

        public static IEnumerable<ProjectSetting> Settings(BuildTarget target)
        {
            BuildTargetGroup group = BuildPipeline.GetBuildTargetGroup(target);
            yield return new ProjectSetting(
                $"XR > Loader for {group}", Loader, () => FirstLoader(group), () => FirstLoader(group) == Loader,
                () => Assign(group));
            yield return new ProjectSetting(
                $"XR > Initialize XR on startup for {group}", "on", () => Startup(group), () => Startup(group) == "on",
                () => Start(group));
            foreach (ProjectSetting setting in ProjectOpenXr.Settings(target == BuildTarget.Android, group))
            {
                yield return setting;
            }
        }

        // The asset is the project's own, though the editor may have lost sight of it.
        private static XRGeneralSettingsPerBuildTarget Find()
        {
            XRGeneralSettingsPerBuildTarget settings;
            if (EditorBuildSettings.TryGetConfigObject(XRGeneralSettings.k_SettingsKey, out settings))
            {
                return settings;
            }
            return AssetDatabase.FindAssets("t:" + nameof(XRGeneralSettingsPerBuildTarget))
                .Select(guid => AssetDatabase.GUIDToAssetPath(guid))
                .Select(path => AssetDatabase.LoadAssetAtPath<XRGeneralSettingsPerBuildTarget>(path))
                .FirstOrDefault(each => each != null);
        }

        private static XRManagerSettings Manager(BuildTargetGroup group)
        {
            XRGeneralSettingsPerBuildTarget settings = Find();
            return settings == null ? null : settings.ManagerSettingsForBuildTarget(group);
        }

        // The first that starts is used; a second one is for where the first cannot.
        private static string FirstLoader(BuildTargetGroup group)
        {
            XRManagerSettings manager = Manager(group);
            XRLoader first = manager == null ? null : manager.activeLoaders.FirstOrDefault(each => each != null);
            return first == null ? Absent : first.GetType().FullName;
        }

        private static void Assign(BuildTargetGroup group)
        {
            XRGeneralSettingsPerBuildTarget settings = Find();
            if (settings == null)
            {
                settings = Create();
            }
            EditorBuildSettings.AddConfigObject(XRGeneralSettings.k_SettingsKey, settings, true);
            if (!settings.HasSettingsForBuildTarget(group))
            {
                settings.CreateDefaultSettingsForBuildTarget(group);
            }
            if (!settings.HasManagerSettingsForBuildTarget(group))
            {
                settings.CreateDefaultManagerSettingsForBuildTarget(group);
            }
            XRPackageMetadataStore.AssignLoader(settings.ManagerSettingsForBuildTarget(group), Loader, group);
            EditorUtility.SetDirty(settings);
        }

        private static XRGeneralSettingsPerBuildTarget Create()
        {
            ProjectAssets.MakeFolder(Path.GetDirectoryName(SettingsPath));
            var settings = ScriptableObject.CreateInstance<XRGeneralSettingsPerBuildTarget>();
            AssetDatabase.CreateAsset(settings, SettingsPath);
            return settings;
        }

        private static string Startup(BuildTargetGroup group)
        {
            XRGeneralSettingsPerBuildTarget settings = Find();
            XRGeneralSettings general = settings == null ? null : settings.SettingsForBuildTarget(group);
            return general == null ? Absent : general.InitManagerOnStart ? "on" : "off";
        }

        private static void Start(BuildTargetGroup group)
        {
            XRGeneralSettings general = Find().SettingsForBuildTarget(group);
            general.InitManagerOnStart = true;
            EditorUtility.SetDirty(general);
        }
#else
        public static IEnumerable<ProjectSetting> Settings(BuildTarget target)
        {
            return Array.Empty<ProjectSetting>();
        }
#endif
    }
}
