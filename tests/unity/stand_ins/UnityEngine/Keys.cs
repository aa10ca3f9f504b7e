// Keyboard and mouse for both of Unity's input systems, by the names of Key. Not part of Unity's API: for test programs only.
using System.Collections.Generic;
using UnityEngine;

namespace StandIns
{
    public static class Keys
    {
        private static readonly Dictionary<string, int> Since = new Dictionary<string, int>(); // frame of Time

        public static Vector2 Drag { get; set; } // pixels
        public static float Scroll { get; set; }

        /// <summary>Down from the next frame on.</summary>
        public static void Press(string key) { Since[key] = Time.frameCount + 1; }
        public static void Release(string key) { Since.Remove(key); }

        public static bool IsHeld(string key)
        {
            int since;
            return Since.TryGetValue(key, out since) && Time.frameCount >= since;
        }
        public static bool WentDown(string key)
        {
            int since;
            return Since.TryGetValue(key, out since) && Time.frameCount == since;
        }
    }
}
