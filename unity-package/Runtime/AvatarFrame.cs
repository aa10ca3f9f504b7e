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
    /// python/mua/player/frame.py. The buffers between the kernels are made once; the splats are shared with others.
    /// </summary>
    internal sealed class AvatarFrame : IDisposable
    {
        private const int ChannelRows = 6, AppearanceRow = 3; // of four half floats each
        private const int Corners = 8;

        private readonly MlpMatmul mlpMatmul;
        private readonly BlendSubbands blendSubbands;
        private readonly InverseDwt inverseDwt;
        private readonly DqSkinning dqSkinning;
        private readonly Descriptor describe;
        private readonly SkeletonPose skeleton;
        private readonly float[] descriptorValues;
        private readonly Vector4[] jointValues; // [2 J]
        private readonly BufferSet buffers = new BufferSet();
        private readonly GraphicsBuffer[] activations = new GraphicsBuffer[2];
        private readonly GraphicsBuffer[] textures = new GraphicsBuffer[2]; // finest detailed, its ll
        private GraphicsBuffer descriptor, details;

        /// <summary>InvalidOperationException where a kernel is missing or a buffer is more than the device holds.</summary>
        public AvatarFrame(AvatarResources resources, AvatarBuffers avatar)
        {
            Avatar = avatar;
            Level = avatar.Levels[0];
            mlpMatmul = new MlpMatmul(resources.MlpMatmul);
            blendSubbands = new BlendSubbands(resources.BlendSubbands);
            inverseDwt = new InverseDwt(resources.InverseDwt);
            dqSkinning = new DqSkinning(resources.DqSkinning);
            AvatarFile file = avatar.Avatar;
            describe = new Descriptor(file.Skeleton, file.Encoding);
            skeleton = new SkeletonPose(file.Skeleton);
            descriptorValues = new float[describe.Width];
            jointValues = new Vector4[2 * file.Skeleton.JointCount];
            try
            {
                CreateBuffers();
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        public AvatarBuffers Avatar { get; }

        /// <summary>That of the last decode; the buffers hold the finest.</summary>
        public LevelBuffers Level { get; private set; }

        public int SplatCount => Level.SplatCount;

        /// <summary>[6, N] of four half floats, of the last decode.</summary>
        public GraphicsBuffer TexelChannels { get; private set; }

        /// <summary>[M, 8] words of all avatars, given by SplatFrame.</summary>
        public GraphicsBuffer Splats { get; private set; }

        /// <summary>Where this avatar's begin.</summary>
        public int FirstSplat { get; private set; }

        /// <summary>[V, 3] canonical vertices of the last decode, metres.</summary>
        public GraphicsBuffer Mesh { get; private set; }

        /// <summary>[2 V] dual quaternions of the last pose.</summary>
        public GraphicsBuffer VertexDq { get; private set; }

        /// <summary>[2 J] dual quaternions of the last pose.</summary>
        public GraphicsBuffer Joints { get; private set; }

        /// <summary>Whether a decode has been recorded: until then the buffers hold nothing.</summary>
        public bool IsDecoded { get; private set; }

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
        /// Appends the dispatches from a window of poses to channels and posed vertices; what depends on the pose alone is written to the
        /// device at once.
        /// </summary>
        /// <param name="rotations">[k, J, 4] local joint rotations, newest first.</param>
        /// <param name="translations">[k, J, 3] local joint translations, metres.</param>
        /// <param name="place">From the avatar's space to the right-handed world.</param>
        /// <param name="level">Of detail, 0 being the finest.</param>
        public void Decode(
            CommandBuffer commands, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            in DualQuaternion place, int level = 0)
        {
            Decode(commands, rotations, translations, rotations, translations, place, level);
        }

        /// <summary>The same, in a pose [J, 4] and [J, 3] other than the window's newest.</summary>
        public void Decode(
            CommandBuffer commands, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            ReadOnlySpan<double> pose, ReadOnlySpan<double> offsets, in DualQuaternion place, int level = 0)
        {
            Level = Avatar.Levels[level];
            WriteDescriptor(rotations, translations);
            WritePose(pose, offsets, place);
            Branch(commands, Avatar.Geometry, Level.Geometry, 0);
            Coarse(commands);
            Branch(commands, Avatar.Appearance, Level.Appearance, AppearanceRow);
            Pose(commands);
            IsDecoded = true;
        }

        /// <summary>Appends what moves the last decoded avatar into another pose: [J, 4] and [J, 3] as for Decode.</summary>
        public void Repose(
            CommandBuffer commands, ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations,
            in DualQuaternion place)
        {
            WritePose(rotations, translations, place);
            Pose(commands);
        }

        /// <summary>Sets Low and High for a pose [J, 4] and [J, 3] that need not be drawn; nothing goes to the device.</summary>
        public void Stand(
            ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, in DualQuaternion place)
        {
            skeleton.Set(rotations, translations);
            WriteBounds(place);
        }

        public void Dispose()
        {
            buffers.Dispose();
        }

        private void CreateBuffers()
        {
            AvatarFile file = Avatar.Avatar;
            int layers = Math.Max(Widest(Avatar.CoarseMlp), 1);
            layers = Math.Max(layers, Math.Max(Widest(Avatar.Geometry.Mlp), Widest(Avatar.Appearance.Mlp)));
            long texture = Math.Max(Detailed(Avatar.Geometry), Detailed(Avatar.Appearance));
            descriptor = buffers.Structured("descriptor", describe.Width, sizeof(float));
            Mesh = buffers.Structured("mesh", 3L * Avatar.VertexCount, sizeof(float));
            long bands = Math.Max(LargestBand(Avatar.Geometry), LargestBand(Avatar.Appearance));
            details = buffers.Structured("details", bands, sizeof(float));
            for (int i = 0; i < 2; i++)
            {
                activations[i] = buffers.Structured("activations", layers, sizeof(float));
                textures[i] = buffers.Structured("texture", texture >> 2 * i, sizeof(float));
            }
            TexelChannels = buffers.Structured("texel_channels", (long)ChannelRows * SplatCount, 2 * sizeof(uint));
            Joints = buffers.Structured("joints", jointValues.Length, 4 * sizeof(float));
            VertexDq = buffers.Structured("vertex_dq", 2L * Avatar.VertexCount, 4 * sizeof(float));
        }

        private void WriteDescriptor(ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations)
        {
            describe.Write(rotations, translations, descriptorValues);
            descriptor.SetData(descriptorValues);
        }

        private void WritePose(
            ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, in DualQuaternion place)
        {
            skeleton.Set(rotations, translations);
            skeleton.WriteSkinning(place, MemoryMarshal.Cast<Vector4, float>(new Span<Vector4>(jointValues)));
            Joints.SetData(jointValues);
            WriteBounds(place);
        }

        private void WriteBounds(in DualQuaternion place)
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

        /// <summary>What the MLP makes of the descriptor; good until the next MLP.</summary>
        private GraphicsBuffer Mlp(CommandBuffer commands, LayerBuffers[] mlp)
        {
            GraphicsBuffer x = descriptor;
            for (int i = 0; i < mlp.Length; i++)
            {
                GraphicsBuffer y = activations[i % 2];
                mlpMatmul.Layer(commands, mlp[i], x, y, i < mlp.Length - 1);
                x = y;
            }
            return x;
        }

        private void Coarse(CommandBuffer commands)
        {
            commands.BeginSample(AvatarStages.CoarseMesh);
            GraphicsBuffer coefficients = Mlp(commands, Avatar.CoarseMlp);
            mlpMatmul.Transposed(commands, Avatar.Mesh, coefficients, Mesh);
            commands.EndSample(AvatarStages.CoarseMesh);
        }

        /// <summary>
        /// Coefficients, LL, level by level as long as there are details; then the valid texels to TexelChannels.
        /// </summary>
        private void Branch(CommandBuffer commands, BranchBuffers branch, BranchLevel shown, int firstRow)
        {
            commands.BeginSample(AvatarStages.Texture);
            GraphicsBuffer alpha = Mlp(commands, branch.Mlp);
            int levels = branch.Details.Length, size = Avatar.Avatar.Texels.Size >> Avatar.Avatar.Wavelet.Levels;
            blendSubbands.Low(commands, branch, alpha, size, textures[levels % 2]);
            int offset = branch.Channels * branch.Rank;
            for (int level = 0; level < levels; level++)
            {
                GraphicsBuffer ll = textures[(levels - level) % 2], fine = textures[(levels - level - 1) % 2];
                BandBuffers band = branch.Details[level];
                blendSubbands.Detail(commands, band, branch.Channels, alpha, offset, details);
                inverseDwt.Full(commands, Avatar, branch.Channels, size, ll, details, fine);
                offset += branch.Channels * band.Rank;
                size *= 2;
            }
            inverseDwt.UpsampleTexels(
                commands, Level, shown, branch.Channels, size, textures[0], TexelChannels, firstRow);
            commands.EndSample(AvatarStages.Texture);
        }

        private void Pose(CommandBuffer commands)
        {
            commands.BeginSample(AvatarStages.Pose);
            dqSkinning.BlendVertices(commands, Avatar, Joints, VertexDq);
            commands.EndSample(AvatarStages.Pose);
        }

        private static int Widest(LayerBuffers[] mlp)
        {
            int widest = 0;
            foreach (LayerBuffers layer in mlp)
            {
                widest = Math.Max(widest, layer.Outputs);
            }
            return widest;
        }

        /// <summary>Numbers of a branch's texture where its details end.</summary>
        private long Detailed(BranchBuffers branch)
        {
            long size = (long)(Avatar.Avatar.Texels.Size >> Avatar.Avatar.Wavelet.Levels) << branch.Details.Length;
            return branch.Channels * size * size;
        }

        private static long LargestBand(BranchBuffers branch)
        {
            long largest = 0;
            foreach (BandBuffers band in branch.Details)
            {
                largest = Math.Max(largest, 3L * branch.Channels * band.Size * band.Size);
            }
            return largest;
        }
    }
}
