using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEditor.Build;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua.Editor
{
    /// <summary>Player settings of both platforms, as Meta and Unity's OpenXR plug-in ask for them.</summary>
    internal static class ProjectPlayer
    {
        public const string Identifier = "com.mua.player"; // where mua-deploy looks for the player

        // What Meta's store asks of an application since March 2026.
        private const AndroidSdkVersions Oldest = AndroidSdkVersions.AndroidApiLevel32;
        private const AndroidSdkVersions OldestTarget = AndroidSdkVersions.AndroidApiLevel34;

        private static readonly string[] DefaultIdentifiers = { "com.DefaultCompany.", "com.Company.", "com.unity.template" };
        private static readonly GraphicsDeviceType[] Quest3D = { GraphicsDeviceType.Vulkan };

        private static readonly GraphicsDeviceType[] Windows3D =
        {
            GraphicsDeviceType.Direct3D11, GraphicsDeviceType.Direct3D12,
        };

        public static IEnumerable<ProjectSetting> Quest()
        {
            NamedBuildTarget android = NamedBuildTarget.Android;
            return new[]
            {
                Linear(),
                ProjectSetting.Of(
                    "Player > Scripting backend", ScriptingImplementation.IL2CPP,
                    () => PlayerSettings.GetScriptingBackend(android),
                    value => PlayerSettings.SetScriptingBackend(android, value)),
                ProjectSetting.Of(
                    "Player > IL2CPP code generation", Il2CppCodeGeneration.OptimizeSpeed,
                    () => PlayerSettings.GetIl2CppCodeGeneration(android),
                    value => PlayerSettings.SetIl2CppCodeGeneration(android, value)),
                ProjectSetting.Of(
                    "Player > Managed stripping level", ManagedStrippingLevel.Low,
                    () => PlayerSettings.GetManagedStrippingLevel(android), IsGentle,
                    value => PlayerSettings.SetManagedStrippingLevel(android, value)),
                ProjectSetting.Of(
                    "Player > Package name", Identifier,
                    () => PlayerSettings.GetApplicationIdentifier(android), IsOwn,
                    value => PlayerSettings.SetApplicationIdentifier(android, value)),
                ProjectSetting.Of(
                    "Player > Target architectures", AndroidArchitecture.ARM64,
                    () => PlayerSettings.Android.targetArchitectures,
                    value => PlayerSettings.Android.targetArchitectures = value),
                ProjectSetting.Of(
                    "Player > Minimum API level", Oldest, () => PlayerSettings.Android.minSdkVersion,
                    value => value >= Oldest, value => PlayerSettings.Android.minSdkVersion = value),
                ProjectSetting.Of(
                    "Player > Target API level", OldestTarget, // not Auto, which is whatever a machine has
                    () => PlayerSettings.Android.targetSdkVersion, value => value >= OldestTarget,
                    value => PlayerSettings.Android.targetSdkVersion = value),
                ProjectSetting.Of(
                    "Player > Application entry point", AndroidApplicationEntry.GameActivity,
                    () => PlayerSettings.Android.applicationEntry,
                    value => PlayerSettings.Android.applicationEntry = value),
                ProjectSetting.Of(
                    "Player > Default orientation", UIOrientation.LandscapeLeft,
                    () => PlayerSettings.defaultInterfaceOrientation,
                    value => PlayerSettings.defaultInterfaceOrientation = value),
                DefaultApis(BuildTarget.Android),
                Apis(BuildTarget.Android, Quest3D),
                ProjectSetting.Of(
                    "Player > Multithreaded rendering", true, () => PlayerSettings.GetMobileMTRendering(android),
                    value => PlayerSettings.SetMobileMTRendering(android, value)),
                ProjectSetting.Of(
                    "Player > Apply display rotation during rendering", false,
                    () => PlayerSettings.vulkanEnablePreTransform,
                    value => PlayerSettings.vulkanEnablePreTransform = value),
                ProjectSetting.Of(
                    "Player > Texture compression formats", new[] { TextureCompressionFormat.ASTC },
                    () => PlayerSettings.Android.textureCompressionFormats,
                    value => PlayerSettings.Android.textureCompressionFormats = value),
                ProjectSetting.Of(
                    "Build > Texture compression", MobileTextureSubtarget.ASTC,
                    () => EditorUserBuildSettings.androidBuildSubtarget, IsAstcOrDefault,
                    value => EditorUserBuildSettings.androidBuildSubtarget = value),
            };
        }

        public static IEnumerable<ProjectSetting> PcLink()
        {
            return new[]
            {
                Linear(),
                DefaultApis(BuildTarget.StandaloneWindows64),
                ProjectSetting.Of(
                    "Player > Graphics APIs for StandaloneWindows64", Windows3D,
                    () => PlayerSettings.GetGraphicsAPIs(BuildTarget.StandaloneWindows64),
                    value => value.Length > 0 && value.All(api => Windows3D.Contains(api)),
                    value => PlayerSettings.SetGraphicsAPIs(BuildTarget.StandaloneWindows64, value)),
                ProjectSetting.Of(
                    "Player > Run in background", true, () => PlayerSettings.runInBackground, // the PC's window has no focus
                    value => PlayerSettings.runInBackground = value),
            };
        }

        /// <summary>The platform itself, last: scripts may be compiled anew for it.</summary>
        public static IEnumerable<ProjectSetting> Active(BuildTarget target)
        {
            string how = Application.isBatchMode ? $"{target}: start Unity with -buildTarget {target}" : $"{target}";
            yield return new ProjectSetting(
                "Build > Platform", how,
                () => EditorUserBuildSettings.activeBuildTarget.ToString(),
                () => EditorUserBuildSettings.activeBuildTarget == target,
                () => Switch(target));
        }

        private static void Switch(BuildTarget target)
        {
            if (!Application.isBatchMode) // where Unity has no way to switch
            {
                EditorUserBuildSettings.SwitchActiveBuildTarget(BuildPipeline.GetBuildTargetGroup(target), target);
            }
        }

        private static ProjectSetting Linear()
        {
            return ProjectSetting.Of(
                "Player > Color space", ColorSpace.Linear, () => PlayerSettings.colorSpace,
                value => PlayerSettings.colorSpace = value);
        }

        private static ProjectSetting DefaultApis(BuildTarget target)
        {
            return ProjectSetting.Of(
                $"Player > Auto graphics API for {target}", false, () => PlayerSettings.GetUseDefaultGraphicsAPIs(target),
                value => PlayerSettings.SetUseDefaultGraphicsAPIs(target, value));
        }

        private static ProjectSetting Apis(BuildTarget target, GraphicsDeviceType[] wanted)
        {
            return ProjectSetting.Of(
                $"Player > Graphics APIs for {target}", wanted, () => PlayerSettings.GetGraphicsAPIs(target),
                value => PlayerSettings.SetGraphicsAPIs(target, value));
        }

        private static bool IsGentle(ManagedStrippingLevel level)
        {
            return level == ManagedStrippingLevel.Low || level == ManagedStrippingLevel.Minimal
                || level == ManagedStrippingLevel.Disabled;
        }

        // An application's own name is its user's to choose.
        private static bool IsOwn(string identifier)
        {
            return !string.IsNullOrEmpty(identifier) && !DefaultIdentifiers.Any(each => identifier.StartsWith(each));
        }

        // Generic leaves it to the player settings' formats.
        private static bool IsAstcOrDefault(MobileTextureSubtarget format)
        {
            return format == MobileTextureSubtarget.ASTC || format == MobileTextureSubtarget.Generic;
        }
    }
}
