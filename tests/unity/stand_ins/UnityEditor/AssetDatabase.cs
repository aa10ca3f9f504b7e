// Stand-in. Source: Unity 6000.0 scripting reference, AssetDatabase; a test places assets.
using System.Collections.Generic;

namespace UnityEditor
{
    public static class AssetDatabase
    {
        public static void Refresh() { }
        public static void SaveAssets() { StandIns.Dialogs.Saved.AddRange(StandIns.Dialogs.Dirtied); }
        public static void CreateAsset(UnityEngine.Object asset, string path)
        {
            asset.name = System.IO.Path.GetFileNameWithoutExtension(path);
            StandIns.Project.Assets[path] = asset;
        }
        public static void AddObjectToAsset(UnityEngine.Object objectToAdd, string path) { StandIns.Project.Assets[path + "#" + objectToAdd.name] = objectToAdd; }
        public static string GetAssetPath(UnityEngine.Object assetObject)
        {
            foreach (KeyValuePair<string, UnityEngine.Object> asset in StandIns.Project.Assets)
                if (asset.Value == assetObject)
                    return asset.Key.Split('#')[0];
            return "";
        }
        public static bool IsValidFolder(string path) { return StandIns.Project.Folders.Contains(path); }
        public static string CreateFolder(string parentFolder, string newFolderName)
        {
            if (!IsValidFolder(parentFolder))
                return "";
            StandIns.Project.Folders.Add(parentFolder + "/" + newFolderName);
            return "guid of " + parentFolder + "/" + newFolderName;
        }
        public static string[] FindAssets(string filter, string[] searchInFolders)
        {
            return System.Array.FindAll(FindAssets(filter), guid => GUIDToAssetPath(guid).StartsWith(searchInFolders[0] + "/"));
        }
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
        public static readonly HashSet<string> Folders = new HashSet<string> { "Assets" };
        public static readonly Dictionary<string, UnityEngine.Object> Assets = new Dictionary<string, UnityEngine.Object>();
    }
}
