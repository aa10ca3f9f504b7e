// Runs ProjectSetup and Build in stand-ins of the editor. Arguments: the story, then its own. It prints what
// tests/unity/test_project_setup.py and test_build.py ask about.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using StandIns;
using UnityEditor;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;
using UnityEngine.Rendering;
#if MUA_OPENXR
using UnityEditor.XR.Management;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine.Rendering.Universal;
using UnityEngine.XR.Management;
using UnityEngine.XR.OpenXR;
#endif

namespace Mua.Editor
{
    internal static class ProjectProgram
    {
        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
#if MUA_URP
            Pipelines.Set(new RenderGraphSettings { enableRenderCompatibilityMode = true });
#endif
            MethodInfo story = typeof(ProjectProgram).GetMethod(arguments[0], BindingFlags.Static | BindingFlags.NonPublic);
            story.Invoke(null, new object[] { arguments.Skip(1).ToArray() });
            Flush();
            return 0;
        }

        private static void SetsUp(string[] arguments)
        {
            BuildTarget target = Target(arguments[0]);
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, target);
            Tell("before", ProjectSetup.Check(target));
            Tell("after", ProjectSetup.Apply(target));
            Flush();
            Say("saved", string.Join(" ", Dialogs.Saved.Distinct().OrderBy(kind => kind, StringComparer.Ordinal)));
            Dialogs.Dirtied.Clear();
            Tell("again", ProjectSetup.Apply(target));
            Say("changed again", StandIns.Console.Lines.Count);
            Say("dirtied again", Dialogs.Dirtied.Count);
        }

#if MUA_URP
        private static void MakesRenderer(string[] arguments)
        {
            const string Place = "Packages/com.unity.render-pipelines.universal/Runtime/Data/PostProcessData.asset";
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, BuildTarget.Android);
            AssetDatabase.CreateAsset(ScriptableObject.CreateInstance<PostProcessData>(), Place);
            ProjectSetup.Apply(BuildTarget.Android);
            var renderer = AssetDatabase.LoadAssetAtPath<UniversalRendererData>("Assets/MUA/Renderer.asset");
            Say("effects", renderer.postProcessData == null ? "" : AssetDatabase.GetAssetPath(renderer.postProcessData));
        }
#endif

        private static void KeepsWhatIsRight(string[] arguments)
        {
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Android, BuildTarget.Android);
            PlayerSettings.SetApplicationIdentifier(NamedBuildTarget.Android, "org.example.own");
            PlayerSettings.Android.minSdkVersion = AndroidSdkVersions.AndroidApiLevel33;
            PlayerSettings.Android.targetSdkVersion = AndroidSdkVersions.AndroidApiLevel35;
            PlayerSettings.SetManagedStrippingLevel(NamedBuildTarget.Android, ManagedStrippingLevel.Minimal);
            Own(arguments[0]);
            Tell("after", ProjectSetup.Apply(BuildTarget.Android));
            Say("identifier", PlayerSettings.GetApplicationIdentifier(NamedBuildTarget.Android));
            Say("sdk", $"{PlayerSettings.Android.minSdkVersion} {PlayerSettings.Android.targetSdkVersion}");
            Say("stripping", PlayerSettings.GetManagedStrippingLevel(NamedBuildTarget.Android));
            Say("pipeline", GraphicsSettings.defaultRenderPipeline == null ? "built-in" : "own");
        }

#if MUA_OPENXR
        private static void FindsLostSettings(string[] arguments)
        {
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, BuildTarget.Android);
            var lost = ScriptableObject.CreateInstance<XRGeneralSettingsPerBuildTarget>();
            AssetDatabase.CreateAsset(lost, "Assets/Own/Xr.asset");
            FeatureHelpers.More.Add("com.unity.openxr.feature.meta-display-utilities");
            Tell("after", ProjectSetup.Apply(BuildTarget.Android));
            XRGeneralSettingsPerBuildTarget found;
            EditorBuildSettings.TryGetConfigObject(XRGeneralSettings.k_SettingsKey, out found);
            Say("found", ReferenceEquals(found, lost));
        }
#endif

        private static void NamesWhatIsBroken(string[] arguments)
        {
            BuildTarget target = Target(arguments[0]);
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, target);
            ProjectSetup.Apply(target);
            Flush();
            foreach (Action wrong in target == BuildTarget.Android ? Faults().Concat(QuestFaults()) : Faults().Concat(PcFaults()))
            {
                wrong();
                Tell("fault", ProjectSetup.Check(target));
                Say("left", ProjectSetup.Apply(target).Count);
            }
        }

#if MUA_OPENXR
        private static void KeepsBuiltIn(string[] arguments)
        {
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, BuildTarget.Android);
            Own("Assets/Skin.mat");
            Tell("after", ProjectSetup.Apply(BuildTarget.Android));
            Say("api", OpenXRSettings.GetSettingsForBuildTargetGroup(BuildTargetGroup.Android).foveatedRenderingApi);
        }
#endif

        private static void LacksModule(string[] arguments)
        {
            StandIns.Builds.Modules.Clear();
            Tell("fault", ProjectSetup.Check(BuildTarget.Android));
            Exits(ProjectSetup.PcLink);
            Flush();
            Say("ended", Build.Run(BuildTarget.Android, new[] { "-muaOutput", "/nowhere.apk" }));
        }

        private static void HasOtherPlatform(string[] arguments)
        {
            Process.IsBatchMode = arguments[0] == "batch";
            Exits(ProjectSetup.Quest);
            Say("platform", EditorUserBuildSettings.activeBuildTarget);
        }

        private static void Tells(string[] arguments)
        {
            Process.IsBatchMode = false;
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, BuildTarget.Android);
            ProjectSetup.Apply(BuildTarget.Android);
            StandIns.Console.Lines.Clear();
            ProjectSetup.Tell();
            PlayerSettings.colorSpace = ColorSpace.Gamma;
            ProjectSetup.Tell();
        }

        private static void LacksPackages(string[] arguments)
        {
            Process.IsBatchMode = arguments[0] == "batch";
            Dialogs.Answer = arguments[1] == "yes";
            Packages.Refusal = arguments[2] == "" ? null : arguments[2];
            Own(arguments[3]);
            Tell("fault", ProjectSetup.Check(BuildTarget.Android));
            Exits(ProjectSetup.Quest);
            for (int tick = 0; EditorApplication.update != null && tick < 100; tick++)
            {
                EditorApplication.update();
            }
            Say("asked", string.Join(" ", Packages.Asked));
            Tell("dialog", Dialogs.Shown.Select(text => text.Replace('\n', ' ')));
            Reload();
            Say("resumes", EditorApplication.delayCall == null ? 0 : 1);
        }

        private static void GoesOnAfterReload(string[] arguments)
        {
            Process.IsBatchMode = false;
            SessionState.SetInt("Mua.ProjectSetup.Waiting", (int)BuildTarget.Android);
            Reload();
            EditorApplication.delayCall();
            EditorApplication.delayCall = null;
            Tell("fault", ProjectSetup.Check(BuildTarget.Android));
            Reload();
            Say("resumes", EditorApplication.delayCall == null ? 0 : 1);
        }

        // Platform, what the build does, output, more words.
        private static void Builds(string[] arguments)
        {
            BuildTarget target = Target(arguments[0]);
            EditorUserBuildSettings.SwitchActiveBuildTarget(BuildTargetGroup.Unknown, target);
            PlayerSettings.SetApplicationIdentifier(NamedBuildTarget.Android, "org.example.own");
            EditorUserBuildSettings.buildAppBundle = true;
            StandIns.Builds.Answer = options => Answer(arguments[1], options);
            Say("ended", Build.Run(target, arguments.Skip(2).ToArray()));
            Say("identifier", PlayerSettings.GetApplicationIdentifier(NamedBuildTarget.Android));
            Say("bundle", EditorUserBuildSettings.buildAppBundle);
            Say("player", Build.IsOfPlayer);
            Say("imported", Packages.Imported);
            Say("asked", string.Join(" ", Packages.Asked));
        }

        private static void BringsSample(string[] arguments)
        {
            Packages.Imported = arguments[0] == "imported";
            if (arguments[0] == "absent")
            {
                Packages.Samples.Clear();
            }
            Builds(arguments.Skip(1).ToArray());
        }

        private static void BuildsForOther(string[] arguments)
        {
            Say("ended", Build.Run(BuildTarget.Android, new[] { "-muaOutput", arguments[0] }));
        }

        private static void RunsFromCommandLine(string[] arguments)
        {
            Exits(Build.Quest);
        }

        private static void RunsWithoutModule(string[] arguments)
        {
            StandIns.Builds.Modules.Clear();
            Exits(arguments[0] == "Quest" ? (Action)Build.Quest : Build.PcLink);
        }

        private static BuildSummary Answer(string what, BuildPlayerOptions options)
        {
            Say("scenes", string.Join(" ", options.scenes));
            Say("location", options.locationPathName);
            Say("options", options.options);
            Say("built as", PlayerSettings.GetApplicationIdentifier(NamedBuildTarget.Android));
            Say("built as player", Build.IsOfPlayer);
            File.WriteAllText(options.locationPathName, "whole");
            File.WriteAllText(options.locationPathName + ".symbols.zip", "beside it");
            if (what == "throws")
            {
                throw new InvalidOperationException("out of disk\nand more");
            }
            return what == "fails" ? new BuildSummary(BuildResult.Failed, 7) : new BuildSummary(BuildResult.Succeeded, 0);
        }

        private static IEnumerable<Action> Faults()
        {
            yield return () => PlayerSettings.colorSpace = ColorSpace.Gamma;
            yield return () => GraphicsSettings.defaultRenderPipeline = null;
#if MUA_OPENXR
            BuildTargetGroup group = BuildPipeline.GetBuildTargetGroup(EditorUserBuildSettings.activeBuildTarget);
            XRGeneralSettingsPerBuildTarget xr;
            EditorBuildSettings.TryGetConfigObject(XRGeneralSettings.k_SettingsKey, out xr);
            yield return () => xr.SettingsForBuildTarget(group).Manager = null;
            yield return () => xr.SettingsForBuildTarget(group).InitManagerOnStart = false;
            yield return () => OpenXRSettings.GetSettingsForBuildTargetGroup(group).renderMode = OpenXRSettings.RenderMode.MultiPass;
            foreach (string id in OpenXR.Features.Keys.Where(each => each.StartsWith(group + " ")).ToArray())
            {
                if (group == BuildTargetGroup.Android || id.Contains(".input."))
                {
                    yield return () => OpenXR.Features[id].enabled = false;
                }
            }
            RenderGraphSettings graph;
            GraphicsSettings.TryGetRenderPipelineSettings(out graph);
            yield return () => graph.enableRenderCompatibilityMode = true;
#endif
        }

        private static IEnumerable<Action> PcFaults()
        {
            BuildTarget pc = BuildTarget.StandaloneWindows64;
            yield return () => PlayerSettings.SetUseDefaultGraphicsAPIs(pc, true);
            yield return () => PlayerSettings.SetGraphicsAPIs(pc, new[] { GraphicsDeviceType.Direct3D12, GraphicsDeviceType.Vulkan });
            yield return () => PlayerSettings.runInBackground = false;
        }

        private static IEnumerable<Action> QuestFaults()
        {
            NamedBuildTarget android = NamedBuildTarget.Android;
            yield return () => PlayerSettings.SetScriptingBackend(android, ScriptingImplementation.Mono2x);
            yield return () => PlayerSettings.SetIl2CppCodeGeneration(android, Il2CppCodeGeneration.OptimizeSize);
            yield return () => PlayerSettings.SetManagedStrippingLevel(android, ManagedStrippingLevel.Medium);
            yield return () => PlayerSettings.SetApplicationIdentifier(android, "com.DefaultCompany.Avatars");
            yield return () => PlayerSettings.Android.targetArchitectures = AndroidArchitecture.ARM64 | AndroidArchitecture.ARMv7;
            yield return () => PlayerSettings.Android.minSdkVersion = AndroidSdkVersions.AndroidApiLevel31;
            yield return () => PlayerSettings.Android.targetSdkVersion = AndroidSdkVersions.AndroidApiLevel33;
            yield return () => PlayerSettings.Android.applicationEntry = AndroidApplicationEntry.Activity;
            yield return () => PlayerSettings.defaultInterfaceOrientation = UIOrientation.AutoRotation;
            yield return () => PlayerSettings.SetUseDefaultGraphicsAPIs(BuildTarget.Android, true);
            yield return () => PlayerSettings.SetGraphicsAPIs(BuildTarget.Android, new[] { GraphicsDeviceType.OpenGLES3 });
            yield return () => PlayerSettings.SetMobileMTRendering(android, false);
            yield return () => PlayerSettings.vulkanEnablePreTransform = true;
            yield return () => PlayerSettings.Android.textureCompressionFormats = new[] { TextureCompressionFormat.ETC2 };
            yield return () => EditorUserBuildSettings.androidBuildSubtarget = MobileTextureSubtarget.ETC2;
#if MUA_URP
            OpenXRSettings settings = OpenXRSettings.GetSettingsForBuildTargetGroup(BuildTargetGroup.Android);
            yield return () => settings.foveatedRenderingApi = OpenXRSettings.BackendFovationApi.Legacy;
            yield return () => LateLatch(true);
            yield return () => Used().supportsHDR = true;
            yield return () => Used().msaaSampleCount = 4;
            yield return () => Used().supportsCameraOpaqueTexture = true;
            yield return () => Used().supportsCameraDepthTexture = true;
#else
            yield return () => QualitySettings.antiAliasing = 8;
#endif
        }

#if MUA_URP
        private static void LateLatch(bool value)
        {
            var feature = new SerializedObject(OpenXR.Features["Android com.unity.openxr.feature.metaquest"]);
            feature.FindProperty("lateLatchingMode").boolValue = value;
            feature.ApplyModifiedProperties();
        }

        private static UniversalRenderPipelineAsset Used()
        {
            return (UniversalRenderPipelineAsset)GraphicsSettings.defaultRenderPipeline;
        }
#endif

        private sealed class OtherPipeline : RenderPipelineAsset
        {
        }

        private static void Own(string what)
        {
            if (what == "pipeline")
            {
                GraphicsSettings.defaultRenderPipeline = ScriptableObject.CreateInstance<OtherPipeline>();
            }
            else if (what != "nothing")
            {
                AssetDatabase.CreateAsset(new Material(Shader.Find("Standard")), what);
            }
        }

        private static void Exits(Action entry)
        {
            try
            {
                entry();
                Say("exit", "none");
            }
            catch (OperationCanceledException exit)
            {
                Say("exit", exit.Message);
            }
        }

        private static void Reload()
        {
            typeof(ProjectSetup).GetMethod("Resume", BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, null);
        }

        private static BuildTarget Target(string name)
        {
            return name == "Quest" ? BuildTarget.Android : BuildTarget.StandaloneWindows64;
        }

        private static void Tell(string key, IEnumerable<string> lines)
        {
            foreach (string line in lines)
            {
                Say(key, line);
            }
        }

        private static void Flush()
        {
            foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
            {
                Say("log", line.Key + " " + line.Value.Split('\n')[0]);
            }
            StandIns.Console.Lines.Clear();
        }

        private static void Say(string key, object value)
        {
            System.Console.WriteLine(key + "\t" + value);
        }
    }
}

#if SAMPLE
namespace Mua.Samples.VrPlayer.Editor
{
    public static class PlayerScene
    {
        public static void Create(string path)
        {
            System.Console.WriteLine("scene\t" + path);
        }
    }
}
#endif
