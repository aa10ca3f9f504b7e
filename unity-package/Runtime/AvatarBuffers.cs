using System;
using System.Collections.Generic;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// An avatar's tensors on the device, in the type in which the file stores them (python/mua/player/buffers.py). The
    /// constructor may run on any thread; Upload and Dispose belong to Unity's.
    /// </summary>
    internal sealed class AvatarBuffers : IDisposable
    {
        private readonly BufferSet buffers = new BufferSet();
        private readonly List<Upload> uploads = new List<Upload>();
        private readonly ExpressionTargets targets;
        private readonly Upload recLo, recHi, skinIndices, skinWeights, faces;
        private int filled; // uploads
        private long sent, total; // bytes

        public AvatarBuffers(AvatarFile avatar)
        {
            Avatar = avatar;
            CoarseMlp = Mlp(avatar.Coarse.Mlp, "coarse.mlp");
            Mesh = MeshOf(avatar.Coarse);
            Geometry = BranchOf(avatar.Geometry, "geometry");
            Appearance = BranchOf(avatar.Appearance, "appearance");
            recLo = Add(new Upload("wavelet.rec_lo", WholeWords(avatar.Wavelet.RecLo), sizeof(float)));
            recHi = Add(new Upload("wavelet.rec_hi", WholeWords(avatar.Wavelet.RecHi), sizeof(float)));
            skinIndices = Add(Stored(avatar.Template.SkinIndices, "template.skin_indices"));
            skinWeights = Add(new Upload("template.skin_weights", avatar.Template.SkinWeights.ToFloats(), sizeof(float)));
            faces = Add(Stored(avatar.Template.Faces, "template.faces"));
            targets = new ExpressionTargets(avatar);
            Expressions = new ExpressionBuffers(targets, Add);
            TexelLength = avatar.Texels.Length;
            Levels = Array.ConvertAll(DetailLevel.All(avatar), LevelOf);
            SplatCounts = Array.ConvertAll(Levels, level => level.SplatCount);
            foreach (Upload upload in uploads)
            {
                total += upload.Bytes;
            }
        }

        /// <summary>The file whose tensors these are, on the CPU.</summary>
        public AvatarFile Avatar { get; }

        public LayerBuffers[] CoarseMlp { get; }

        public LayerBuffers Mesh { get; }

        public BranchBuffers Geometry { get; }

        public BranchBuffers Appearance { get; }

        public ExpressionBuffers Expressions { get; }

        /// <summary>Levels of detail, the finest first.</summary>
        public LevelBuffers[] Levels { get; }

        /// <summary>Number of splats of each level.</summary>
        public int[] SplatCounts { get; }

        /// <summary>The side of a texel of the finest level, metres.</summary>
        public double TexelLength { get; }

        public int VertexCount => Avatar.Coarse.Mean.Shape[0];

        public int Taps => recLo.Count;

        public GraphicsBuffer RecLo => recLo.Buffer;

        public GraphicsBuffer RecHi => recHi.Buffer;

        public GraphicsBuffer SkinIndices => skinIndices.Buffer;

        public GraphicsBuffer SkinWeights => skinWeights.Buffer;

        public GraphicsBuffer Faces => faces.Buffer;

        /// <summary>Share of the bytes that are on the device, 0 to 1.</summary>
        public float Progress => total == 0 ? 1 : (float)((double)sent / total);

        /// <summary>
        /// Sends about `budget` more bytes; whether all are there. InvalidOperationException names the field that is
        /// too large for the device.
        /// </summary>
        public bool Upload(int budget)
        {
            while (filled < uploads.Count && budget > 0)
            {
                int before = budget;
                bool done = uploads[filled].Continue(buffers, ref budget);
                sent += before - budget;
                filled += done ? 1 : 0;
            }
            return filled == uploads.Count;
        }

        public void Dispose()
        {
            buffers.Dispose();
        }

        private LayerBuffers[] Mlp(Layer[] layers, string path)
        {
            var uploaded = new LayerBuffers[layers.Length];
            for (int i = 0; i < layers.Length; i++)
            {
                string layer = path + "[" + i + "]";
                uploaded[i] = new LayerBuffers
                {
                    Weight = StoredOf(layers[i].Weight, layer + ".weight"),
                    Bias = StoredOf(layers[i].Bias, layer + ".bias"),
                    Inputs = layers[i].Inputs,
                    Outputs = layers[i].Outputs,
                };
            }
            return uploaded;
        }

        /// <summary>Canonical vertices as a layer whose weight lies transposed: the basis [K, 3 V], the mean [3 V].</summary>
        private LayerBuffers MeshOf(Coarse coarse)
        {
            return new LayerBuffers
            {
                Weight = StoredOf(coarse.Basis, "coarse.basis"),
                Bias = StoredOf(coarse.Mean, "coarse.mean"),
                Inputs = coarse.Basis.Shape[0],
                Outputs = 3 * coarse.Basis.Shape[1],
            };
        }

        /// <summary>
        /// The filter padded to twice an odd number of taps, so that a thread of InverseDwt writes whole words.
        /// </summary>
        private static float[] WholeWords(double[] taps)
        {
            int padding = taps.Length % 4 == 0 ? 1 : 0;
            var padded = new float[taps.Length + 2 * padding];
            for (int i = 0; i < taps.Length; i++)
            {
                padded[i + padding] = (float)taps[i];
            }
            return padded;
        }

        private BranchBuffers BranchOf(Branch branch, string name)
        {
            var details = new BandBuffers[branch.Details.Length];
            var uploaded = new BranchBuffers
            {
                Mlp = Mlp(branch.Mlp, name + ".mlp"),
                LlMean = StoredOf(branch.LlMean, name + ".ll_mean"),
                LlBasis = StoredOf(branch.LlBasis, name + ".ll_basis"),
                Details = details,
                Channels = branch.Channels,
                Rank = branch.Rank,
            };
            for (int i = 0; i < details.Length; i++)
            {
                details[i] = BandOf(branch.Details[i], name + ".details[" + i + "]");
            }
            return uploaded;
        }

        private BandBuffers BandOf(DetailBand band, string path)
        {
            return new BandBuffers
            {
                Mean = StoredOf(band.Mean, path + ".mean"),
                H = StoredOf(band.H, path + ".h"),
                W = StoredOf(band.W, path + ".w"),
                Rank = band.Rank,
                Size = band.Size,
            };
        }

        private LevelBuffers LevelOf(DetailLevel level)
        {
            return new LevelBuffers(level, targets, Add)
            {
                Geometry = BranchLevelOf(Avatar.Geometry, "geometry", level.Geometry, level.Number),
                Appearance = BranchLevelOf(Avatar.Appearance, "appearance", level.Appearance, level.Number),
            };
        }

        /// <summary>The finest level's static offset as the file stores it, those of others as they were computed.</summary>
        private BranchLevel BranchLevelOf(Branch branch, string name, float[] staticOffset, int number)
        {
            string field = name + ".static_offset";
            var upsampling = new Upsampling(
                Avatar.Wavelet.RecLo, Avatar.Wavelet.Levels - branch.Details.Length, number);
            Add(upsampling.Taps);
            return new BranchLevel
            {
                Upsampling = upsampling,
                StaticOffset = number == 0
                    ? StoredOf(branch.StaticOffset, field)
                    : new StoredBuffer(Add(new Upload(field, staticOffset, sizeof(float)))),
            };
        }

        private StoredBuffer StoredOf(Tensor tensor, string field)
        {
            return new StoredBuffer(tensor, Add(Stored(tensor, field)));
        }

        private Upload Stored(Tensor tensor, string field)
        {
            var bytes = new ArraySegment<byte>(tensor.Content, tensor.Offset, tensor.ByteLength);
            return new Upload(field, bytes, tensor.Scale);
        }

        private Upload Add(Upload upload)
        {
            uploads.Add(upload);
            return upload;
        }
    }
}
