// Stand-in. Source: com.unity.inputsystem 1.14, Keyboard, Mouse and their controls.
using System.Collections.Generic;
using UnityEngine.InputSystem.Controls;

namespace UnityEngine.InputSystem
{
    public enum Key
    {
        None, Space, Enter, Tab, Backquote, Quote, Semicolon, Comma, Period, Slash, Backslash, LeftBracket, RightBracket, Minus, Equals,
        A, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T, U, V, W, X, Y, Z, Digit1, Digit2, Digit3, Digit4, Digit5,
        LeftArrow = 61, RightArrow, UpArrow, DownArrow, Backspace, PageDown, PageUp
    }

    public class Keyboard
    {
        private readonly Dictionary<Key, KeyControl> keys = new Dictionary<Key, KeyControl>();

        private Keyboard()
        {
            foreach (Key key in System.Enum.GetValues(typeof(Key)))
                keys[key] = new KeyControl(key.ToString());
        }

        public static Keyboard current { get; private set; }
        public KeyControl this[Key key] { get { return keys[key]; } }

        static Keyboard() { current = new Keyboard(); }
    }

    public class Mouse
    {
        public static Mouse current { get; private set; }
        public ButtonControl rightButton { get; private set; }
        public DeltaControl delta { get; private set; }
        public DeltaControl scroll { get; private set; }

        static Mouse()
        {
            current = new Mouse { rightButton = new ButtonControl("Mouse1"), delta = new DeltaControl(false), scroll = new DeltaControl(true) };
        }
    }
}

namespace UnityEngine.InputSystem.Controls
{
    public class ButtonControl
    {
        private readonly string key;

        internal ButtonControl(string key) { this.key = key; }

        public bool isPressed { get { return StandIns.Keys.IsHeld(key); } }
        public bool wasPressedThisFrame { get { return StandIns.Keys.WentDown(key); } }
    }

    public class KeyControl : ButtonControl { internal KeyControl(string key) : base(key) { } }

    public class DeltaControl
    {
        private readonly bool wheel;

        internal DeltaControl(bool wheel) { this.wheel = wheel; }

        public Vector2 ReadValue() { return wheel ? new Vector2(0, 120 * StandIns.Keys.Scroll) : StandIns.Keys.Drag; }
    }
}
