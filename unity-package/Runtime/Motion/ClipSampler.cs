using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// A clip at the rate of an avatar's encoding: the frames of python/mua/motion/resample.py, computed when asked for.
    /// </summary>
    public sealed class ClipSampler
    {
        private const double LastFrameSlack = 1e-6; // frames by which rounding may place the end before the last sample

        private readonly Clip clip;
        private readonly int joints;
        private readonly double step; // frames of the clip for one of ours

        /// <summary>Samples `clip` of a skeleton of `joints` joints at `rate` frames per second.</summary>
        public ClipSampler(Clip clip, int joints, double rate)
        {
            this.clip = clip;
            this.joints = joints;
            Rate = rate;
            step = clip.Rate / rate;
            int last = clip.FrameCount - 1;
            FrameCount = IsPlain ? clip.FrameCount : (int)(last / (double)clip.Rate * rate + LastFrameSlack) + 1;
        }

        public string Name => clip.Name;

        /// <summary>Frames per second.</summary>
        public double Rate { get; }

        public int FrameCount { get; }

        private bool IsPlain => Rate == clip.Rate;

        /// <summary>The frame shown at `seconds`; the clip starts over at its end, and plays back before 0.</summary>
        public int FrameAt(double seconds)
        {
            double frame = seconds * Rate % FrameCount;
            return (int)(frame < 0 ? frame + FrameCount : frame) % FrameCount;
        }

        /// <summary>
        /// The window of `frames` frames that ends at `index`, newest first: local rotations [frames, J, 4] and root
        /// translations [frames, 3], metres. Before its first frame, a clip is held still.
        /// </summary>
        public void ReadWindow(int index, int frames, Span<double> rotations, Span<double> translations)
        {
            for (int age = 0; age < frames; age++)
            {
                Span<double> pose = rotations.Slice(4 * joints * age, 4 * joints);
                ReadFrame(Math.Max(index - age, 0), pose, translations.Slice(3 * age, 3));
            }
        }

        /// <summary>Local rotations [J, 4] and root translation [3], metres, of one frame.</summary>
        public void ReadFrame(int index, Span<double> rotations, Span<double> translation)
        {
            int last = clip.FrameCount - 1;
            double time = IsPlain ? index : Math.Min(index * step, last);
            int before = (int)time, after = Math.Min(before + 1, last);
            double t = time - before;
            for (int joint = 0; joint < joints; joint++)
            {
                QuaternionD rotation = Rotation(before, joint);
                if (!IsPlain)
                {
                    rotation = QuaternionD.Slerp(rotation, Rotation(after, joint), t);
                }
                rotation.Store(rotations, joint);
            }
            for (int axis = 0; axis < 3; axis++)
            {
                float from = clip.Translation.Read(3 * before + axis), to = clip.Translation.Read(3 * after + axis);
                translation[axis] = IsPlain ? from : from + t * (float)(to - from); // the reference subtracts floats
            }
        }

        private QuaternionD Rotation(int frame, int joint)
        {
            int at = 4 * (frame * joints + joint);
            Tensor q = clip.Rotations;
            return new QuaternionD(q.Read(at), q.Read(at + 1), q.Read(at + 2), q.Read(at + 3)).Normalized();
        }
    }
}
