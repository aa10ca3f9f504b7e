using System;
using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    /// <summary>What the user reads beside the avatar: rates, milliseconds by stage, what plays, and what is wrong.</summary>
    internal sealed class StatusPanel : IDisposable
    {
        private const float Interval = 0.5f; // seconds between two texts
        private const int Columns = 56; // of a message

        private static readonly string[] ViewNames = { "splats", "geometry", "template", "skeleton", "shadow" }; // by bit

        private readonly TextMesh target;
        private readonly AvatarRenderer shown;
        private readonly AvatarShelf shelf;
        private readonly HeadsetDisplay display;
        private readonly StageTimes times = new StageTimes();
        private readonly PanelText text = new PanelText();
        private string last = "";
        private float elapsed; // seconds since the last text
        private int frames; // in these

        public StatusPanel(TextMesh target, AvatarRenderer shown, AvatarShelf shelf, HeadsetDisplay display)
        {
            this.target = target;
            this.shown = shown;
            this.shelf = shelf;
            this.display = display;
        }

        /// <summary>Counts a frame that took so many seconds; `message` is the player's own line.</summary>
        public void Count(float seconds, string message)
        {
            FrameTimingManager.CaptureFrameTimings();
            elapsed += seconds;
            frames++;
            if (elapsed < Interval && last.Length > 0)
            {
                return;
            }
            display.Refresh();
            times.Attach();
            text.Clear();
            AddRates(elapsed / frames);
            AddStages();
            AddAvatar();
            AddMessages(message);
            if (!text.Same(last))
            {
                last = text.ToString();
                target.text = last;
            }
            elapsed = 0;
            frames = 0;
        }

        public void Dispose()
        {
            times.Dispose();
        }

        private void AddRates(double seconds)
        {
            text.Add(1 / seconds, 0).Add(" fps   ").Add(1000 * seconds, 1).Add(" ms a frame   ");
            text.Add(times.OfFrame(), 1).Add(" ms GPU").Line();
            if (display.Rate > 0)
            {
                text.Add("display ").Add(display.Rate, 0).Add(" Hz, ").Add(display.WantedRate, 0).Add(" wanted   foveation ");
                text.Add(display.Foveation, 2).Line();
            }
        }

        private void AddStages()
        {
            text.Line().Add(times.IsOfGpu ? "ms on the GPU" : "ms of recording, on the CPU").Line();
            for (int i = 0; i < times.Names.Count; i++)
            {
                text.Add(times.Names[i]).Add(" ").Add(times.Of(i), 2).Add(i % 3 == 2 ? "\n" : "   ");
            }
        }

        private void AddAvatar()
        {
            AvatarEntry entry = shelf.Current;
            if (entry == null)
            {
                return;
            }
            text.Line().Add("avatar ").Add(shelf.Position + 1).Add("/").Add(shelf.Count).Add("   ").Add(entry.Name).Line();
            if (shown.State == AvatarState.Loading)
            {
                text.Add("loading ").Add(100 * shown.Progress, 0).Add(" %").Line();
            }
            else if (shown.State == AvatarState.Ready)
            {
                AddClip();
                text.Add("outside of training ").Add(100 * shown.OutsideTraining, 0).Add(" %").Line();
            }
            AddViews();
        }

        private void AddClip()
        {
            if (shown.FrameCount == 0)
            {
                text.Add("no clip").Line();
                return;
            }
            text.Add("clip ").Add(shown.ClipIndex + 1).Add("/").Add(shown.Clips.Count).Add("   ");
            text.Add(shown.Clips[shown.ClipIndex]).Line();
            text.Add("frame ").Add(shown.Frame + 1).Add("/").Add(shown.FrameCount);
            text.Add(shown.IsPlaying ? "   playing" : "   paused").Line();
        }

        private void AddViews()
        {
            text.Add("shown:");
            for (int i = 0; i < ViewNames.Length; i++)
            {
                if (((int)shown.Views & (1 << i)) != 0)
                {
                    text.Add(" ").Add(ViewNames[i]);
                }
            }
            text.Line();
        }

        private void AddMessages(string message)
        {
            if (message.Length > 0)
            {
                text.Line().Wrap(message, Columns).Line();
            }
            if (shown.State == AvatarState.Ready && shown.Message.Length > 0)
            {
                text.Line().Wrap(shown.Message, Columns).Line();
            }
        }
    }
}
