// Stand-in. Source: com.unity.xr.openxr 1.18, FeatureHelpers.cs; features of Unity's own package that this one names.
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;

namespace UnityEditor.XR.OpenXR.Features
{
    public static class FeatureHelpers
    {
        private sealed class Feature : OpenXRFeature { }

        private static readonly string[] ids =
        {
            "com.unity.openxr.feature.metaquest", "com.unity.openxr.feature.input.oculustouch",
            "com.unity.openxr.feature.input.metaquestplus"
        };

        public static readonly List<string> More = new List<string>(); // of other packages; a test's

        public static void RefreshFeatures(BuildTargetGroup group)
        {
            if (StandIns.OpenXR.Settings.ContainsKey(group))
                return;
            StandIns.OpenXR.Settings[group] = ScriptableObject.CreateInstance<OpenXRSettings>();
            foreach (string id in ids.Concat(More))
                StandIns.OpenXR.Features[group + " " + id] = ScriptableObject.CreateInstance<Feature>();
        }
        public static OpenXRFeature GetFeatureWithIdForBuildTarget(BuildTargetGroup buildTargetGroup, string featureId)
        {
            OpenXRFeature found;
            StandIns.OpenXR.Features.TryGetValue(buildTargetGroup + " " + featureId, out found);
            return found;
        }
    }
}
