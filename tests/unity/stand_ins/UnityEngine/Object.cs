// Stand-in. Source: Unity 6000.0 scripting reference, Object, ScriptableObject, HideFlags, TextAsset.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
#if UNITY_6000_3_OR_NEWER
    public struct EntityId { }

#endif
    [Flags]
    public enum HideFlags
    {
        None = 0, HideInHierarchy = 1, HideInInspector = 2, DontSaveInEditor = 4, NotEditable = 8, DontSaveInBuild = 16,
        DontUnloadUnusedAsset = 32, DontSave = 52, HideAndDontSave = 61
    }

#if UNITY_6000_4_OR_NEWER
    [Obsolete("FindObjectsSortMode has been deprecated.", false)]
#endif
    public enum FindObjectsSortMode { None, InstanceID }

    public enum FindObjectsInactive { Exclude, Include }

    public class Object
    {
        private static int lastId;
        private readonly int id = ++lastId;
        internal bool destroyed;

        public virtual string name { get; set; } // virtual only here: a component has its GameObject's
        public HideFlags hideFlags { get; set; }

        public Object() { name = ""; }

        public override string ToString() { return name + " (" + GetType().FullName + ")"; }
        public override bool Equals(object other) { return Same(this, other as Object); }
        public override int GetHashCode() { return id; }
        public static bool operator ==(Object a, Object b) { return Same(a, b); }
        public static bool operator !=(Object a, Object b) { return !Same(a, b); }
        public static implicit operator bool(Object exists) { return !Same(exists, null); }

        /// <summary>At the end of the frame in Unity; here at once, which is the harder case.</summary>
        public static void Destroy(Object obj) { DestroyImmediate(obj); }
        public static void Destroy(Object obj, float t) { DestroyImmediate(obj); }
        public static void DestroyImmediate(Object obj)
        {
            if (ReferenceEquals(obj, null) || obj.destroyed)
                return;
            obj.OnDestroyed();
            obj.destroyed = true;
        }
        public static void DestroyImmediate(Object obj, bool allowDestroyingAssets) { DestroyImmediate(obj); }
        public static void DontDestroyOnLoad(Object target) { }
        public static T FindAnyObjectByType<T>() where T : Object
        {
            T[] found = Find<T>(FindObjectsInactive.Exclude);
            return found.Length > 0 ? found[0] : null;
        }
#if UNITY_6000_4_OR_NEWER
        public static T[] FindObjectsByType<T>(FindObjectsInactive findObjectsInactive) where T : Object { return Find<T>(findObjectsInactive); }
        [Obsolete("FindObjectsByType with FindObjectsSortMode parameter has been deprecated.", false)]
#endif
        public static T[] FindObjectsByType<T>(FindObjectsInactive findObjectsInactive, FindObjectsSortMode sortMode) where T : Object { return Find<T>(findObjectsInactive); }

#if UNITY_6000_4_OR_NEWER
        [Obsolete("FindObjectsByType with FindObjectsSortMode parameter has been deprecated.", false)]
#endif
        public static T[] FindObjectsByType<T>(FindObjectsSortMode sortMode) where T : Object { return Find<T>(FindObjectsInactive.Exclude); }

        private static T[] Find<T>(FindObjectsInactive inactive) where T : Object
        {
            List<T> found = new List<T>();
            foreach (GameObject gameObject in GameObject.All)
                foreach (Component component in gameObject.Components)
                    if (component is T && (gameObject.activeInHierarchy || inactive == FindObjectsInactive.Include))
                        found.Add((T)(Object)component);
            return found.ToArray();
        }

        internal virtual void OnDestroyed() { }

        private static bool Same(Object a, Object b)
        {
            bool noA = ReferenceEquals(a, null) || a.destroyed, noB = ReferenceEquals(b, null) || b.destroyed;
            return noA || noB ? noA == noB : ReferenceEquals(a, b);
        }
    }

    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject { return (T)CreateInstance(typeof(T)); }
        public static ScriptableObject CreateInstance(Type type)
        {
            ScriptableObject made = (ScriptableObject)Activator.CreateInstance(type, true);
            StandIns.Messages.Send(made, "Awake");
            StandIns.Messages.Send(made, "OnEnable");
            return made;
        }

        internal override void OnDestroyed()
        {
            StandIns.Messages.Send(this, "OnDisable");
            StandIns.Messages.Send(this, "OnDestroy");
        }
    }
}

namespace UnityEngine
{
    public static class Resources
    {
        internal static readonly Dictionary<string, Object> Placed = new Dictionary<string, Object>();
        internal static int Asked;

        public static T Load<T>(string path) where T : Object
        {
            Object found;
            Asked++;
            return Placed.TryGetValue(path, out found) ? found as T : null;
        }
        public static T GetBuiltinResource<T>(string path) where T : Object { return Load<T>(path); }
    }
}
