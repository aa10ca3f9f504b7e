// An avatar of a file, uploaded, with its first clip to decode frames of.
using System;
using System.IO;
using Mua.Format;
using Mua.Motion;
using UnityEngine.Rendering;

namespace Mua
{
    internal sealed class Actor : IDisposable
    {
        public readonly AvatarBuffers Buffers;
        public readonly AvatarFrame Frame;
        public readonly ClipSampler Clip;
        private readonly double[] rotations, translations;
        private readonly float[] weights;

        public Actor(AvatarResources resources, string path)
        {
            AvatarFile file = AvatarFile.Read(File.ReadAllBytes(path));
            Buffers = new AvatarBuffers(file);
            while (!Buffers.Upload(1 << 16))
            {
            }
            Frame = new AvatarFrame(resources, Buffers);
            Clip = new ClipSampler(file.Clips[0], file.Skeleton, file.Encoding.Rate);
            rotations = new double[4 * file.Encoding.Window * file.Skeleton.JointCount];
            weights = new float[file.ExpressionCount];
            translations = new double[3 * file.Encoding.Window * file.Skeleton.JointCount];
        }

        public void Decode(CommandBuffer commands, double seconds, in AvatarPlace place, int level = 0)
        {
            Clip.ReadWindow((int)Clip.Position(seconds), Buffers.Avatar.Encoding.Window, rotations, translations);
            Clip.ReadExpressions((int)Clip.Position(seconds), weights);
            Frame.Decode(commands, rotations, translations, weights, place, level);
        }

        public void Dispose()
        {
            Frame.Dispose();
            Buffers.Dispose();
        }
    }
}
