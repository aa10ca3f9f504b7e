using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// A clip at the rate of an avatar's encoding: the frames of python/mua/pose/resample.py, computed when asked for.
    /// </summary>
    public sealed class ClipSampler
    {
        private const double FrameSlack = 1e-6; // frames by which rounding may place a time before a frame's own

        private readonly Clip clip;
        private readonly Skeleton skeleton;
        private readonly double step; // frames of the clip for one of ours

        /// <summary>Samples `clip` of `skeleton` at `rate` frames per second.</summary>
        public ClipSampler(Clip clip, Skeleton skeleton, double rate)
        {
            this.clip = clip;
            this.skeleton = skeleton;
            Rate = rate;
            step = clip.Rate / rate;
            int last = clip.FrameCount - 1;
            FrameCount = IsPlain ? clip.FrameCount : (int)(last / (double)clip.Rate * rate + FrameSlack) + 1;
        }

        public string Name => clip.Name;

        /// <summary>Frames per second.</summary>
        public double Rate { get; }

        public int FrameCount { get; }

        private bool IsPlain => Rate == clip.Rate;

        /// <summary>
        /// The frame that a time falls in, and how far it is past it; the clip starts over at its end, and plays back before 0.
        /// </summary>
        public double Position(double seconds)
        {
            double position = seconds * Rate, whole = Math.Round(position);
            position = Math.Abs(position - whole) < FrameSlack ? whole : position;
            position %= FrameCount;
            position = position < 0 ? position + FrameCount : position;
            return position < FrameCount ? position : 0;
        }

        /// <summary>
        /// The window of `frames` frames that ends at `index`, newest first: local rotations [frames, J, 4] and
        /// translations [frames, J, 3], metres. Before its first frame, a clip stands still.
        /// </summary>
        public void ReadWindow(int index, int frames, Span<double> rotations, Span<double> translations)
        {
            int joints = skeleton.JointCount;
            for (int age = 0; age < frames; age++)
            {
                Span<double> turns = rotations.Slice(4 * joints * age, 4 * joints);
                ReadFrame(Math.Max(index - age, 0), turns, translations.Slice(3 * joints * age, 3 * joints));
            }
        }

        /// <summary>Local rotations [J, 4] and translations [J, 3], metres, of one frame.</summary>
        public void ReadFrame(int index, Span<double> rotations, Span<double> translations)
        {
            Moment(index, out int before, out int after, out double t);
            for (int joint = 0; joint < skeleton.JointCount; joint++)
            {
                QuaternionD rotation = Rotation(before, joint);
                if (!IsPlain)
                {
                    rotation = QuaternionD.Slerp(rotation, Rotation(after, joint), t);
                }
                rotation.Store(rotations, joint);
            }
            skeleton.BindTranslations.CopyTo(translations);
            Translation(clip.Translation, before, after, t).Store(translations, skeleton.Root);
            for (int i = 0, count = skeleton.Translated.Length; i < count; i++)
            {
                Vector3D moved = Translation(clip.Translations, before * count + i, after * count + i, t);
                moved.Store(translations, skeleton.Translated[i]);
            }
        }

        /// <summary>Weights [E] of expressions of one frame; all 0 where the clip has none.</summary>
        public void ReadExpressions(int index, Span<float> weights)
        {
            for (int i = 0; i < weights.Length; i++)
            {
                weights[i] = ReadExpression(index, i);
            }
        }

        /// <summary>Weight of one expression of one frame.</summary>
        public float ReadExpression(int index, int expression)
        {
            if (clip.Expressions == null)
            {
                return 0;
            }
            Moment(index, out int before, out int after, out double t);
            int count = clip.Expressions.Shape[1];
            return (float)Number(clip.Expressions, before * count + expression, after * count + expression, t);
        }

        /// <summary>The clip's frames before and after one of ours, and how far it lies between them.</summary>
        private void Moment(int index, out int before, out int after, out double t)
        {
            int last = clip.FrameCount - 1;
            double time = IsPlain ? index : Math.Min(index * step, last);
            before = (int)time;
            after = Math.Min(before + 1, last);
            t = time - before;
        }

        private Vector3D Translation(Tensor stored, int before, int after, double t)
        {
            return new Vector3D(
                Number(stored, 3 * before, 3 * after, t), Number(stored, 3 * before + 1, 3 * after + 1, t),
                Number(stored, 3 * before + 2, 3 * after + 2, t));
        }

        private double Number(Tensor stored, int before, int after, double t)
        {
            float from = stored.Read(before), to = stored.Read(after);
            return IsPlain ? from : from + t * (float)(to - from); // the reference subtracts floats
        }

        private QuaternionD Rotation(int frame, int joint)
        {
            int at = 4 * (frame * skeleton.JointCount + joint);
            Tensor q = clip.Rotations;
            return new QuaternionD(q.Read(at), q.Read(at + 1), q.Read(at + 2), q.Read(at + 3)).Normalized();
        }
    }
}
