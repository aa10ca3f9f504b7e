using System;
using System.Collections.Generic;
using Mua.Format;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    /// <summary>The clips of an avatar, which of them plays and how far it is.</summary>
    internal sealed class AvatarPlayback
    {
        /// <summary>Playback without clips, for no avatar.</summary>
        public static readonly AvatarPlayback None = new AvatarPlayback(0);

        private readonly ClipSampler[] clips;
        private readonly string[] names;
        private readonly ClipBlend blend; // null for no avatar
        private int index;
        private double seconds;
        private double shown = double.NaN; // seconds of the pose that Sample gave last
        private bool isDriven, isBlended; // by something else than the component
        private double clock; // seconds of what drives a blend
        private int ownIndex; // of what plays by itself, meanwhile
        private double ownSeconds;

        public AvatarPlayback(AvatarFile avatar)
            : this(avatar.Clips.Length)
        {
            blend = new ClipBlend(avatar.Skeleton);
            for (int i = 0; i < clips.Length; i++)
            {
                clips[i] = new ClipSampler(avatar.Clips[i], avatar.Skeleton, avatar.Encoding.Rate);
                names[i] = clips[i].Name;
            }
        }

        private AvatarPlayback(int count)
        {
            clips = new ClipSampler[count];
            names = new string[count];
        }

        public bool IsEmpty => clips.Length == 0;

        public IReadOnlyList<string> Names => names;

        /// <summary>Index of the clip that plays; setting it starts that clip at its beginning.</summary>
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

        /// <summary>Seconds into the clip; 0 where there is none, and for what is no finite number.</summary>
        public double Seconds
        {
            get => seconds;
            set => seconds = IsEmpty || double.IsNaN(value) || double.IsInfinity(value) ? 0 : value;
        }

        /// <summary>Frame of the clip at the avatar's rate; setting it goes to the frame's beginning.</summary>
        public int Frame
        {
            get => IsEmpty ? 0 : (int)clips[index].Position(seconds);
            set => Seconds = IsEmpty ? 0 : value / clips[index].Rate;
        }

        public int FrameCount => IsEmpty ? 0 : clips[index].FrameCount;

        /// <summary>Starts the clip with this name, or else the first; returns whether the name exists.</summary>
        public bool Choose(string name)
        {
            int found = Find(name);
            Index = Math.Max(found, 0);
            return found >= 0;
        }

        /// <summary>Index of the clip with this name; -1 for none.</summary>
        public int Find(string name)
        {
            return Array.IndexOf(names, name);
        }

        /// <summary>Shows a moment of a clip until Release; the clip then goes on that played before.</summary>
        public void Drive(int clip, double moment)
        {
            Take();
            isBlended = false;
            if (clip != index)
            {
                index = clip;
                Forget();
            }
            Seconds = moment;
        }

        /// <summary>
        /// Shows a moment of a clip that goes over into one of another, whose share is from 0 to 1, until Release; `now`: seconds
        /// of a clock that runs along.
        /// </summary>
        public void Drive(int clip, double moment, int other, double otherMoment, double share, double now)
        {
            Drive(clip, moment);
            isBlended = true;
            clock = now;
            blend.Set(clips[clip], moment, clips[other], otherMoment, share);
        }

        /// <summary>Lets the clip go on that played before Drive.</summary>
        public void Release()
        {
            if (isDriven)
            {
                isDriven = isBlended = false;
                index = ownIndex;
                Seconds = ownSeconds;
                Forget();
            }
        }

        /// <summary>Makes the next Sample compute its pose anew.</summary>
        public void Forget()
        {
            shown = double.NaN;
        }

        /// <summary>Advances by so many seconds and poses the avatar; returns whether the pose has changed.</summary>
        public bool Sample(AvatarPose pose, double step)
        {
            if (isBlended)
            {
                Forget();
                return pose.Sample(blend, clock);
            }
            double from = isDriven && !double.IsNaN(shown) ? shown : Seconds;
            Seconds += isDriven ? 0 : step;
            if (Seconds.Equals(shown))
            {
                pose.Rest();
                return false;
            }
            pose.Sample(clips[index], Seconds, isDriven ? Seconds - from : step);
            shown = Seconds;
            return true;
        }

        /// <summary>Remembers what plays by itself.</summary>
        private void Take()
        {
            if (!isDriven)
            {
                isDriven = true;
                ownIndex = index;
                ownSeconds = seconds;
            }
        }
    }
}
