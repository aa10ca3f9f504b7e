using System.Linq;
using Mua.Format;

namespace Mua.Editor
{
    /// <summary>
    /// What one part of an avatar costs: trained parameters, and floating-point operations of a frame with a multiply-add as
    /// two; null where it has none. Counted as in python/mua/asset/count.py.
    /// </summary>
    internal sealed class AvatarCost
    {
        private AvatarCost(string part, long? parameters, long? operations)
        {
            Part = part;
            Parameters = parameters;
            Operations = operations;
        }

        public string Part { get; }

        public long? Parameters { get; }

        public long? Operations { get; }

        /// <summary>All parts; their sums are what the avatar costs.</summary>
        public static AvatarCost[] Of(AvatarFile avatar)
        {
            Branch[] branches = { avatar.Geometry, avatar.Appearance };
            Layer[] layers = branches.SelectMany(branch => branch.Mlp).Concat(avatar.Coarse.Mlp).ToArray();
            DetailBand[] bands = branches.SelectMany(branch => branch.Details).ToArray();
            long still = branches.Sum(branch => (long)branch.StaticOffset.Count);
            long basis = avatar.Coarse.Basis.Count, ll = branches.Sum(branch => (long)branch.LlBasis.Count);
            PoseEncoding pose = avatar.Encoding;
            long directions = pose.Components.ToFloats().LongCount(number => number != 0); // 0 where a component has no part in a number
            return new[]
            {
                new AvatarCost(
                    "components of the pose", directions + pose.Ranges.Length + pose.Margins.Length,
                    2L * pose.Components.Count),
                new AvatarCost(
                    "coefficient MLPs", layers.Sum(layer => (long)layer.Weight.Count + layer.Bias.Count),
                    2 * layers.Sum(layer => (long)layer.Weight.Count)),
                new AvatarCost("PCA mesh", avatar.Coarse.Mean.Count + basis, 2 * basis),
                new AvatarCost("LL bases", ll + branches.Sum(branch => (long)branch.LlMean.Count), null),
                new AvatarCost(
                    "detail bases", bands.Sum(band => (long)band.Mean.Count + band.H.Count + band.W.Count), null),
                new AvatarCost("static offset", still, still),
                new AvatarCost("LL blend", null, 2 * ll),
                new AvatarCost("detail blend", null, 2 * bands.Sum(OuterProducts)),
                new AvatarCost(
                    "inverse DWT", null, 2 * branches.Sum(branch => InverseDwt(branch, avatar.Wavelet))),
            };
        }

        /// <summary>Multiply-adds of the scaled h, then of one matrix product for each band and channel.</summary>
        private static long OuterProducts(DetailBand band)
        {
            return band.H.Count + (long)band.H.Count * band.Size;
        }

        /// <summary>Multiply-adds of separable synthesis, of which half of the taps meet each sample.</summary>
        private static long InverseDwt(Branch branch, Wavelet wavelet)
        {
            long full = 0, low = 0, side = branch.LlMean.Shape[1];
            for (int level = 0; level < wavelet.Levels; level++)
            {
                side *= 2;
                full += level < branch.Details.Length ? side * side : 0;
                low += level < branch.Details.Length ? 0 : side * side;
            }
            int taps = wavelet.RecLo.Length;
            return branch.Channels * (2 * taps * full + taps * low * 3 / 4);
        }
    }
}
