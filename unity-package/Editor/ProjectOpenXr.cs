#if MUA_XR_MANAGEMENT && MUA_OPENXR
using System.Collections.Generic;
using UnityEditor;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine.Rendering;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;

namespace Mua.Editor
{
    /// <summary>
    /// OpenXR's own settings: both eyes in one pass, controllers, and on a Quest coarser pixels at the edges of the view.
    /// </summary>
    internal static class ProjectOpenXr
    {
        private const string MetaQuest = "com.unity.openxr.feature.metaquest";
        private const string Foveation = "com.unity.openxr.feature.foveatedrendering";
        private const string Touch = "com.unity.openxr.feature.input.oculustouch";
        private const string TouchPlus = "com.unity.openxr.feature.input.metaquestplus";
        private const string DisplayRate = "com.unity.openxr.feature.meta-display-utilities"; // of com.unity.xr.meta-openxr
        private const string LateLatching = "lateLatchingMode"; // of MetaQuest; it has no public name
        private const string Absent = "absent";

        public static IEnumerable<ProjectSetting> Settings(bool isQuest, BuildTargetGroup group)
        {
            yield return Setting(
                group, "Render mode", OpenXRSettings.RenderMode.SinglePassInstanced, // which is multiview on a Quest
                settings => settings.renderMode, (settings, value) => settings.renderMode = value);
            string[] ids = isQuest ? new[] { MetaQuest, Foveation, Touch, TouchPlus } : new[] { Touch, TouchPlus };
            foreach (string id in ids)
            {
                yield return Feature(group, id);
            }
            if (isQuest && State(group, DisplayRate) != Absent)
            {
                yield return Feature(group, DisplayRate);
            }
            if (isQuest && GraphicsSettings.defaultRenderPipeline != null) // the built-in one knows the legacy way only
            {
                yield return Setting(
                    group, "Foveated rendering API", OpenXRSettings.BackendFovationApi.SRPFoveation,
                    settings => settings.foveatedRenderingApi, (settings, value) => settings.foveatedRenderingApi = value);
            }
            if (isQuest)
            {
                yield return NoLateLatching(group);
            }
        }

        private static ProjectSetting Setting<T>(
            BuildTargetGroup group, string name, T wanted, System.Func<OpenXRSettings, T> read,
            System.Action<OpenXRSettings, T> write)
        {
            System.Func<string> found = () =>
            {
                OpenXRSettings settings = OpenXRSettings.GetSettingsForBuildTargetGroup(group);
                return settings == null ? Absent : read(settings).ToString();
            };
            return new ProjectSetting(
                $"OpenXR > {name} for {group}", wanted.ToString(), found, () => found() == wanted.ToString(), () =>
                {
                    FeatureHelpers.RefreshFeatures(group);
                    OpenXRSettings settings = OpenXRSettings.GetSettingsForBuildTargetGroup(group);
                    if (settings != null)
                    {
                        write(settings, wanted);
                        EditorUtility.SetDirty(settings);
                    }
                });
        }

        private static ProjectSetting Feature(BuildTargetGroup group, string id)
        {
            return new ProjectSetting(
                $"OpenXR > {id} for {group}", "on", () => State(group, id), () => State(group, id) == "on",
                () => Enable(group, id));
        }

        private static string State(BuildTargetGroup group, string id)
        {
            OpenXRFeature feature = FeatureHelpers.GetFeatureWithIdForBuildTarget(group, id);
            return feature == null ? Absent : feature.enabled ? "on" : "off";
        }

        private static void Enable(BuildTargetGroup group, string id)
        {
            FeatureHelpers.RefreshFeatures(group);
            OpenXRFeature feature = FeatureHelpers.GetFeatureWithIdForBuildTarget(group, id);
            if (feature != null)
            {
                feature.enabled = true;
                EditorUtility.SetDirty(feature);
            }
        }

        /// <summary>It moves the eyes after splats were sorted and projected for them.</summary>
        private static ProjectSetting NoLateLatching(BuildTargetGroup group)
        {
            return ProjectSetting.Of(
                $"OpenXR > Late latching for {group}", false, () => IsLatched(group), value => Latch(group, value));
        }

        private static bool IsLatched(BuildTargetGroup group)
        {
            OpenXRFeature quest = FeatureHelpers.GetFeatureWithIdForBuildTarget(group, MetaQuest);
            SerializedProperty field = quest == null ? null : new SerializedObject(quest).FindProperty(LateLatching);
            return field != null && field.boolValue;
        }

        private static void Latch(BuildTargetGroup group, bool value)
        {
            var quest = new SerializedObject(FeatureHelpers.GetFeatureWithIdForBuildTarget(group, MetaQuest));
            quest.FindProperty(LateLatching).boolValue = value;
            quest.ApplyModifiedPropertiesWithoutUndo();
        }
    }
}
#endif
