// Stand-in. Source: Unity 6000.0, PlayerSettings.bindings.cs, PlayerSettingsVulkan.bindings.cs; values of a new project.
using System.Collections.Generic;
using UnityEditor.Build;
using UnityEngine;
using UnityEngine.Rendering;

namespace UnityEditor
{
    public enum ScriptingImplementation { Mono2x = 0, IL2CPP = 1 }
    public enum ManagedStrippingLevel { Disabled = 0, Low = 1, Medium = 2, High = 3, Minimal = 4 }
    public enum UIOrientation { Portrait = 0, PortraitUpsideDown = 1, LandscapeRight = 2, LandscapeLeft = 3, AutoRotation = 4 }
    public enum TextureCompressionFormat { Unknown = 0, ETC = 1, ETC2 = 2, ASTC = 3 }

    public sealed partial class PlayerSettings : UnityEngine.Object
    {
        private static readonly Dictionary<string, object> kept = new Dictionary<string, object>();

        static PlayerSettings()
        {
            defaultInterfaceOrientation = UIOrientation.AutoRotation;
            vulkanEnablePreTransform = true;
        }

        public static ColorSpace colorSpace { get; set; }
        public static bool runInBackground { get; set; }
        public static bool vulkanEnablePreTransform { get; set; }
        public static UIOrientation defaultInterfaceOrientation { get; set; }

        public static ScriptingImplementation GetScriptingBackend(NamedBuildTarget buildTarget)
        {
            return Get("backend " + buildTarget.TargetName, ScriptingImplementation.Mono2x);
        }
        public static void SetScriptingBackend(NamedBuildTarget buildTarget, ScriptingImplementation backend)
        {
            kept["backend " + buildTarget.TargetName] = backend;
        }
        public static Il2CppCodeGeneration GetIl2CppCodeGeneration(NamedBuildTarget buildTarget)
        {
            return Get("code " + buildTarget.TargetName, Il2CppCodeGeneration.OptimizeSize);
        }
        public static void SetIl2CppCodeGeneration(NamedBuildTarget buildTarget, Il2CppCodeGeneration value)
        {
            kept["code " + buildTarget.TargetName] = value;
        }
        public static ManagedStrippingLevel GetManagedStrippingLevel(NamedBuildTarget buildTarget)
        {
            return Get("stripping " + buildTarget.TargetName, ManagedStrippingLevel.High);
        }
        public static void SetManagedStrippingLevel(NamedBuildTarget buildTarget, ManagedStrippingLevel level)
        {
            kept["stripping " + buildTarget.TargetName] = level;
        }
        public static string applicationIdentifier { get { return GetApplicationIdentifier(UnityEditor.Build.NamedBuildTarget.Android); } }
        public static string GetApplicationIdentifier(NamedBuildTarget buildTarget)
        {
            return Get("identifier " + buildTarget.TargetName, "com.DefaultCompany.Avatars");
        }
        public static void SetApplicationIdentifier(NamedBuildTarget buildTarget, string identifier)
        {
            kept["identifier " + buildTarget.TargetName] = identifier;
        }
        public static bool GetMobileMTRendering(NamedBuildTarget buildTarget)
        {
            return Get("threads " + buildTarget.TargetName, false);
        }
        public static void SetMobileMTRendering(NamedBuildTarget buildTarget, bool enable)
        {
            kept["threads " + buildTarget.TargetName] = enable;
        }
        public static bool GetUseDefaultGraphicsAPIs(BuildTarget platform) { return Get("automatic " + platform, true); }
        public static void SetUseDefaultGraphicsAPIs(BuildTarget platform, bool automatic) { kept["automatic " + platform] = automatic; }
        public static GraphicsDeviceType[] GetGraphicsAPIs(BuildTarget platform)
        {
            return Get("apis " + platform, new[] { GraphicsDeviceType.Vulkan, GraphicsDeviceType.OpenGLES3 });
        }
        public static void SetGraphicsAPIs(BuildTarget platform, GraphicsDeviceType[] apis) { kept["apis " + platform] = apis; }

        private static T Get<T>(string key, T fresh)
        {
            object found;
            return kept.TryGetValue(key, out found) ? (T)found : fresh;
        }
    }
}

namespace UnityEditor.Build
{
    public enum Il2CppCodeGeneration { OptimizeSpeed = 0, OptimizeSize = 1 }
}
