using System;
using Mua.Format;
using Mua.Motion;

namespace Mua
{
    /// <summary>
    /// What an avatar is doing: the window of poses, at the avatar's own rate, that it is decoded from, and the pose of this
    /// moment, in which it is drawn.
    /// </summary>
    internal sealed class AvatarPose
    {
        private const double FrameSlack = 1e-6; // frames; a time that was a frame's own stays in it
        private const int LongestGap = 4; // frames without a pose after which the window starts anew

        private readonly Skeleton skeleton;
        private readonly int frames;
        private readonly double rate;
        private readonly double[] window; // [k, J, 4] newest first
        private readonly double[] windowTranslations; // [k, J, 3]
        private readonly double[] current; // [J, 4]
        private readonly double[] currentTranslations; // [J, 3]
        private readonly double[] next; // [J, 4]
        private readonly double[] nextTranslations; // [J, 3]
        private ClipSampler clip; // of the window; null where it is of transforms
        private int index = -1; // frame of the clip, newest of the window
        private double newest; // seconds; of the window's newest pose of transforms
        private int rested; // newest poses of the window that are the pose of transforms of this moment
        private bool started;

        public AvatarPose(AvatarFile avatar)
        {
            skeleton = avatar.Skeleton;
            frames = avatar.Encoding.Window;
            rate = avatar.Encoding.Rate;
            window = new double[4 * frames * skeleton.JointCount];
            windowTranslations = new double[3 * frames * skeleton.JointCount];
            current = new double[4 * skeleton.JointCount];
            currentTranslations = new double[3 * skeleton.JointCount];
            next = new double[4 * skeleton.JointCount];
            nextTranslations = new double[3 * skeleton.JointCount];
        }

        /// <summary>[k, J, 4] local rotations, newest first.</summary>
        public ReadOnlySpan<double> Window => window;

        /// <summary>[k, J, 3] local translations, metres.</summary>
        public ReadOnlySpan<double> WindowTranslations => windowTranslations;

        /// <summary>[J, 4] local rotations of this moment.</summary>
        public ReadOnlySpan<double> Current => current;

        /// <summary>[J, 3] local translations of this moment, metres.</summary>
        public ReadOnlySpan<double> CurrentTranslations => currentTranslations;

        /// <summary>Whether the window is another than that of the last decode; who decodes it sets this back.</summary>
        public bool IsFresh { get; set; }

        /// <summary>The pose without motion: the bind pose, held still.</summary>
        public void Hold()
        {
            if (started && clip == null && index < 0)
            {
                return;
            }
            skeleton.BindRotations.CopyTo(current, 0);
            skeleton.BindTranslations.CopyTo(currentTranslations, 0);
            Fill();
            clip = null;
        }

        /// <summary>The clip at a time that starts over at its end; between its frames the drawn pose is interpolated.</summary>
        public void Sample(ClipSampler source, double seconds)
        {
            double position = source.Position(seconds);
            int frame = (int)position;
            if (source != clip || frame != index)
            {
                source.ReadWindow(frame, frames, window, windowTranslations);
                clip = source;
                index = frame;
                started = false;
                IsFresh = true;
            }
            new ReadOnlySpan<double>(window, 0, current.Length).CopyTo(current);
            new ReadOnlySpan<double>(windowTranslations, 0, currentTranslations.Length).CopyTo(currentTranslations);
            double t = position - frame;
            if (t > 0 && frame + 1 < source.FrameCount)
            {
                source.ReadFrame(frame + 1, next, nextTranslations);
                Approach(t);
            }
        }

        /// <summary>
        /// The transforms as they are at a time; the window takes one pose in each frame of the avatar's rate. Whether the
        /// pose is another than before; where it fills the whole window already, that stays as it is.
        /// </summary>
        public bool Sample(AvatarJoints joints, double seconds)
        {
            joints.Read(next, nextTranslations);
            bool isSame = started && Equal(next, current) && Equal(nextTranslations, currentTranslations);
            next.CopyTo(current, 0);
            nextTranslations.CopyTo(currentTranslations, 0);
            rested = isSame ? rested : 0;
            double age = (seconds - newest) * rate;
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
            index = 0;
            return !isSame;
        }

        private void Approach(double t)
        {
            for (int joint = 0; joint < skeleton.JointCount; joint++)
            {
                QuaternionD a = QuaternionD.Load(current, joint), b = QuaternionD.Load(next, joint);
                QuaternionD.Slerp(a, b, t).Store(current, joint);
                Vector3D from = Vector3D.Load(currentTranslations, joint), to = Vector3D.Load(nextTranslations, joint);
                (from + t * (to - from)).Store(currentTranslations, joint);
            }
        }

        private void Fill()
        {
            for (int age = 0; age < frames; age++)
            {
                current.CopyTo(window, age * current.Length);
                currentTranslations.CopyTo(windowTranslations, age * currentTranslations.Length);
            }
            rested = frames;
            started = true;
            index = -1;
            IsFresh = true;
        }

        private void Push()
        {
            Array.Copy(window, 0, window, current.Length, window.Length - current.Length);
            int moved = currentTranslations.Length;
            Array.Copy(windowTranslations, 0, windowTranslations, moved, windowTranslations.Length - moved);
            current.CopyTo(window, 0);
            currentTranslations.CopyTo(windowTranslations, 0);
            rested++;
            IsFresh = true;
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
