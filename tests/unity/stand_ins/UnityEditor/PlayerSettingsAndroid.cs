// Stand-in. Source: Unity 6000.0, PlayerSettingsAndroid.bindings.cs; values of a new project.
using System;

namespace UnityEditor
{
    [Flags]
    public enum AndroidArchitecture : uint { None = 0, ARMv7 = 1, ARM64 = 2, X86_64 = 8, All = 0xffffffff }

    public enum AndroidSdkVersions
    {
        AndroidApiLevelAuto = 0, AndroidApiLevel23 = 23, AndroidApiLevel28 = 28, AndroidApiLevel29 = 29, AndroidApiLevel31 = 31,
        AndroidApiLevel32 = 32, AndroidApiLevel33 = 33, AndroidApiLevel34 = 34, AndroidApiLevel35 = 35
    }

    [Flags]
    public enum AndroidApplicationEntry : uint { Activity = 1, GameActivity = 2 }

    public sealed partial class PlayerSettings
    {
        public static class Android
        {
            static Android()
            {
                minSdkVersion = AndroidSdkVersions.AndroidApiLevel23;
                targetSdkVersion = AndroidSdkVersions.AndroidApiLevelAuto;
                targetArchitectures = AndroidArchitecture.ARMv7;
                applicationEntry = AndroidApplicationEntry.Activity;
                textureCompressionFormats = new[] { TextureCompressionFormat.ETC2 };
            }

            public static AndroidSdkVersions minSdkVersion { get; set; }
            public static AndroidSdkVersions targetSdkVersion { get; set; }
            public static AndroidArchitecture targetArchitectures { get; set; }
            public static AndroidApplicationEntry applicationEntry { get; set; }
            public static TextureCompressionFormat[] textureCompressionFormats { get; set; }
        }
    }
}
