using System;
using System.Runtime.InteropServices;
using Mua.Format;
using Mua.Motion;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// One frame of an avatar: the dispatches from a window of poses to channels and posed vertices, in the order of
    /// python/mua/player/frame.py. A decode is made at once, or part by part in several displayed frames beside the channels
    /// that are shown meanwhile. The splats are shared with others.
    /// </summary>
    internal sealed class AvatarFrame : IDisposable
    {
        private const int Corners = 8;

        private readonly DqSkinning dqSkinning;
        private readonly Descriptor describe;
        private readonly SkeletonPose skeleton;
        private readonly float[] componentValues; // [K]
        private readonly float[] weightValues; // [E]
        private readonly Vector4[] jointValues; // [2 J]
        private readonly BufferSet buffers = new BufferSet();
        private ChannelDecoder decoder;
        private ChannelSet shown, hidden; // the second is made when a decode is first begun
        private int decoded = ChannelDecoder.Parts; // parts of the decode into `hidden`

        /// <summary>
        /// InvalidOperationException where a kernel is missing or a buffer is too large for the device.
        /// </summary>
        public AvatarFrame(AvatarResources resources, AvatarBuffers avatar)
        {
            Avatar = avatar;
            dqSkinning = new DqSkinning(resources.DqSkinning);
            AvatarFile file = avatar.Avatar;
            describe = new Descriptor(file.Skeleton, file.Encoding);
            skeleton = new SkeletonPose(file.Skeleton);
            componentValues = new float[describe.Count];
            weightValues = new float[file.ExpressionCount];
            jointValues = new Vector4[2 * file.Skeleton.JointCount];
            try
            {
                CreateBuffers(resources);
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        public AvatarBuffers Avatar { get; }

        /// <summary>Level of detail of the decode that is shown; the buffers have room for the finest.</summary>
        public LevelBuffers Level => shown.Level;

        public int SplatCount => Level.SplatCount;

        /// <summary>[6, N] of four half floats, of the decode that is shown.</summary>
        public GraphicsBuffer TexelChannels => shown.TexelChannels;

        /// <summary>[M, 8] words of all avatars, given by SplatFrame.</summary>
        public GraphicsBuffer Splats { get; private set; }

        /// <summary>Index of this avatar's first splat.</summary>
        public int FirstSplat { get; private set; }

        /// <summary>[V, 3] canonical vertices of the decode that is shown, metres.</summary>
        public GraphicsBuffer Mesh => shown.Mesh;

        /// <summary>How many times as large as baked the last pose is.</summary>
        public float Size { get; private set; } = 1;

        /// <summary>[2 V] dual quaternions of the last pose, to the world divided by Size.</summary>
        public GraphicsBuffer VertexDq { get; private set; }

        /// <summary>[2 J] dual quaternions of the joints, likewise.</summary>
        public GraphicsBuffer Joints { get; private set; }

        /// <summary>Whether a decode is shown; until then the buffers are empty.</summary>
        public bool IsDecoded { get; private set; }

        /// <summary>Whether the camera that is recorded shows it, if it is in view.</summary>
        public bool IsShown { get; set; } = true;

        /// <summary>How far outside of training the pose is that is shown, 0 to 1.</summary>
        public double Outside => shown.Outside;

        /// <summary>The last pose, in the avatar's space.</summary>
        public SkeletonPose Skeleton => skeleton;

        /// <summary>Lowest corner of the box in which the last pose stands in the right-handed world, metres.</summary>
        public Vector3 Low { get; private set; }

        /// <summary>Highest corner.</summary>
        public Vector3 High { get; private set; }

        public void ShareSplats(GraphicsBuffer splats, int firstSplat)
        {
            Splats = splats;
            FirstSplat = firstSplat;
        }

        /// <summary>
        /// Appends the dispatches from a window of poses to channels and posed vertices, which are shown from then on; what
        /// depends on the pose alone is written to the device at once.
        /// </summary>
        /// <param name="rotations">[k, J, 4] local joint rotations, newest first.</param>
        /// <param name="translations">[k, J, 3] local joint translations, metres.</param>
        /// <param name="expressions">[E] weights of expressions, 0 to 1; where there are none, all are 0.</param>
        /// <param name="place">Where the avatar stands.</param>
        /// <param name="level">Level of detail; 0 is the finest.</param>
        public void Decode(
            CommandBuffer commands, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            ReadOnlySpan<float> expressions, in AvatarPlace place, int level = 0)
        {
            DecodeChannels(commands, rotations, translations, expressions, level);
            Repose(commands, rotations, translations, place);
        }

        /// <summary>Appends all parts of a decode, without posing; one that was begun is given up.</summary>
        public void DecodeChannels(
            CommandBuffer commands, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            ReadOnlySpan<float> expressions, int level = 0)
        {
            decoded = ChannelDecoder.Parts;
            Begin(shown, rotations, translations, expressions, level);
            for (int part = 0; part < ChannelDecoder.Parts; part++)
            {
                decoder.Part(commands, shown, part);
            }
            IsDecoded = true;
        }

        /// <summary>
        /// Takes the window of a decode that is made part by part beside what is shown, in place of one begun before.
        /// InvalidOperationException where the device has no memory for a second set of channels.
        /// </summary>
        public void Begin(
            ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, ReadOnlySpan<float> expressions, int level = 0)
        {
            hidden = hidden ?? new ChannelSet(Avatar, describe.Count);
            Begin(hidden, rotations, translations, expressions, level);
            decoded = 0;
        }

        /// <summary>Appends the next part of the decode that was begun.</summary>
        public void Advance(CommandBuffer commands)
        {
            decoder.Part(commands, hidden, decoded);
            decoded++;
        }

        /// <summary>Shows the decode that was begun, all of whose parts have been appended.</summary>
        public void Show()
        {
            ChannelSet whole = hidden;
            hidden = shown;
            shown = whole;
            IsDecoded = true;
        }

        /// <summary>Appends what moves the decoded avatar into another pose, [J, 4] and [J, 3] as for Decode.</summary>
        public void Repose(
            CommandBuffer commands, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            in AvatarPlace place)
        {
            WritePose(rotations, translations, place);
            Pose(commands);
        }

        /// <summary>Sets Low and High for a pose [J, 4] and [J, 3] that need not be drawn; nothing goes to the device.</summary>
        public void Stand(
            ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, in AvatarPlace place)
        {
            skeleton.Set(rotations, translations);
            WriteBounds(place);
        }

        public void Dispose()
        {
            buffers.Dispose();
            decoder?.Dispose();
            shown?.Dispose();
            hidden?.Dispose();
        }

        private void CreateBuffers(AvatarResources resources)
        {
            decoder = new ChannelDecoder(resources, Avatar);
            shown = new ChannelSet(Avatar, describe.Count);
            Joints = buffers.Structured("joints", jointValues.Length, 4 * sizeof(float));
            VertexDq = buffers.Structured("vertex_dq", 2L * Avatar.VertexCount, 4 * sizeof(float));
        }

        private void Begin(
            ChannelSet channels, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            ReadOnlySpan<float> expressions, int level)
        {
            channels.Level = Avatar.Levels[level];
            channels.Outside = describe.Write(rotations, translations, componentValues);
            channels.Components.SetData(componentValues);
            channels.IsExpressive = false;
            if (expressions.Length == 0)
            {
                return;
            }
            expressions.CopyTo(weightValues);
            Tensor rules = Avatar.Avatar.Expressions.Rules;
            ExpressionRules.Apply(rules == null ? default : rules.Integers, weightValues);
            foreach (float weight in weightValues)
            {
                channels.IsExpressive |= weight != 0;
            }
            if (channels.IsExpressive)
            {
                channels.Weights.SetData(weightValues);
            }
        }

        private void WritePose(
            ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, in AvatarPlace place)
        {
            skeleton.Set(rotations, translations);
            skeleton.WriteSkinning(place.Rigid, MemoryMarshal.Cast<Vector4, float>(new Span<Vector4>(jointValues)));
            Joints.SetData(jointValues);
            Size = place.Size;
            WriteBounds(place);
        }

        private void WriteBounds(in AvatarPlace place)
        {
            float[] box = Avatar.Avatar.Bounds;
            var low = new Vector3(float.MaxValue, float.MaxValue, float.MaxValue);
            Vector3 high = -low;
            for (int corner = 0; corner < Corners; corner++)
            {
                var about = new Vector3D(
                    box[(corner & 1) == 0 ? 0 : 3], box[(corner & 2) == 0 ? 1 : 4], box[(corner & 4) == 0 ? 2 : 5]);
                Vector3D moved = place.Transform(skeleton.RootPosition + about);
                var at = new Vector3((float)moved.X, (float)moved.Y, (float)moved.Z);
                low = Vector3.Min(low, at);
                high = Vector3.Max(high, at);
            }
            Low = low;
            High = high;
        }

        private void Pose(CommandBuffer commands)
        {
            commands.BeginSample(AvatarStages.Pose);
            dqSkinning.BlendVertices(commands, Avatar, Joints, VertexDq);
            commands.EndSample(AvatarStages.Pose);
        }
    }
}
