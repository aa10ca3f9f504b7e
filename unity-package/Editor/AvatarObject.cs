using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>Makes GameObjects that show an avatar, by menu or where one is dropped; undo takes them back.</summary>
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

        [MenuItem("GameObject/MUA Avatar", false, 10)] // among the kinds of objects
        private static void Create(MenuCommand command)
        {
            var parent = command.context as GameObject;
            Transform below = parent == null ? null : parent.transform;
            Vector3 at = parent == null ? Vector3.zero : below.position;
            Selection.activeObject = Create(Find(), below, at);
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

        [InitializeOnLoadMethod]
        private static void Register()
        {
#if UNITY_6000_3_OR_NEWER
            DragAndDrop.AddDropHandlerV2(Drop);
#else
            DragAndDrop.AddDropHandler(Drop);
#endif
        }

        private static DragAndDropVisualMode Drop(
            Object dropUpon, Vector3 worldPosition, Vector2 viewportPosition, Transform parentForDraggedObjects,
            bool perform)
        {
            Object[] dragged = DragAndDrop.objectReferences;
            if (dragged.Length != 1 || !(dragged[0] is AvatarAsset asset))
            {
                return DragAndDropVisualMode.None;
            }
            if (perform)
            {
                Selection.activeObject = AvatarObject.Create(asset, parentForDraggedObjects, worldPosition);
            }
            return DragAndDropVisualMode.Copy;
        }
    }
}
