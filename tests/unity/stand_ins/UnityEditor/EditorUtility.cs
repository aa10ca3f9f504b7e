// Stand-in. Source: Unity 6000.0 scripting reference, EditorUtility; a test answers its dialogs.
using System.Collections.Generic;

namespace UnityEditor
{
    public static class EditorUtility
    {
        public static bool DisplayDialog(string title, string message, string ok) { return DisplayDialog(title, message, ok, ""); }
        public static bool DisplayDialog(string title, string message, string ok, string cancel)
        {
            StandIns.Dialogs.Shown.Add(message);
            return StandIns.Dialogs.Answer;
        }
#if UNITY_6000_3_OR_NEWER
        public static UnityEngine.Object EntityIdToObject(UnityEngine.EntityId entityId) { return null; }
#else
        internal static UnityEngine.Object[] Rows = new UnityEngine.Object[1]; // objects by the ids that drops have

        public static UnityEngine.Object InstanceIDToObject(int instanceID) { return Rows[instanceID]; }
#endif
        public static void SetDirty(UnityEngine.Object target) { StandIns.Dialogs.Dirtied.Add(target.GetType().Name); }
    }
}

namespace StandIns
{
    /// <summary>What was asked, and the answer to it all. Not part of Unity's API.</summary>
    public static class Dialogs
    {
        public static readonly List<string> Shown = new List<string>();
        public static bool Answer = true;
        public static readonly List<string> Dirtied = new List<string>(); // kinds of what was marked to be saved
        public static readonly List<string> Saved = new List<string>(); // and of what was saved then
    }
}
