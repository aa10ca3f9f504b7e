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
            DragAndDrop.AddDropHandlerV2(DropOnScene);
            DragAndDrop.AddDropHandlerV2(DropOnHierarchy);
#else
            DragAndDrop.AddDropHandler(DropOnScene);
            DragAndDrop.AddDropHandler(DropOnHierarchy);
#endif
        }

        private static DragAndDropVisualMode DropOnScene(
            Object dropUpon, Vector3 worldPosition, Vector2 viewportPosition, Transform parentForDraggedObjects,
            bool perform)
        {
            return Drop(parentForDraggedObjects, worldPosition, perform);
        }

#if UNITY_6000_3_OR_NEWER
        private static DragAndDropVisualMode DropOnHierarchy(
            EntityId target, HierarchyDropFlags flags, Transform parentForDraggedObjects, bool perform)
        {
            return DropOnRow(EditorUtility.EntityIdToObject(target), flags, parentForDraggedObjects, perform);
        }
#else
        private static DragAndDropVisualMode DropOnHierarchy(
            int target, HierarchyDropFlags flags, Transform parentForDraggedObjects, bool perform)
        {
            return DropOnRow(EditorUtility.InstanceIDToObject(target), flags, parentForDraggedObjects, perform);
        }
#endif

        /// <summary>Below the object of a row, or beside it where the drop is between rows; `above` is set in a prefab.</summary>
        private static DragAndDropVisualMode DropOnRow(Object row, HierarchyDropFlags flags, Transform above, bool perform)
        {
            Transform parent = above;
            if (row is GameObject target)
            {
                bool isUpon = (flags & HierarchyDropFlags.DropUpon) != 0;
                Transform beside = target.transform.parent == null ? above : target.transform.parent;
                parent = isUpon ? target.transform : beside;
            }
            return Drop(parent, parent == null ? Vector3.zero : parent.position, perform);
        }

        private static DragAndDropVisualMode Drop(Transform parent, Vector3 position, bool perform)
        {
            Object[] dragged = DragAndDrop.objectReferences;
            if (dragged.Length != 1 || !(dragged[0] is AvatarAsset asset))
            {
                return DragAndDropVisualMode.None;
            }
            if (perform)
            {
                Selection.activeObject = Create(asset, parent, position);
            }
            return DragAndDropVisualMode.Copy;
        }
    }
}
