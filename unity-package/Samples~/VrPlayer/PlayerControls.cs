using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    /// <summary>Moves user and avatar as the user asks; VrPlayer chooses which avatar is shown.</summary>
    internal sealed class PlayerControls
    {
        private const float TurnSpeed = 90; // degrees a second
        private const float ScrubSpeed = 2; // seconds of the clip in each

        private readonly AvatarRenderer shown;
        private readonly PlayerRig rig;
        private readonly HeadPose head;
        private readonly GameObject help;
        private readonly Quaternion facing; // the avatar's initial rotation

        public PlayerControls(AvatarRenderer shown, PlayerRig rig, HeadPose head, GameObject help)
        {
            this.shown = shown;
            this.rig = rig;
            this.head = head;
            this.help = help;
            facing = shown.transform.rotation;
        }

        /// <summary>Applies the input of a frame that took so many seconds.</summary>
        public void Apply(in PlayerIntents intents, float seconds)
        {
            Press(intents.Pressed);
            if (!head.IsTracked && intents.Look != Vector2.zero)
            {
                rig.Look(intents.Look);
            }
            rig.Walk(intents.Walk, intents.Rise, seconds);
            rig.Approach(shown.transform.position, intents.Zoom, seconds);
            shown.transform.Rotate(0, intents.Turn * TurnSpeed * seconds, 0);
            if (intents.Scrub != 0)
            {
                shown.IsPlaying = false;
                shown.Seconds += intents.Scrub * ScrubSpeed * seconds;
            }
        }

        private void Press(PlayerAction pressed)
        {
            if (pressed == PlayerAction.None)
            {
                return;
            }
            shown.IsPlaying ^= Has(pressed, PlayerAction.PlayPause);
            StepFrame(One(pressed, PlayerAction.NextFrame) - One(pressed, PlayerAction.PreviousFrame));
            StepClip(One(pressed, PlayerAction.NextClip) - One(pressed, PlayerAction.PreviousClip));
            AvatarViews changed = Switched(pressed);
            if (changed != AvatarViews.None)
            {
                shown.Views ^= changed;
            }
            if (Has(pressed, PlayerAction.Help))
            {
                help.SetActive(!help.activeSelf);
            }
            if (Has(pressed, PlayerAction.Reset))
            {
                rig.Reset(head.IsTracked);
                shown.transform.rotation = facing;
            }
        }

        private void StepFrame(int by)
        {
            int count = shown.FrameCount;
            if (by != 0 && count > 0)
            {
                shown.IsPlaying = false;
                shown.Frame = (shown.Frame + by + count) % count;
            }
        }

        private void StepClip(int by)
        {
            int count = shown.Clips.Count;
            if (by != 0 && count > 0)
            {
                shown.ClipIndex = (shown.ClipIndex + by + count) % count;
            }
        }

        private static AvatarViews Switched(PlayerAction pressed)
        {
            return (Has(pressed, PlayerAction.Splats) ? AvatarViews.Splats : 0)
                | (Has(pressed, PlayerAction.Geometry) ? AvatarViews.Geometry : 0)
                | (Has(pressed, PlayerAction.Template) ? AvatarViews.Template : 0)
                | (Has(pressed, PlayerAction.Skeleton) ? AvatarViews.Skeleton : 0)
                | (Has(pressed, PlayerAction.Shadow) ? AvatarViews.Shadow : 0);
        }

        private static bool Has(PlayerAction pressed, PlayerAction action)
        {
            return (pressed & action) != 0;
        }

        private static int One(PlayerAction pressed, PlayerAction action)
        {
            return Has(pressed, action) ? 1 : 0;
        }
    }
}
