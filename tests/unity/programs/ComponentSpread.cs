// Stories of decodes that are spread over displayed frames, for ComponentProgram.cs: each tells what every displayed frame
// dispatches, and keeps the channels and the mesh that it shows, first with the spread on and then with it off.
using System;
using System.IO;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private const int Watched = 24; // displayed frames
        private const float Fast = 1f / 71, Slower = 1f / 51, Slow = 1f / 31; // seconds of one, of which no number is a frame of the avatar

        private static Rig posing;

        private static void SpreadsClip()
        {
            Watch(Step, shown => shown.Speed = 25f / 24, null);
        }

        private static void SpreadsForTwoCameras()
        {
            Make("second camera").AddComponent<Camera>();
            Watch(Step, null, null);
        }

        private static void SpreadsBackwards()
        {
            Watch(Step, shown => shown.Speed = -1, null);
        }

        private static void SpreadsOnSlowDisplay()
        {
            Watch(Slow, null, null);
        }

        private static void SpreadsOverSeeks()
        {
            Watch(Step, null, (shown, i) =>
            {
                shown.Frame = i == 8 ? 4 : shown.Frame;
                shown.IsPlaying = i < 12 || i > 16;
                shown.Seconds += i == 14 ? 0.1 : 0;
            });
        }

        /// <summary>Another level of detail in each moment of a decode that is made for a pose to come.</summary>
        private static void SpreadsOverLevels()
        {
            Watch(Step, null, (shown, i) => shown.Level = i / 4 % 2 == 0 || i > 15 ? AvatarLevel.Full : AvatarLevel.Quarter);
        }

        /// <summary>Levels that change in every moment of a decode, on a display that lacks the time to spread all of it.</summary>
        private static void SpreadsOverLevelsOnSlowerDisplay()
        {
            Watch(Slower, null, (shown, i) => shown.Level = i / 5 % 2 == 0 ? AvatarLevel.Full : AvatarLevel.Quarter);
        }

        /// <summary>A face that moves in every displayed frame, of an avatar that stands still.</summary>
        private static void SpreadsFace()
        {
            Watch(Fast, shown => shown.IsPlaying = false, (shown, i) => shown.SetExpression("jawOpen", i / (float)Watched));
        }

        private static void SpreadsRig()
        {
            Watch(Fast, FollowRig, TurnRig);
        }

        private static void SpreadsRigOnSlowDisplay()
        {
            Watch(Slow, FollowRig, TurnRig);
        }

        private static void SpreadsRigThatIsNotSeen()
        {
            Camera camera = UnityEngine.Object.FindAnyObjectByType<Camera>();
            Watch(Fast, FollowRig, (shown, i) =>
            {
                TurnRig(shown, i);
                camera.enabled = i < 4 || i > 9; // a decode has begun in frame 3
            });
        }

        private static void FollowRig(AvatarRenderer shown)
        {
            shown.Rig = posing.Root;
        }

        private static void TurnRig(AvatarRenderer shown, int i)
        {
            posing.Last.localRotation = Quaternion.Euler(0, 5 * i, 0);
        }

        private static void Watch(float step, Action<AvatarRenderer> begin, Action<AvatarRenderer, int> move)
        {
            foreach (bool spreads in new[] { true, false })
            {
                string label = spreads ? "spread" : "at once";
                Recorder.Start(Path.ChangeExtension(files[0], null) + " " + label);
                posing = new Rig();
                AvatarRenderer shown = Begin(files[0]);
                shown.SpreadDecode = spreads;
                Until(shown);
                begin?.Invoke(shown);
                for (int i = 0; i < Watched; i++)
                {
                    move?.Invoke(shown, i);
                    int before = Recorder.Dispatches;
                    PlayerLoop.Frame(step);
                    Say(label, Recorder.Dispatches - before);
                    Say("outside " + label, shown.OutsideTraining);
                    Say("splats " + label, shown.SplatCount);
                    Recorder.Keep(shown.Decoded.Mesh, i + " mesh");
                    Recorder.Keep(shown.Decoded.TexelChannels, i + " texel_channels");
                }
                string names = Recorder.AliveNames();
                Say("sets", names.Split(new[] { "texel_channels" }, StringSplitOptions.None).Length - 1);
                UnityEngine.Object.DestroyImmediate(shown.gameObject);
                Recorder.Stop();
            }
        }
    }
}
