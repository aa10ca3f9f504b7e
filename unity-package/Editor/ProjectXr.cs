using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEngine;
#if MUA_XR_MANAGEMENT && MUA_OPENXR
using UnityEditor.XR.Management;
using UnityEditor.XR.Management.Metadata;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine.Rendering;
using UnityEngine.XR.Management;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;
#endif

namespace Mua.Editor
{
    /// <summary>
    /// OpenXR as the one way to a headset, started with the player: both eyes in one pass, controllers, and on a Quest coarser
    /// pixels at the edges of the view. Where its packages are absent there is nothing to set, and ProjectPackages says so.
    /// </summary>
    internal static class ProjectXr
    {
#if MUA_XR_MANAGEMENT && MUA_OPENXR
        private const string Loader = "UnityEngine.XR.OpenXR.OpenXRLoader";
        private const string SettingsPath = "Assets/XR/XRGeneralSettingsPerBuildTarget.asset"; // the plug-in's own place
        private const string MetaQuest = "com.unity.openxr.feature.metaquest";
        private const string Foveation = "com.unity.openxr.feature.foveatedrendering";
        private const string Touch = "com.unity.openxr.feature.input.oculustouch";
        private const string TouchPlus = "com.unity.openxr.feature.input.metaquestplus";
        private const string DisplayRate = "com.unity.openxr.feature.meta-display-utilities"; // of com.unity.xr.meta-openxr
        private const string LateLatching = "lateLatchingMode"; // of MetaQuest; it has no public name

        public static IEnumerable<ProjectSetting> Settings(BuildTarget target)
        {
            BuildTargetGroup group = BuildPipeline.GetBuildTargetGroup(target);
            bool isQuest = target == BuildTarget.Android;
            yield return new ProjectSetting(
                $"XR > Loader for {group}", Loader, () => FirstLoader(group), () => FirstLoader(group) == Loader,
                () => Assign(group));
            yield return ProjectSetting.In(
                $"XR > Initialize XR on startup for {group}", true, () => General(group),
                general => general.InitManagerOnStart, (general, value) => general.InitManagerOnStart = value);
            yield return OpenXr(
                group, "Render mode", OpenXRSettings.RenderMode.SinglePassInstanced, // which is multiview on a Quest
                settings => settings.renderMode, (settings, value) => settings.renderMode = value);
            foreach (string id in isQuest ? new[] { MetaQuest, Foveation, Touch, TouchPlus } : new[] { Touch, TouchPlus })
            {
                yield return Enabled(group, id);
            }
            if (isQuest && Feature(group, DisplayRate) != null)
            {
                yield return Enabled(group, DisplayRate);
            }
            if (isQuest && GraphicsSettings.defaultRenderPipeline != null) // the built-in one knows the legacy way only
            {
                yield return OpenXr(
                    group, "Foveated rendering API", OpenXRSettings.BackendFovationApi.SRPFoveation,
                    settings => settings.foveatedRenderingApi, (settings, value) => settings.foveatedRenderingApi = value);
            }
            if (isQuest) // it moves the eyes after splats were sorted and projected for them
            {
                yield return ProjectSetting.Of(
                    $"OpenXR > Late latching for {group}", false, () => IsLatched(group), value => Latch(group, value));
            }
        }

        private static ProjectSetting OpenXr<T>(
            BuildTargetGroup group, string name, T wanted, Func<OpenXRSettings, T> read, Action<OpenXRSettings, T> write)
        {
            return ProjectSetting.In(
                $"OpenXR > {name} for {group}", wanted, () => OpenXRSettings.GetSettingsForBuildTargetGroup(group), read, write,
                () => FeatureHelpers.RefreshFeatures(group));
        }

        private static ProjectSetting Enabled(BuildTargetGroup group, string id)
        {
            return ProjectSetting.In(
                $"OpenXR > {id} for {group}", true, () => Feature(group, id), feature => feature.enabled,
                (feature, value) => feature.enabled = value, () => FeatureHelpers.RefreshFeatures(group));
        }

        private static OpenXRFeature Feature(BuildTargetGroup group, string id)
        {
            return FeatureHelpers.GetFeatureWithIdForBuildTarget(group, id);
        }

        private static bool IsLatched(BuildTargetGroup group)
        {
            OpenXRFeature quest = Feature(group, MetaQuest);
            SerializedProperty field = quest == null ? null : new SerializedObject(quest).FindProperty(LateLatching);
            return field != null && field.boolValue;
        }

        private static void Latch(BuildTargetGroup group, bool value)
        {
            var quest = new SerializedObject(Feature(group, MetaQuest));
            quest.FindProperty(LateLatching).boolValue = value;
            quest.ApplyModifiedPropertiesWithoutUndo();
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
            return first == null ? ProjectSetting.Absent : first.GetType().FullName;
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

        private static XRGeneralSettings General(BuildTargetGroup group)
        {
            XRGeneralSettingsPerBuildTarget settings = Find();
            return settings == null ? null : settings.SettingsForBuildTarget(group);
        }
#else
        public static IEnumerable<ProjectSetting> Settings(BuildTarget target)
        {
            return Array.Empty<ProjectSetting>();
        }
#endif
    }
}
