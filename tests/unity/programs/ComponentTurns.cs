// Stories of several avatars that take turns with their decodes, for ComponentProgram.cs.
using System.Collections.Generic;
using System.IO;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private const int Tight = 13; // milliseconds of a frame, of those that leave no room for more

        /// <summary>
        /// Three that play: what every displayed frame dispatches, what it shows of each and of which of its clip's frames.
        /// </summary>
        private static void TakesTurns()
        {
            Timings.Gpu = Tight;
            Recorder.Start(Path.ChangeExtension(files[0], null) + " turns");
            AvatarRenderer[] shown = { Begin(files[0]), Begin(files[1]), Begin(files[0]) };
            for (int i = 0; i < shown.Length; i++)
            {
                Until(shown[i]);
                shown[i].Frame = 2 * i;
                shown[i].Speed = 0.5f; // so that the clip is longer than a decode may be old
            }
            for (int i = 0; i < 2 * Watched; i++)
            {
                int before = Recorder.Dispatches;
                PlayerLoop.Frame(Step);
                Say("dispatches", Recorder.Dispatches - before);
                foreach (AvatarRenderer one in shown)
                {
                    Say("drawn", one.Decoded.IsShown ? 1 : 0);
                    Say("frame", one.Frame);
                }
                Keep(shown, i);
            }
            foreach (AvatarRenderer one in shown)
            {
                Object.DestroyImmediate(one.gameObject);
            }
            Recorder.Stop();
        }

        /// <summary>Every frame of the clips of two files, each decoded at once.</summary>
        private static void DecodesAlone()
        {
            Recorder.Start(Path.ChangeExtension(files[0], null) + " alone");
            for (int file = 0; file < 2; file++)
            {
                AvatarRenderer shown = Begin(files[file]);
                shown.SpreadDecode = shown.IsPlaying = false;
                Until(shown);
                for (int i = 0; i < shown.FrameCount; i++)
                {
                    shown.Frame = i;
                    PlayerLoop.Frame(Step);
                    Recorder.Keep(shown.Decoded.Mesh, file + " " + i + " mesh");
                    Recorder.Keep(shown.Decoded.TexelChannels, file + " " + i + " texel_channels");
                }
                Say("frames", shown.FrameCount);
                Object.DestroyImmediate(shown.gameObject);
            }
            Recorder.Stop();
        }

        /// <summary>The one whose decode is being made is destroyed, another leaves the view, and they come back.</summary>
        private static void LeavesItsTurn()
        {
            Timings.Gpu = Tight;
            var shown = new List<AvatarRenderer> { Show(files[0]), Show(files[1]), Show(files[0]), Show(files[1]) };
            Frames(6 * ChannelDecoder.Parts + 1); // a decode is being made
            shown[1].transform.position = new Vector3(0, 0, -10000);
            Object.DestroyImmediate(shown[0].gameObject);
            for (int i = 0; i < 12; i++)
            {
                Say("left", Dispatches(1));
            }
            shown[1].transform.position = Vector3.zero;
            for (int i = 0; i < 20; i++)
            {
                Say("back", Dispatches(1));
            }
            Say("states", shown[1].State + " " + shown[2].State + " " + shown[3].State);
        }

        /// <summary>Frames that take too long, then ones with room: splats, and parts in a frame.</summary>
        private static void MeasuresFrames()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            AvatarBudget budget = Make("budget").AddComponent<AvatarBudget>();
            foreach (float milliseconds in new[] { 0f, 11.1f })
            {
                budget.Milliseconds = milliseconds;
                foreach (int taken in new[] { 30, 3 })
                {
                    Timings.Gpu = taken;
                    Frames(1000);
                    Say(milliseconds > 0 ? "limited" : "free", first.SplatCount + second.SplatCount);
                    Say("most", Most(20));
                }
            }
            Timings.Gpu = 0;
            long before = System.GC.GetAllocatedBytesForCurrentThread();
            Frames(100);
            Say("allocated", System.GC.GetAllocatedBytesForCurrentThread() - before);
            budget.Milliseconds = 5;
            Time.timeScale = 0.1f; // in slow motion displayed frames take as long as ever
            Frames(300);
            Time.timeScale = 1;
            Say("limited", first.SplatCount + second.SplatCount);
        }

        /// <summary>Most dispatches of any of so many frames.</summary>
        private static int Most(int frames)
        {
            int most = 0;
            for (int i = 0; i < frames; i++)
            {
                most = System.Math.Max(most, Dispatches(1));
            }
            return most;
        }

        private static void Keep(AvatarRenderer[] shown, int frame)
        {
            for (int i = 0; i < shown.Length; i++)
            {
                Recorder.Keep(shown[i].Decoded.Mesh, i + " " + frame + " mesh");
                Recorder.Keep(shown[i].Decoded.TexelChannels, i + " " + frame + " texel_channels");
            }
        }
    }
}
