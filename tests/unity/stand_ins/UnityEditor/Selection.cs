// Stand-in. Source: Unity 6000.0 scripting reference, Selection, Undo, MenuCommand, GameObjectUtility, SceneAsset, SceneView.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using Object = UnityEngine.Object;

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
        public static void EnsureUniqueNameForSibling(GameObject self)
        {
            string stem = self.name;
            Transform parent = self.transform.parent;
            Func<Transform, bool> isTwin = at => at.parent == parent && at.gameObject != self && at.name == self.name;
#pragma warning disable 0618 // deprecated from 6000.4 on
            for (int number = 1; Object.FindObjectsByType<Transform>(FindObjectsSortMode.None).Any(isTwin); number++)
                self.name = stem + " (" + number + ")";
#pragma warning restore 0618
        }
    }

    [Flags]
    public enum GizmoType { Pickable = 1, NotInSelectionHierarchy = 2, NonSelected = 32, Selected = 4, Active = 8, InSelectionHierarchy = 16 }

    public sealed class DrawGizmo : Attribute { public DrawGizmo(GizmoType gizmo) { } }

    public class SceneAsset : Object { }

    public class SceneView { public static void RepaintAll() { StandIns.Asked.Repaints++; } }
}

namespace StandIns
{
    /// <summary>What an editor that does not play was asked to do. Not part of Unity's API.</summary>
    public static class Asked
    {
        public static int Updates, Repaints;
    }

    /// <summary>What undo would take back. Not part of Unity's API.</summary>
    public static class Undone
    {
        public static readonly List<string> Created = new List<string>();

        /// <summary>Objects that were placed in the stage that is open, the scene or a prefab.</summary>
        public static readonly List<string> Staged = new List<string>();
    }
}
