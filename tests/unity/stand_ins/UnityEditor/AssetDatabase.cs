// Stand-in. Source: Unity 6000.0 scripting reference, AssetDatabase; a test places assets.
using System.Collections.Generic;

namespace UnityEditor
{
    public static class AssetDatabase
    {
        public static void Refresh() { }
        public static void SaveAssets() { }
        public static void CreateAsset(UnityEngine.Object asset, string path) { StandIns.Project.Assets[path] = asset; }
        public static string[] FindAssets(string filter)
        {
            List<string> found = new List<string>();
            foreach (KeyValuePair<string, UnityEngine.Object> asset in StandIns.Project.Assets)
                if (filter == "t:" + asset.Value.GetType().Name)
                    found.Add("guid of " + asset.Key);
            return found.ToArray();
        }
        public static string GUIDToAssetPath(string guid) { return guid.Substring("guid of ".Length); }
        public static T LoadAssetAtPath<T>(string assetPath) where T : UnityEngine.Object
        {
            UnityEngine.Object found;
            return StandIns.Project.Assets.TryGetValue(assetPath, out found) ? found as T : null;
        }
    }
}

namespace StandIns
{
    /// <summary>Assets by path. Not part of Unity's API.</summary>
    public static class Project
    {
        public static readonly Dictionary<string, UnityEngine.Object> Assets = new Dictionary<string, UnityEngine.Object>();
    }
}
