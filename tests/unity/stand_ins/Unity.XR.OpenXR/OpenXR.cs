// Stand-in. Source: com.unity.xr.openxr 1.17, OpenXRSettings.cs, OpenXRRenderSettings.cs, OpenXRFeature.cs.
using System.Collections.Generic;
using UnityEditor;
using UnityEngine.XR.Management;

namespace UnityEngine.XR.OpenXR
{
    public class OpenXRLoader : XRLoader { }

    public class OpenXRSettings : ScriptableObject
    {
        public enum RenderMode { MultiPass, SinglePassInstanced }
        public enum BackendFovationApi : byte { Legacy = 0, SRPFoveation = 1 }

        public RenderMode renderMode { get; set; }
        public BackendFovationApi foveatedRenderingApi { get; set; }
        public static OpenXRSettings GetSettingsForBuildTargetGroup(BuildTargetGroup buildTargetGroup)
        {
            OpenXRSettings found;
            StandIns.OpenXR.Settings.TryGetValue(buildTargetGroup, out found);
            return found;
        }
    }
}

namespace UnityEngine.XR.OpenXR.Features
{
    public abstract class OpenXRFeature : ScriptableObject { public bool enabled { get; set; } }
}

namespace StandIns
{
    /// <summary>Settings and features by platform, which Unity keeps in an asset. Not part of its API.</summary>
    public static class OpenXR
    {
        public static readonly Dictionary<BuildTargetGroup, UnityEngine.XR.OpenXR.OpenXRSettings> Settings =
            new Dictionary<BuildTargetGroup, UnityEngine.XR.OpenXR.OpenXRSettings>();
        public static readonly Dictionary<string, UnityEngine.XR.OpenXR.Features.OpenXRFeature> Features =
            new Dictionary<string, UnityEngine.XR.OpenXR.Features.OpenXRFeature>();
    }
}
