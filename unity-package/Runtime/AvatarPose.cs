using System;
using Mua.Format;
using Mua.Motion;

namespace Mua
{
    /// <summary>
    /// What an avatar is doing: the windows of poses, at the avatar's own rate, that it is decoded from, and the pose of this
    /// moment, in which it is drawn. Numbers tell windows apart; those of a clip are known before they are due.
    /// </summary>
    internal sealed class AvatarPose
    {
        private const double FrameSlack = 1e-6; // frames; a time that was a frame's own stays in it
        private const int LongestGap = 4; // frames without a pose after which the window starts anew
        private const double LongestLag = 1.1; // frames in which a late window is shown; displayed frames vary a little
        private const double LongestForeseen = 3; // frames within which a clip comes to its next one, unless it plays slowly
        private const long Windows = 1L << 32; // more than there are of one motion

        private readonly Skeleton skeleton;
        private readonly int frames;
        private readonly double rate;
        private readonly double[] window; // [k, J, 4] newest first
        private readonly double[] windowTranslations; // [k, J, 3]
        private readonly double[] current; // [J, 4]
        private readonly double[] currentTranslations; // [J, 3]
        private readonly double[] start; // [J, 4] of the clip's frame
        private readonly double[] startTranslations; // [J, 3]
        private readonly double[] decoded; // [J, 4] newest of the last decode
        private readonly double[] next; // [J, 4]
        private readonly double[] nextTranslations; // [J, 3]
        private readonly float[] weights; // [E] of the window
        private ClipSampler clip; // of the window; null where it is of a live source
        private IPoseSource live; // null where a clip, or nothing, gives the pose
        private int index = -1; // frame of the clip
        private long first; // number of the first window of a motion
        private double newest; // seconds; of the window's newest pose of a live source
        private double sampled; // seconds; of the last sample of a live source
        private int rested; // newest poses of the window that are the live source's pose of this moment
        private double now, expressed = double.NegativeInfinity; // seconds; since when weights have waited for a frame
        private long known; // window at the last Express
        private bool started;
        private bool isHeld;

        public AvatarPose(AvatarFile avatar)
        {
            skeleton = avatar.Skeleton;
            frames = avatar.Encoding.Window;
            rate = avatar.Encoding.Rate;
            window = new double[4 * frames * skeleton.JointCount];
            windowTranslations = new double[3 * frames * skeleton.JointCount];
            current = new double[4 * skeleton.JointCount];
            currentTranslations = new double[3 * skeleton.JointCount];
            start = new double[4 * skeleton.JointCount];
            startTranslations = new double[3 * skeleton.JointCount];
            decoded = new double[4 * skeleton.JointCount];
            next = new double[4 * skeleton.JointCount];
            nextTranslations = new double[3 * skeleton.JointCount];
            weights = new float[avatar.ExpressionCount];
            Expressions = new AvatarExpressions(avatar);
        }

        /// <summary>[k, J, 4] local rotations, newest first.</summary>
        public ReadOnlySpan<double> Window => window;

        /// <summary>[k, J, 3] local translations, metres.</summary>
        public ReadOnlySpan<double> WindowTranslations => windowTranslations;

        /// <summary>[E] weights of expressions of the window that was read last.</summary>
        public ReadOnlySpan<float> Weights => weights;

        /// <summary>Weights that were set in place of the clip's.</summary>
        public AvatarExpressions Expressions { get; }

        /// <summary>[J, 4] local rotations of this moment.</summary>
        public ReadOnlySpan<double> Current => current;

        /// <summary>[J, 3] local translations of this moment, metres.</summary>
        public ReadOnlySpan<double> CurrentTranslations => currentTranslations;

        /// <summary>The window of this moment.</summary>
        public long Due { get; private set; }

        /// <summary>The window to decode before it is due; Due where none is foreseen.</summary>
        public long Following { get; private set; }

        /// <summary>Whether a decode of Due that takes some displayed frames is late by no more than a frame of the avatar.</summary>
        public bool MayLag { get; private set; }

        /// <summary>Largest angle by which a joint has turned since the window that was marked, radians.</summary>
        public double Turned
        {
            get
            {
                double least = 1; // cosine of half the angle
                for (int i = 0; i < current.Length; i += 4)
                {
                    double cosine = current[i] * decoded[i] + current[i + 1] * decoded[i + 1]
                        + current[i + 2] * decoded[i + 2] + current[i + 3] * decoded[i + 3];
                    least = Math.Min(least, Math.Abs(cosine));
                }
                return 2 * Math.Acos(least);
            }
        }

        /// <summary>Marks the window that was read last as decoded.</summary>
        public void MarkDecoded()
        {
            Array.Copy(window, decoded, decoded.Length);
        }

        /// <summary>The pose without motion: the bind pose.</summary>
        public void Hold()
        {
            if (isHeld)
            {
                return;
            }
            skeleton.BindRotations.CopyTo(current, 0);
            skeleton.BindTranslations.CopyTo(currentTranslations, 0);
            clip = null;
            live = null;
            Fill();
            isHeld = true;
        }

        /// <summary>
        /// The clip at a time that starts over at its end, `step` seconds after the last; between its frames the drawn pose is
        /// interpolated.
        /// </summary>
        public void Sample(ClipSampler source, double seconds, double step)
        {
            double position = source.Position(seconds);
            int frame = (int)position;
            bool isLast = frame + 1 >= source.FrameCount;
            if (source != clip)
            {
                first += Windows;
                clip = source;
                live = null;
                index = -1;
            }
            if (frame != index)
            {
                source.ReadFrame(frame, start, startTranslations);
                source.ReadFrame(isLast ? frame : frame + 1, next, nextTranslations);
                index = frame;
            }
            start.CopyTo(current, 0);
            startTranslations.CopyTo(currentTranslations, 0);
            if (position > frame && !isLast)
            {
                PoseBlend.Approach(current, currentTranslations, next, nextTranslations, position - frame);
            }
            started = isHeld = MayLag = false;
            Due = first + frame;
            Following = first + Next(frame, step * rate, source.FrameCount);
        }

        /// <summary>Foresees nothing, as the clip rests.</summary>
        public void Rest()
        {
            Following = Due;
        }

        /// <summary>
        /// Takes a window, Due or Following, where it is not taken; one of a live source is there already. Weights that were set
        /// are those of this moment.
        /// </summary>
        public void ReadWindow(long number)
        {
            clip?.ReadWindow((int)(number - first), frames, window, windowTranslations);
            ReadWeights((int)(number - first));
            Expressions.Take(weights);
            expressed = (now - expressed) * rate >= 1 ? now : expressed;
        }

        /// <summary>The weight of an expression at this moment.</summary>
        public float Weight(int expression)
        {
            float set = Expressions.Get(expression);
            return !float.IsNaN(set) ? set
                : clip != null ? clip.ReadExpression(index, expression)
                : live != null ? live.Weight(expression) : 0;
        }

        /// <summary>
        /// Makes another decode due where weights were set since the last, at most one in each frame of the avatar's rate. One
        /// that is foreseen takes them with it. `always`: at once, for an editor that asks for single frames.
        /// </summary>
        public void Express(double seconds, bool always)
        {
            double step = seconds - now, age = (seconds - expressed) * rate;
            bool isNew = Due != known;
            bool isEarly = !always && age >= 0 && age < (Following == Due ? 1 : LongestForeseen) - FrameSlack;
            now = seconds;
            if (!isNew && !isEarly && Expressions.HasChanged)
            {
                first += Windows;
                Due += Windows;
                Following += Windows;
                MayLag = ChannelDecoder.Parts / DecodeSchedule.Alone * step * rate <= LongestLag;
                expressed = age >= 0 && age < LongestGap ? expressed + Math.Floor(age + FrameSlack) / rate : seconds;
            }
            known = Due;
        }

        /// <summary>
        /// A live source as it is at a time; the window takes one pose in each frame of the avatar's rate. Whether the
        /// pose is another than before; where it fills the whole window already, that stays as it is.
        /// </summary>
        public bool Sample(IPoseSource source, double seconds)
        {
            live = source;
            live.Read(next, nextTranslations);
            bool isSame = started && Equal(next, current) && Equal(nextTranslations, currentTranslations);
            next.CopyTo(current, 0);
            nextTranslations.CopyTo(currentTranslations, 0);
            rested = isSame ? rested : 0;
            double age = (seconds - newest) * rate;
            MayLag = ChannelDecoder.Parts / DecodeSchedule.Alone * (seconds - sampled) * rate <= LongestLag;
            sampled = seconds;
            if (rested == frames)
            {
                newest = seconds;
            }
            else if (!started || age < 0 || age > LongestGap)
            {
                Fill();
                newest = seconds;
            }
            else if (age >= 1 - FrameSlack)
            {
                Push();
                newest += Math.Floor(age + FrameSlack) / rate;
            }
            clip = null;
            isHeld = false;
            return !isSame;
        }

        private void ReadWeights(int frame)
        {
            if (clip != null)
            {
                clip.ReadExpressions(frame, weights);
                return;
            }
            for (int i = 0; i < weights.Length; i++)
            {
                weights[i] = live == null ? 0 : live.Weight(i);
            }
        }

        private void Fill()
        {
            for (int age = 0; age < frames; age++)
            {
                current.CopyTo(window, age * current.Length);
                currentTranslations.CopyTo(windowTranslations, age * currentTranslations.Length);
            }
            live?.ReadWindow(window, windowTranslations);
            rested = frames;
            started = true;
            first += Windows;
            Due = Following = first;
            MayLag = false;
        }

        private void Push()
        {
            Array.Copy(window, 0, window, current.Length, window.Length - current.Length);
            int moved = currentTranslations.Length;
            Array.Copy(windowTranslations, 0, windowTranslations, moved, windowTranslations.Length - moved);
            current.CopyTo(window, 0);
            currentTranslations.CopyTo(windowTranslations, 0);
            live.ReadWindow(window, windowTranslations);
            rested++;
            Due = Following = Due + 1;
        }

        /// <summary>The frame after another, if it is one of its neighbours that comes.</summary>
        private static int Next(int frame, double step, int count)
        {
            return step == 0 || Math.Abs(step) >= 1 ? frame : (frame + Math.Sign(step) + count) % count;
        }

        private static bool Equal(double[] a, double[] b)
        {
            for (int i = 0; i < a.Length; i++)
            {
                if (!a[i].Equals(b[i]))
                {
                    return false;
                }
            }
            return true;
        }
    }
}
