// Stand-in. Source: com.unity.xr.openxr 1.17, FeatureHelpers.cs, MetaQuestFeature.cs; features of Unity's own package that this one names.
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;

namespace UnityEditor.XR.OpenXR.Features
{
    public static class FeatureHelpers
    {
        private class Feature : OpenXRFeature { }

        private sealed class MetaQuestFeature : Feature { internal bool lateLatchingMode = true; } // a new one has it off

        private const string MetaQuest = "com.unity.openxr.feature.metaquest";

        private static readonly string[] ids =
        {
            MetaQuest, "com.unity.openxr.feature.foveatedrendering", "com.unity.openxr.feature.input.oculustouch",
            "com.unity.openxr.feature.input.metaquestplus"
        };

        public static readonly List<string> More = new List<string>(); // of other packages; a test's

        public static void RefreshFeatures(BuildTargetGroup group)
        {
            if (StandIns.OpenXR.Settings.ContainsKey(group))
                return;
            StandIns.OpenXR.Settings[group] = ScriptableObject.CreateInstance<OpenXRSettings>();
            foreach (string id in ids.Concat(More))
                StandIns.OpenXR.Features[group + " " + id] = id == MetaQuest
                    ? ScriptableObject.CreateInstance<MetaQuestFeature>() : ScriptableObject.CreateInstance<Feature>();
        }
        public static OpenXRFeature GetFeatureWithIdForBuildTarget(BuildTargetGroup buildTargetGroup, string featureId)
        {
            OpenXRFeature found;
            StandIns.OpenXR.Features.TryGetValue(buildTargetGroup + " " + featureId, out found);
            return found;
        }
    }
}
