using System;
using System.Collections.Generic;
using Mua.Format;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    /// <summary>The clips of an avatar, which of them plays and how far it is; without an avatar it has none.</summary>
    internal sealed class AvatarPlayback
    {
        private ClipSampler[] clips = new ClipSampler[0];
        private string[] names = new string[0];
        private int index;
        private double shown = double.NaN; // seconds of the pose that Sample gave last

        public bool IsEmpty => clips.Length == 0;

        public IReadOnlyList<string> Names => names;

        /// <summary>Of the clip that plays; setting it starts that clip at its beginning.</summary>
        public int Index
        {
            get => index;
            set
            {
                index = IsEmpty ? 0 : Mathf.Clamp(value, 0, clips.Length - 1);
                Seconds = 0;
                Forget();
            }
        }

        /// <summary>Seconds into the clip.</summary>
        public double Seconds { get; set; }

        /// <summary>At the avatar's rate; setting it goes to the frame's beginning.</summary>
        public int Frame
        {
            get => IsEmpty ? 0 : (int)AvatarPose.Position(clips[index], Seconds);
            set => Seconds = IsEmpty ? 0 : value / clips[index].Rate;
        }

        public int FrameCount => IsEmpty ? 0 : clips[index].FrameCount;

        /// <summary>Takes an avatar's clips in place of those it had.</summary>
        public void Take(AvatarFile avatar)
        {
            clips = new ClipSampler[avatar.Clips.Length];
            names = new string[clips.Length];
            for (int i = 0; i < clips.Length; i++)
            {
                clips[i] = new ClipSampler(avatar.Clips[i], avatar.Skeleton, avatar.Encoding.Rate);
                names[i] = clips[i].Name;
            }
        }

        public void Clear()
        {
            clips = new ClipSampler[0];
            names = new string[0];
        }

        /// <summary>Starts the clip of that name, or the first; whether there is one of that name.</summary>
        public bool Choose(string name)
        {
            int found = Array.IndexOf(names, name);
            Index = Math.Max(found, 0);
            return found >= 0;
        }

        /// <summary>Has the next Sample give its pose anew.</summary>
        public void Forget()
        {
            shown = double.NaN;
        }

        /// <summary>Goes on by so many seconds and poses the avatar; whether the pose is another than before.</summary>
        public bool Sample(AvatarPose pose, double step)
        {
            Seconds += step;
            if (Seconds.Equals(shown))
            {
                return false;
            }
            pose.Sample(clips[index], Seconds);
            shown = Seconds;
            return true;
        }
    }
}
