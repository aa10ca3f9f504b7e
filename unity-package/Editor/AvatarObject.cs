using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>Makes GameObjects that show an avatar; undo takes them back.</summary>
    internal static class AvatarObject
    {
        private const string Plain = "MUA Avatar"; // the name of one that shows nothing yet

        /// <summary>An AvatarRenderer at `position` below `parent`, either of which may be null, as is `asset`.</summary>
        public static GameObject Create(AvatarAsset asset, Transform parent, Vector3 position)
        {
            var made = new GameObject(asset == null ? Plain : asset.name);
            if (parent != null)
            {
                GameObjectUtility.SetParentAndAlign(made, parent.gameObject);
            }
            else
            {
                StageUtility.PlaceGameObjectInCurrentStage(made); // a prefab may be open
            }
            GameObjectUtility.EnsureUniqueNameForSibling(made);
            made.transform.position = position;
            var shown = made.AddComponent<AvatarRenderer>();
            if (asset != null)
            {
                shown.Load(asset);
            }
            Undo.RegisterCreatedObjectUndo(made, "Create " + made.name);
            return made;
        }

        /// <summary>The selected avatar, or else the first of the project that can be shown; null where there is none.</summary>
        public static AvatarAsset Find()
        {
            if (Selection.activeObject is AvatarAsset selected && selected.Fault.Length == 0)
            {
                return selected;
            }
            foreach (string guid in AssetDatabase.FindAssets("t:" + nameof(AvatarAsset)))
            {
                var asset = AssetDatabase.LoadAssetAtPath<AvatarAsset>(AssetDatabase.GUIDToAssetPath(guid));
                if (asset != null && asset.Fault.Length == 0)
                {
                    return asset;
                }
            }
            return null;
        }
    }
}
