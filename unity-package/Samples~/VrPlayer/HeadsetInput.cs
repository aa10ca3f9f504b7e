using UnityEngine;
using UnityEngine.XR;

namespace Mua.Samples.VrPlayer
{
    /// <summary>A button of a controller and what it does.</summary>
    internal struct HeadsetButton
    {
        public XRNode Hand;
        public InputFeatureUsage<bool> Usage;
        public PlayerAction Plain;

        /// <summary>What it does while the left grip is held.</summary>
        public PlayerAction Shifted;
    }

    /// <summary>
    /// Two tracked controllers. The left grip, held, turns the buttons into switches of what is shown; the right grip, held,
    /// turns the right stick into a scrubber.
    /// </summary>
    internal sealed class HeadsetInput
    {
        private const float DeadZone = 0.15f; // of a stick's way

        private static readonly HeadsetButton[] Buttons =
        {
            Right(CommonUsages.primaryButton, PlayerAction.PlayPause, PlayerAction.Splats),
            Right(CommonUsages.secondaryButton, PlayerAction.NextClip, PlayerAction.Geometry),
            Right(CommonUsages.triggerButton, PlayerAction.NextFrame, PlayerAction.Shadow),
            Right(CommonUsages.primary2DAxisClick, PlayerAction.Reset, PlayerAction.Reset),
            Left(CommonUsages.primaryButton, PlayerAction.PreviousAvatar, PlayerAction.Template),
            Left(CommonUsages.secondaryButton, PlayerAction.NextAvatar, PlayerAction.Skeleton),
            Left(CommonUsages.triggerButton, PlayerAction.PreviousFrame, PlayerAction.PreviousClip),
            Left(CommonUsages.primary2DAxisClick, PlayerAction.Help, PlayerAction.Help),
            Left(CommonUsages.menuButton, PlayerAction.Help, PlayerAction.Help),
        };

        private int held; // a bit for each of Buttons

        /// <summary>Adds what the controllers ask for; nothing where there are none.</summary>
        public void Read(ref PlayerIntents intents)
        {
            InputDevice left = InputDevices.GetDeviceAtXRNode(XRNode.LeftHand);
            InputDevice right = InputDevices.GetDeviceAtXRNode(XRNode.RightHand);
            intents.Pressed |= Press(left, right, IsHeld(left, CommonUsages.gripButton));
            intents.Walk += Stick(left);
            Vector2 stick = Stick(right);
            if (IsHeld(right, CommonUsages.gripButton))
            {
                intents.Scrub += stick.x;
                return;
            }
            intents.Turn += stick.x;
            intents.Zoom += stick.y;
        }

        private PlayerAction Press(InputDevice left, InputDevice right, bool isShifted)
        {
            PlayerAction pressed = PlayerAction.None;
            int before = held;
            held = 0;
            for (int i = 0; i < Buttons.Length; i++)
            {
                HeadsetButton button = Buttons[i];
                if (!IsHeld(button.Hand == XRNode.LeftHand ? left : right, button.Usage))
                {
                    continue;
                }
                held |= 1 << i;
                if ((before & (1 << i)) == 0)
                {
                    pressed |= isShifted ? button.Shifted : button.Plain;
                }
            }
            return pressed;
        }

        private static Vector2 Stick(InputDevice device)
        {
            device.TryGetFeatureValue(CommonUsages.primary2DAxis, out Vector2 value);
            return new Vector2(Beyond(value.x), Beyond(value.y));
        }

        /// <summary>An axis's way beyond the dead zone, -1 to 1; by itself, so that a turn does not bleed into the zoom.</summary>
        private static float Beyond(float value)
        {
            float way = Mathf.Max(0, Mathf.Abs(value) - DeadZone) / (1 - DeadZone);
            return Mathf.Sign(value) * Mathf.Min(way, 1);
        }

        private static bool IsHeld(InputDevice device, InputFeatureUsage<bool> usage)
        {
            return device.TryGetFeatureValue(usage, out bool value) && value;
        }

        private static HeadsetButton Left(InputFeatureUsage<bool> usage, PlayerAction plain, PlayerAction shifted)
        {
            return new HeadsetButton { Hand = XRNode.LeftHand, Usage = usage, Plain = plain, Shifted = shifted };
        }

        private static HeadsetButton Right(InputFeatureUsage<bool> usage, PlayerAction plain, PlayerAction shifted)
        {
            return new HeadsetButton { Hand = XRNode.RightHand, Usage = usage, Plain = plain, Shifted = shifted };
        }
    }
}
