// Stand-in. Source: Unity 6000.0 scripting reference, Selection, Undo, MenuCommand, GameObjectUtility, SceneAsset, SceneView.
using System.Collections.Generic;
using UnityEngine;

namespace UnityEditor
{
    public static class Selection { public static Object activeObject { get; set; } }

    public static class Undo
    {
        public static void RegisterCreatedObjectUndo(Object objectToUndo, string name) { StandIns.Undone.Created.Add(name); }
    }

    public sealed class MenuCommand
    {
        public Object context;

        public MenuCommand(Object inContext) { context = inContext; }
    }

    public static class GameObjectUtility
    {
        public static void SetParentAndAlign(GameObject child, GameObject parent)
        {
            child.transform.SetParent(parent.transform, false);
            child.transform.SetLocalPositionAndRotation(Vector3.zero, Quaternion.identity);
        }
        public static void EnsureUniqueNameForSibling(GameObject self) { }
    }

    public class SceneAsset : Object { }

    public class SceneView { public static void RepaintAll() { } }
}

namespace StandIns
{
    /// <summary>What undo would take back. Not part of Unity's API.</summary>
    public static class Undone
    {
        public static readonly List<string> Created = new List<string>();
    }
}
