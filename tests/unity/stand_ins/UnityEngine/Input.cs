// Stand-in. Source: Unity 6000.0, Input.bindings.cs, KeyCode; a test presses the keys.
using System.Collections.Generic;

namespace UnityEngine
{
    public enum KeyCode
    {
        None = 0, Backspace = 8, Space = 32, Comma = 44, Period = 46, Alpha0 = 48, Alpha1, Alpha2, Alpha3, Alpha4, Alpha5, LeftBracket = 91,
        RightBracket = 93, A = 97, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T, U, V, W, X, Y, Z, UpArrow = 273, DownArrow,
        RightArrow, LeftArrow, PageUp = 280, PageDown
    }

    public static class Input
    {
        private static readonly Dictionary<KeyCode, string> Names = new Dictionary<KeyCode, string>();
        private static readonly string[] Buttons = { "Mouse0", "Mouse1", "Mouse2" };

        static Input()
        {
            foreach (KeyCode key in System.Enum.GetValues(typeof(KeyCode)))
                Names[key] = key.ToString().Replace("Alpha", "Digit");
        }

        public static Vector3 mousePositionDelta { get { return StandIns.Keys.Drag; } }
        public static Vector2 mouseScrollDelta { get { return new Vector2(0, StandIns.Keys.Scroll); } }
        public static bool GetKey(KeyCode key) { return StandIns.Keys.IsHeld(Names[key]); }
        public static bool GetKeyDown(KeyCode key) { return StandIns.Keys.WentDown(Names[key]); }
        public static bool GetMouseButton(int button) { return StandIns.Keys.IsHeld(Buttons[button]); }
    }
}
