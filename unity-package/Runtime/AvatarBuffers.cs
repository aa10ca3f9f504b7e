using System;
using System.Collections.Generic;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// Everything of a file that does not change from frame to frame, in the types in which the file stores it
    /// (python/mua/player/buffers.py). The constructor may run on any thread; Upload and Dispose belong to Unity's.
    /// </summary>
    internal sealed class AvatarBuffers : IDisposable
    {
        private readonly BufferSet buffers = new BufferSet();
        private readonly List<Upload> uploads = new List<Upload>();
        private readonly Upload recLo, recHi, skinIndices, skinWeights, faces, tiles, tileRows, texels;
        private int filled; // uploads
        private long sent, total; // bytes

        public AvatarBuffers(AvatarFile avatar)
        {
            Avatar = avatar;
            CoarseMlp = Mlp(avatar.Coarse.Mlp, "coarse.mlp");
            Mesh = MeshOf(avatar.Coarse);
            Geometry = BranchOf(avatar.Geometry, "geometry");
            Appearance = BranchOf(avatar.Appearance, "appearance");
            recLo = Add(new Upload("wavelet.rec_lo", Array.ConvertAll(avatar.Wavelet.RecLo, tap => (float)tap), sizeof(float)));
            recHi = Add(new Upload("wavelet.rec_hi", Array.ConvertAll(avatar.Wavelet.RecHi, tap => (float)tap), sizeof(float)));
            skinIndices = Add(Stored(avatar.Template.SkinIndices, "template.skin_indices"));
            skinWeights = Add(new Upload("template.skin_weights", avatar.Template.SkinWeights.ToFloats(), sizeof(float)));
            faces = Add(Stored(avatar.Template.Faces, "template.faces"));
            var held = new TexelTiles(avatar.Texels.Indices.Integers.ToArray(), avatar.Texels.Size);
            tiles = Add(new Upload("texels.texels", held.Tiles, sizeof(int)));
            tileRows = Add(new Upload("texels.texels", held.Rows, 2 * sizeof(int)));
            texels = Add(new Upload("texels", Places(avatar.Texels), 2 * sizeof(int)));
            foreach (Upload upload in uploads)
            {
                total += upload.Bytes;
            }
        }

        /// <summary>The same file on the CPU.</summary>
        public AvatarFile Avatar { get; }

        public LayerBuffers[] CoarseMlp { get; }

        public LayerBuffers Mesh { get; }

        public BranchBuffers Geometry { get; }

        public BranchBuffers Appearance { get; }

        public int SplatCount => Avatar.Texels.Count;

        public int VertexCount => Avatar.Coarse.Mean.Shape[0];

        public int Taps => Avatar.Wavelet.RecLo.Length;

        public GraphicsBuffer RecLo => recLo.Buffer;

        public GraphicsBuffer RecHi => recHi.Buffer;

        public GraphicsBuffer SkinIndices => skinIndices.Buffer;

        public GraphicsBuffer SkinWeights => skinWeights.Buffer;

        public GraphicsBuffer Faces => faces.Buffer;

        /// <summary>How many tiles of the texture hold a valid texel.</summary>
        public int TileCount => tiles.Count;

        public GraphicsBuffer Tiles => tiles.Buffer;

        public GraphicsBuffer TileRows => tileRows.Buffer;

        /// <summary>[N] triangle, and its first two barycentrics in 16 bits each.</summary>
        public GraphicsBuffer Texels => texels.Buffer;

        /// <summary>Share of the bytes that are on the device, 0 to 1.</summary>
        public float Progress => total == 0 ? 1 : (float)((double)sent / total);

        /// <summary>
        /// Sends about `budget` more bytes; whether all are there. InvalidOperationException names the field that is more
        /// than the device holds.
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

        private BranchBuffers BranchOf(Branch branch, string name)
        {
            var details = new BandBuffers[branch.Details.Length];
            var uploaded = new BranchBuffers
            {
                Mlp = Mlp(branch.Mlp, name + ".mlp"),
                LlMean = StoredOf(branch.LlMean, name + ".ll_mean"),
                LlBasis = StoredOf(branch.LlBasis, name + ".ll_basis"),
                Details = details,
                Upsampling = UpsamplingOf(branch.Details.Length),
                StaticOffset = StoredOf(branch.StaticOffset, name + ".static_offset"),
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

        /// <summary>Of the levels beyond the `dynamic` ones that have details.</summary>
        private Upsampling UpsamplingOf(int dynamic)
        {
            var upsampling = new Upsampling(Avatar.Wavelet.RecLo, Avatar.Wavelet.Levels - dynamic);
            Add(upsampling.Taps);
            return upsampling;
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

        /// <summary>[N, 2] as pack_texels of python/mua/kernels/splat_project.py has them.</summary>
        private static int[] Places(Texels texels)
        {
            float[] barycentrics = texels.Barycentrics.ToFloats();
            var places = new int[2 * texels.Count];
            for (int i = 0; i < texels.Count; i++)
            {
                places[2 * i] = texels.Triangles.Integers[i];
                places[2 * i + 1] = Steps(barycentrics[2 * i]) | Steps(barycentrics[2 * i + 1]) << 16;
            }
            return places;
        }

        private static int Steps(float barycentric)
        {
            return (int)Math.Round((double)barycentric * ushort.MaxValue);
        }
    }
}
