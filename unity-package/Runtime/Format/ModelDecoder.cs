using System;
using System.Runtime.InteropServices;

namespace Mua.Format
{
    /// <summary>Wavelet, coarse mesh and branches of a parsed tree, checked as in python/mua/asset/read_model.py.</summary>
    internal sealed class ModelDecoder
    {
        private const long Any = Tensors.Any;
        private const int GeometryChannels = 11;
        private const int AppearanceChannels = 12;
        private const int Bands = 3;

        private readonly Tensors tensors;
        private readonly byte[] content;

        public ModelDecoder(Tensors tensors, byte[] content)
        {
            this.tensors = tensors;
            this.content = content;
        }

        public Wavelet Wavelet(Table tree)
        {
            double[] low = Doubles(tree.Block("rec_lo")), high = Doubles(tree.Block("rec_hi"));
            if (low.Length != high.Length || low.Length % 2 != 0 || low.Length < 2 || low.Length > Limits.MaxTaps)
            {
                throw Refusal.Of(
                    "wavelet.rec_lo", "{0} and {1} taps, expected an even number of each, 2 to {2}",
                    low.Length, high.Length, Limits.MaxTaps);
            }
            for (int i = 0; i < low.Length; i++)
            {
                if (!IsFinite(low[i]) || !IsFinite(high[i]))
                {
                    throw new AvatarFormatException("finite", "wavelet.rec_lo", "a value is not finite");
                }
            }
            for (int i = 0; i < low.Length; i++)
            {
                if (Math.Max(Math.Abs(low[i]), Math.Abs(high[i])) > Limits.LargestTap)
                {
                    throw Refusal.Of(
                        "wavelet.rec_lo", "a tap of {0:g4} or {1:g4}, expected {2} to {3}", low[i], high[i],
                        -Limits.LargestTap, Limits.LargestTap);
                }
            }
            return new Wavelet { Name = tree.Text("name"), Levels = (int)tree.Number("levels"), RecLo = low, RecHi = high };
        }

        public Coarse Coarse(Table tree, int inputs)
        {
            Tensor mean = tensors.Reals(tree.Child("mean"), "coarse.mean", Any, 3);
            Tensor basis = tensors.Reals(tree.Child("basis"), "coarse.basis", Any, mean.Shape[0], 3);
            Tensors.RequireSome(basis, 0, "coarse.basis");
            Layer[] mlp = Mlp(tree.Children("mlp"), "coarse.mlp", inputs, basis.Shape[0]);
            return new Coarse { Mlp = mlp, Mean = mean, Basis = basis };
        }

        /// <summary>A branch over `count` texels with an LL of `side`, driven by so many components.</summary>
        public Branch Geometry(Table tree, int count, int inputs, int side)
        {
            return Branch(tree, "geometry", GeometryChannels, count, inputs, side);
        }

        public Branch Appearance(Table tree, int count, int inputs, int side)
        {
            return Branch(tree, "appearance", AppearanceChannels, count, inputs, side);
        }

        private Layer[] Mlp(Table[] tree, string path, long width, long outputs)
        {
            var layers = new Layer[tree.Length];
            for (int i = 0; i < layers.Length; i++)
            {
                string layer = path + "[" + i + "]";
                Tensor weight = tensors.Reals(tree[i].Child("weight"), layer + ".weight", Any, width);
                width = weight.Shape[0];
                Tensor bias = tensors.Reals(tree[i].Child("bias"), layer + ".bias", width);
                layers[i] = new Layer { Weight = weight, Bias = bias };
            }
            if (layers.Length == 0 || width != outputs)
            {
                throw new AvatarFormatException(
                    "shape", path, layers.Length + " layers with " + width + " outputs, expected " + outputs);
            }
            return layers;
        }

        private Branch Branch(Table tree, string path, int channels, int count, int inputs, int side)
        {
            Tensor basis = tensors.Reals(tree.Child("ll_basis"), path + ".ll_basis", channels, Any, side, side);
            Tensors.RequireSome(basis, 1, path + ".ll_basis");
            Table[] bands = tree.Children("details");
            var details = new DetailBand[bands.Length];
            long ranks = basis.Shape[1];
            for (int i = 0; i < details.Length; i++)
            {
                long size = (long)side << i;
                details[i] = Detail(bands[i], path + ".details[" + i + "]", channels, size);
                ranks += details[i].Rank;
            }
            return new Branch
            {
                Mlp = Mlp(tree.Children("mlp"), path + ".mlp", inputs, channels * ranks),
                LlMean = tensors.Reals(tree.Child("ll_mean"), path + ".ll_mean", channels, side, side),
                LlBasis = basis,
                Details = details,
                StaticOffset = tensors.Reals(tree.Child("static_offset"), path + ".static_offset", channels, count),
            };
        }

        private DetailBand Detail(Table tree, string path, int channels, long size)
        {
            Tensor h = tensors.Reals(tree.Child("h"), path + ".h", Bands, channels, Any, size);
            Tensors.RequireSome(h, 2, path + ".h");
            return new DetailBand
            {
                H = h,
                Mean = tensors.Reals(tree.Child("mean"), path + ".mean", Bands, channels, size, size),
                W = tensors.Reals(tree.Child("w"), path + ".w", Bands, channels, h.Shape[2], size),
            };
        }

        private double[] Doubles(Block block)
        {
            return MemoryMarshal.Cast<byte, double>(new ReadOnlySpan<byte>(content, block.Offset, 8 * block.Count)).ToArray();
        }

        private static bool IsFinite(double value)
        {
            return !double.IsNaN(value) && !double.IsInfinity(value);
        }
    }
}
