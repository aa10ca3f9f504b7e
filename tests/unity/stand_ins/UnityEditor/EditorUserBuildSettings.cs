// Stand-in. Source: Unity 6000.0, EditorUserBuildSettings.bindings.cs, EditorBuildSettings.bindings.cs.
using System.Collections.Generic;

namespace UnityEditor
{
    public enum MobileTextureSubtarget { Generic = 0, DXT = 1, PVRTC = 2, ETC = 4, ETC2 = 5, ASTC = 6 }

    public static class EditorUserBuildSettings
    {
        static EditorUserBuildSettings()
        {
            androidBuildSubtarget = MobileTextureSubtarget.ETC2;
            activeBuildTarget = BuildTarget.StandaloneLinux64;
        }

        public static MobileTextureSubtarget androidBuildSubtarget { get; set; }
        public static BuildTarget activeBuildTarget { get; private set; }
        public static bool buildAppBundle { get; set; }
        public static bool exportAsGoogleAndroidProject { get; set; }
        public static bool SwitchActiveBuildTarget(BuildTargetGroup targetGroup, BuildTarget target)
        {
            activeBuildTarget = target;
            return true;
        }
    }

    public static class EditorBuildSettings
    {
        private static readonly Dictionary<string, UnityEngine.Object> objects = new Dictionary<string, UnityEngine.Object>();

        public static void AddConfigObject(string name, UnityEngine.Object obj, bool overwrite)
        {
            if (AssetDatabase.GetAssetPath(obj).Length == 0)
                throw new System.Exception("Cannot add non-persisted config object with name '" + name + "'.");
            objects[name] = obj;
        }
        public static bool TryGetConfigObject<T>(string name, out T result) where T : UnityEngine.Object
        {
            UnityEngine.Object found;
            objects.TryGetValue(name, out found);
            result = found as T;
            return result != null;
        }
    }
}
