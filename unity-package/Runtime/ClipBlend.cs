using System;
using Mua.Format;
using Mua.Motion;

namespace Mua
{
    /// <summary>A moment of a clip that goes over into a moment of another: joints and weights of expressions.</summary>
    internal sealed class ClipBlend : IPoseSource
    {
        private readonly double[] other, next; // [J, 4]
        private readonly double[] otherTranslations, nextTranslations; // [J, 3]
        private ClipSampler first, second;
        private double firstSeconds, secondSeconds, share;

        public ClipBlend(Skeleton skeleton)
        {
            other = new double[4 * skeleton.JointCount];
            next = new double[4 * skeleton.JointCount];
            otherTranslations = new double[3 * skeleton.JointCount];
            nextTranslations = new double[3 * skeleton.JointCount];
        }

        /// <summary>Two clips at their own seconds; `part` of the pose, 0 to 1, is the second's.</summary>
        public void Set(ClipSampler from, double fromSeconds, ClipSampler to, double toSeconds, double part)
        {
            first = from;
            firstSeconds = fromSeconds;
            second = to;
            secondSeconds = toSeconds;
            share = part;
        }

        public void Read(Span<double> rotations, Span<double> translations)
        {
            ReadMoment(first, firstSeconds, rotations, translations);
            ReadMoment(second, secondSeconds, other, otherTranslations);
            PoseBlend.Approach(rotations, translations, other, otherTranslations, share);
        }

        public void ReadWindow(Span<double> rotations, Span<double> translations)
        {
            int from = (int)first.Position(firstSeconds), to = (int)second.Position(secondSeconds), frames = rotations.Length / other.Length;
            for (int age = 0; age < frames; age++)
            {
                Span<double> turns = rotations.Slice(age * other.Length, other.Length);
                Span<double> moves = translations.Slice(age * otherTranslations.Length, otherTranslations.Length);
                first.ReadFrame(Math.Max(from - age, 0), turns, moves);
                second.ReadFrame(Math.Max(to - age, 0), other, otherTranslations);
                PoseBlend.Approach(turns, moves, other, otherTranslations, share);
            }
        }

        public float Weight(int expression)
        {
            float from = first.ReadExpression((int)first.Position(firstSeconds), expression);
            float to = second.ReadExpression((int)second.Position(secondSeconds), expression);
            return from + (float)share * (to - from);
        }

        private void ReadMoment(ClipSampler clip, double seconds, Span<double> rotations, Span<double> translations)
        {
            double position = clip.Position(seconds);
            int frame = (int)position;
            clip.ReadFrame(frame, rotations, translations);
            if (position > frame && frame + 1 < clip.FrameCount)
            {
                clip.ReadFrame(frame + 1, next, nextTranslations);
                PoseBlend.Approach(rotations, translations, next, nextTranslations, position - frame);
            }
        }
    }
}
