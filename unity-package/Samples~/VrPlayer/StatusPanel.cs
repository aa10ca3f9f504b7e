using System;
using System.Globalization;
using System.Text;
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
        private readonly StringBuilder text = new StringBuilder();
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
            last = text.ToString();
            target.text = last;
            elapsed = 0;
            frames = 0;
        }

        public void Dispose()
        {
            times.Dispose();
        }

        private void AddRates(double seconds)
        {
            text.Append(Number(1 / seconds, "F0")).Append(" fps   ").Append(Number(1000 * seconds, "F1")).Append(" ms a frame   ");
            text.Append(Number(times.OfFrame(), "F1")).Append(" ms GPU\n");
            if (display.Rate > 0)
            {
                text.Append("display ").Append(Number(display.Rate, "F0")).Append(" Hz, ");
                text.Append(Number(display.WantedRate, "F0")).Append(" wanted   foveation ");
                text.Append(Number(display.Foveation, "F2")).Append('\n');
            }
        }

        private void AddStages()
        {
            text.Append('\n').Append(times.IsOfGpu ? "ms on the GPU" : "ms of recording, on the CPU").Append('\n');
            for (int i = 0; i < times.Names.Count; i++)
            {
                text.Append(times.Names[i]).Append(' ').Append(Number(times.Of(i), "F2")).Append(i % 3 == 2 ? "\n" : "   ");
            }
        }

        private void AddAvatar()
        {
            AvatarEntry entry = shelf.Current;
            if (entry == null)
            {
                return;
            }
            text.Append("\navatar ").Append(shelf.Position + 1).Append('/').Append(shelf.Count).Append("   ").Append(entry.Name).Append('\n');
            if (shown.State == AvatarState.Loading)
            {
                text.Append("loading ").Append(Number(100 * shown.Progress, "F0")).Append(" %\n");
            }
            else if (shown.State == AvatarState.Ready)
            {
                AddClip();
                text.Append("outside of training ").Append(Number(100 * shown.OutsideTraining, "F0")).Append(" %\n");
            }
            AddViews();
        }

        private void AddClip()
        {
            if (shown.FrameCount == 0)
            {
                text.Append("no clip\n");
                return;
            }
            text.Append("clip ").Append(shown.ClipIndex + 1).Append('/').Append(shown.Clips.Count).Append("   ");
            text.Append(shown.Clips[shown.ClipIndex]).Append('\n');
            text.Append("frame ").Append(shown.Frame + 1).Append('/').Append(shown.FrameCount);
            text.Append(shown.IsPlaying ? "   playing\n" : "   paused\n");
        }

        private void AddViews()
        {
            text.Append("shown:");
            for (int i = 0; i < ViewNames.Length; i++)
            {
                if (((int)shown.Views & (1 << i)) != 0)
                {
                    text.Append(' ').Append(ViewNames[i]);
                }
            }
            text.Append('\n');
        }

        private void AddMessages(string message)
        {
            if (message.Length > 0)
            {
                AddWrapped(message);
            }
            if (shown.State == AvatarState.Ready && shown.Message.Length > 0)
            {
                AddWrapped(shown.Message);
            }
        }

        /// <summary>Below an empty line, in lines of at most Columns characters, parted at spaces where there are any.</summary>
        private void AddWrapped(string message)
        {
            text.Append('\n');
            int start = 0;
            while (message.Length - start > Columns)
            {
                int space = message.LastIndexOf(' ', start + Columns, Columns);
                int end = space > start ? space : start + Columns;
                text.Append(message, start, end - start).Append('\n');
                start = space > start ? space + 1 : end;
            }
            text.Append(message, start, message.Length - start).Append('\n');
        }

        /// <summary>A dash where nothing is known.</summary>
        private static string Number(double value, string format)
        {
            return value >= 0 && value < int.MaxValue ? value.ToString(format, CultureInfo.InvariantCulture) : "-";
        }
    }
}
