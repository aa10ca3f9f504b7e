// Stand-in. Source: Unity 6000.0, DragAndDrop, DragAndDropService.cs, InitializeOnLoadMethod.
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum DragAndDropVisualMode { None = 0, Copy = 1, Link = 2, Move = 16, Generic = 4, Rejected = 32 }

    [Flags]
    public enum HierarchyDropFlags { None = 0, DropUpon = 1, DropBetween = 2, DropAfterParent = 4, SearchActive = 8 }

    public static class DragAndDrop
    {
#if UNITY_6000_3_OR_NEWER
        public delegate DragAndDropVisualMode HierarchyDropHandlerV2(
            EntityId dropTargetEntityId, HierarchyDropFlags dropMode, Transform parentForDraggedObjects, bool perform);

        public static void AddDropHandlerV2(HierarchyDropHandlerV2 handler) { }
#else
        public delegate DragAndDropVisualMode HierarchyDropHandler(
            int dropTargetInstanceID, HierarchyDropFlags dropMode, Transform parentForDraggedObjects, bool perform);

        internal static HierarchyDropHandler RowHandler;

        public static void AddDropHandler(HierarchyDropHandler handler) { RowHandler = handler; }
#endif

        public delegate DragAndDropVisualMode SceneDropHandler(
            Object dropUpon, Vector3 worldPosition, Vector2 viewportPosition, Transform parentForDraggedObjects, bool perform);

        internal static SceneDropHandler Handler;

        public static Object[] objectReferences { get; set; }

#if UNITY_6000_3_OR_NEWER
        public static void AddDropHandlerV2(SceneDropHandler handler) { Handler = handler; }
        [Obsolete("Use AddDropHandlerV2 instead")]
#endif
        public static void AddDropHandler(SceneDropHandler handler) { Handler = handler; }
    }
}

namespace StandIns
{
    /// <summary>Drops into the scene view. Not part of Unity's API.</summary>
    public static class Drag
    {
#if !UNITY_6000_3_OR_NEWER
        /// <summary>Into the Hierarchy, upon the row of an object or above it.</summary>
        public static UnityEditor.DragAndDropVisualMode DropOnRow(GameObject row, bool upon, Transform above, Object dragged)
        {
            UnityEditor.DragAndDrop.objectReferences = new[] { dragged };
            var flags = upon ? UnityEditor.HierarchyDropFlags.DropUpon : UnityEditor.HierarchyDropFlags.DropBetween;
            UnityEditor.EditorUtility.Rows = new Object[] { null, row };
            return UnityEditor.DragAndDrop.RowHandler(row == null ? 0 : 1, flags, above, true);
        }
#endif

        public static UnityEditor.DragAndDropVisualMode Drop(Vector3 position, bool perform, params Object[] dragged)
        {
            UnityEditor.DragAndDrop.objectReferences = dragged;
            return UnityEditor.DragAndDrop.Handler(null, position, new Vector2(), null, perform);
        }
    }
}
