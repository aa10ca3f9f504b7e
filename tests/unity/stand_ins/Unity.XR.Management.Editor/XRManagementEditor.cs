// Stand-in. Source: com.unity.xr.management 4.6, XRGeneralSettingsPerBuildTarget.cs, XRPackageMetadataStore.cs.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityEngine.XR.Management;

namespace UnityEditor.XR.Management
{
    public class XRGeneralSettingsPerBuildTarget : ScriptableObject
    {
        private readonly Dictionary<BuildTargetGroup, XRGeneralSettings> settings = new Dictionary<BuildTargetGroup, XRGeneralSettings>();

        public XRGeneralSettings SettingsForBuildTarget(BuildTargetGroup targetGroup)
        {
            XRGeneralSettings found;
            settings.TryGetValue(targetGroup, out found);
            return found;
        }
        public XRManagerSettings ManagerSettingsForBuildTarget(BuildTargetGroup targetGroup)
        {
            return HasSettingsForBuildTarget(targetGroup) ? SettingsForBuildTarget(targetGroup).Manager : null;
        }
        public bool HasSettingsForBuildTarget(BuildTargetGroup buildTargetGroup) { return SettingsForBuildTarget(buildTargetGroup) != null; }
        public bool HasManagerSettingsForBuildTarget(BuildTargetGroup targetGroup) { return ManagerSettingsForBuildTarget(targetGroup) != null; }
        public void CreateDefaultSettingsForBuildTarget(BuildTargetGroup buildTargetGroup)
        {
            settings[buildTargetGroup] = CreateInstance<XRGeneralSettings>();
            AssetDatabase.AddObjectToAsset(settings[buildTargetGroup], AssetDatabase.GetAssetPath(this));
        }
        public void CreateDefaultManagerSettingsForBuildTarget(BuildTargetGroup targetGroup)
        {
            settings[targetGroup].Manager = CreateInstance<XRManagerSettings>();
        }
    }
}

namespace UnityEditor.XR.Management.Metadata
{
    public static class XRPackageMetadataStore
    {
        public static bool AssignLoader(XRManagerSettings settings, string loaderTypeName, BuildTargetGroup buildTargetGroup)
        {
            Type type = Type.GetType(loaderTypeName + ", Unity.XR.OpenXR");
            if (!settings.activeLoaders.Any(each => each.GetType() == type))
                settings.TryAddLoader((XRLoader)ScriptableObject.CreateInstance(type));
            return true;
        }
    }
}
