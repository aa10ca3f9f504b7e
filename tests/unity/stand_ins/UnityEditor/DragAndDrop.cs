// Stand-in. Source: Unity 6000.0, DragAndDrop, DragAndDropService.cs, InitializeOnLoadMethod.
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum DragAndDropVisualMode { None = 0, Copy = 1, Link = 2, Move = 16, Generic = 4, Rejected = 32 }

    public static class DragAndDrop
    {
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
        public static UnityEditor.DragAndDropVisualMode Drop(Vector3 position, bool perform, params Object[] dragged)
        {
            UnityEditor.DragAndDrop.objectReferences = dragged;
            return UnityEditor.DragAndDrop.Handler(null, position, new Vector2(), null, perform);
        }
    }
}
