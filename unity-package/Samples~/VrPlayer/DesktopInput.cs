#if ENABLE_INPUT_SYSTEM && MUA_INPUT_SYSTEM
#define MUA_NEW_INPUT
#endif
using UnityEngine;
#if MUA_NEW_INPUT
using UnityEngine.InputSystem;
using KeyName = UnityEngine.InputSystem.Key;
#else
using KeyName = UnityEngine.KeyCode;
#endif

namespace Mua.Samples.VrPlayer
{
    /// <summary>Keyboard and mouse, by whichever of Unity's input systems the project has switched on.</summary>
    internal sealed class DesktopInput
    {
        private const float DegreesPerPixel = 0.15f;
        private const float ZoomOfNotch = 8; // frames of zooming at full speed

        private static readonly KeyName[] Keys =
        {
            KeyName.Space, KeyName.Period, KeyName.Comma, KeyName.RightBracket, KeyName.LeftBracket, KeyName.PageDown,
            KeyName.PageUp, KeyName.Backspace, KeyName.H,
#if MUA_NEW_INPUT
            KeyName.Digit1, KeyName.Digit2, KeyName.Digit3, KeyName.Digit4, KeyName.Digit5,
#else
            KeyName.Alpha1, KeyName.Alpha2, KeyName.Alpha3, KeyName.Alpha4, KeyName.Alpha5,
#endif
        };

        private static readonly PlayerAction[] Actions = // in the order of Keys
        {
            PlayerAction.PlayPause, PlayerAction.NextFrame, PlayerAction.PreviousFrame, PlayerAction.NextClip,
            PlayerAction.PreviousClip, PlayerAction.NextAvatar, PlayerAction.PreviousAvatar, PlayerAction.Reset,
            PlayerAction.Help, PlayerAction.Splats, PlayerAction.Geometry, PlayerAction.Template, PlayerAction.Skeleton,
            PlayerAction.Shadow,
        };

        /// <summary>Adds what keyboard and mouse ask for; nothing where there are none.</summary>
        public void Read(ref PlayerIntents intents)
        {
#if MUA_NEW_INPUT || ENABLE_LEGACY_INPUT_MANAGER
            for (int i = 0; i < Keys.Length; i++)
            {
                intents.Pressed |= WentDown(Keys[i]) ? Actions[i] : PlayerAction.None;
            }
            intents.Walk += new Vector2(Between(KeyName.A, KeyName.D), Between(KeyName.S, KeyName.W));
            intents.Rise += Between(KeyName.F, KeyName.R);
            intents.Turn += Between(KeyName.Q, KeyName.E);
            intents.Scrub += Between(KeyName.LeftArrow, KeyName.RightArrow);
            intents.Zoom += Between(KeyName.DownArrow, KeyName.UpArrow) + ZoomOfNotch * Notches();
            intents.Look += DegreesPerPixel * Drag();
#endif
        }

        private static float Between(KeyName less, KeyName more)
        {
            return (IsDown(more) ? 1 : 0) - (IsDown(less) ? 1 : 0);
        }

#if MUA_NEW_INPUT
        private static bool WentDown(KeyName key)
        {
            return Keyboard.current != null && Keyboard.current[key].wasPressedThisFrame;
        }

        private static bool IsDown(KeyName key)
        {
            return Keyboard.current != null && Keyboard.current[key].isPressed;
        }

        /// <summary>Direction of the mouse wheel, 1, 0 or -1; its unit differs between platforms.</summary>
        private static float Notches()
        {
            float scroll = Mouse.current == null ? 0 : Mouse.current.scroll.ReadValue().y;
            return scroll > 0 ? 1 : scroll < 0 ? -1 : 0;
        }

        /// <summary>Pixels that the mouse moved with its right button held.</summary>
        private static Vector2 Drag()
        {
            Mouse mouse = Mouse.current;
            return mouse != null && mouse.rightButton.isPressed ? mouse.delta.ReadValue() : Vector2.zero;
        }
#elif ENABLE_LEGACY_INPUT_MANAGER
        private static bool WentDown(KeyName key)
        {
            return Input.GetKeyDown(key);
        }

        private static bool IsDown(KeyName key)
        {
            return Input.GetKey(key);
        }

        /// <summary>Direction of the mouse wheel, 1, 0 or -1; its unit differs between platforms.</summary>
        private static float Notches()
        {
            float scroll = Input.mouseScrollDelta.y;
            return scroll > 0 ? 1 : scroll < 0 ? -1 : 0;
        }

        /// <summary>Pixels that the mouse moved with its right button held.</summary>
        private static Vector2 Drag()
        {
            return Input.GetMouseButton(1) ? (Vector2)Input.mousePositionDelta : Vector2.zero;
        }
#endif
    }
}
