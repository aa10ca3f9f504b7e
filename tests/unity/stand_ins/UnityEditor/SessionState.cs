// Stand-in. Source: Unity 6000.0, EditorGUIUtility.bindings.cs, SessionState.
using System.Collections.Generic;

namespace UnityEditor
{
    public static class SessionState
    {
        private static readonly Dictionary<string, int> values = new Dictionary<string, int>();

        public static void SetInt(string key, int value) { values[key] = value; }
        public static int GetInt(string key, int defaultValue)
        {
            int value;
            return values.TryGetValue(key, out value) ? value : defaultValue;
        }
        public static void EraseInt(string key) { values.Remove(key); }
    }
}
