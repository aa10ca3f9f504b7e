"""The systems that model wavelet subbands: by convolutions, by our blendshapes, or by both (paper, Ablations).

What the paper leaves open of the convolutions is chosen here: kernels of 5 x 5, one network for LL and one each for
geometry and appearance at a detail level. With these the published FLOPs come out nearly
(docs/research/comparisons.md).
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import torch
from torch import Tensor, nn

from mua.asset.count import synthesis
from mua.channels import APPEARANCE, CHANNELS, COARSE_TEXELS, DYNAMIC_LEVELS, GEOMETRY, LEVELS
from mua.filters import filters
from mua.student.finetune import subband_loss
from mua.student.model import Branch, lowpass_texels
from mua.student.settings import Ranks
from mua.student.stages import fit_branch
from mua.training.optimise import Run
from mua.wavelets import Bands
from mua_research.maps import CHANNELS as MAP_CHANNELS
from mua_research.maps import SurfaceMaps
from mua_research.network import Network, mlp_flops, parameter_groups
from mua_research.optimise import Groups
from mua_research.system import Motion, Sizes, TrainingFrames

PARTS = {"geometry": GEOMETRY, "appearance": APPEARANCE}
KERNEL = 5  # texels
WIDTHS = (32, 64, 128)  # of the three layers (paper, Ablations)
LINE_WIDTH = 256  # features of the 1D convolutions
LINE_LAYERS = 3
PROJECTED = 64  # features that positions are projected to before they are pooled
OCTAVES = 6  # of the sinusoidal encoding of either texture coordinate
MAP_SAMPLES = 256  # frames that the maps' normalisation looks at


class Maps(nn.Module):
    """The normalised input of the convolutions of one level."""

    mean: Tensor
    scale: Tensor

    def __init__(self, size: int) -> None:
        super().__init__()
        self.size = size
        self.register_buffer("mean", torch.zeros(MAP_CHANNELS, 1, 1))
        self.register_buffer("scale", torch.ones(MAP_CHANNELS, 1, 1))
        self._surface: SurfaceMaps | None = None

    def attach(self, frames: TrainingFrames, device: torch.device) -> None:
        """Make the maps of the rig, and normalise them channel by channel over training frames and texels."""
        self._surface = SurfaceMaps(frames.rig, self.size, device=device)
        rows = torch.linspace(0, len(frames) - 1, min(len(frames), MAP_SAMPLES)).long()
        seen = self._surface(frames.motion.posed[rows].to(device)).transpose(0, 1).flatten(1)
        self.mean.copy_(seen.mean(1)[:, None, None])
        self.scale.copy_(seen.std(1, correction=0).clamp(min=1e-6)[:, None, None])
        self.to(device)

    def forward(self, posed: Tensor) -> Tensor:
        """[F, 6, n, n]"""
        assert self._surface is not None, "maps without a rig"
        return (self._surface(posed) - self.mean) / self.scale


class Convolutions(nn.Module):
    """Three convolutions and a 1 x 1 decoder, which starts at zero: at the mean of the training frames."""

    def __init__(self, outputs: int, sizes: Sizes) -> None:
        super().__init__()
        widths = [sizes.times(width, 1 / 2) for width in WIDTHS]
        layers: list[nn.Module] = []
        for fan_in, fan_out in pairwise((MAP_CHANNELS, *widths)):
            layers += [nn.Conv2d(fan_in, fan_out, KERNEL, padding=KERNEL // 2), nn.ReLU()]
        self.features = nn.Sequential(*layers)
        self.decode = nn.Conv2d(widths[-1], outputs, 1)

    def forward(self, maps: Tensor) -> Tensor:
        decoded: Tensor = self.decode(self.features(maps))
        return decoded

    def flops(self, size: int) -> int:
        return 2 * size**2 * sum(p.numel() for p in self.parameters() if p.dim() == 4)


class Lines(nn.Module):
    """Positions pooled along either axis, convolved along it, joined by an outer product, decoded band by band."""

    encoding: Tensor

    def __init__(self, size: int, sizes: Sizes) -> None:
        super().__init__()
        self.register_buffer("encoding", texture_encoding(size))  # [4 octaves, n, n]
        projected, width = sizes.times(PROJECTED, 1 / 2), sizes.times(LINE_WIDTH, 1 / 2)
        features = projected + len(self.encoding)
        self.project = nn.Conv2d(3, projected, 1)
        self.pool = nn.Parameter(torch.zeros(2, size, size))  # [axis, row, column], softmax along what is pooled
        widths = (features, *[width] * LINE_LAYERS)
        self.along = nn.ModuleList(
            nn.Sequential(*(layer for a, b in pairwise(widths) for layer in _line(a, b))) for _ in range(2)
        )
        self.decode = nn.Linear(width, 3 * CHANNELS)

    def forward(self, maps: Tensor) -> Tensor:
        """[F, 3 x 23, n, n]; the decoder's weights meet the rows before these meet the columns, which is cheaper."""
        features = torch.cat([self.project(maps[:, :3]), self.encoding.expand(len(maps), -1, -1, -1)], dim=1)
        rows = self.along[0]((features * self.pool[0].softmax(1)).sum(3))  # [F, E, n] over columns
        columns = self.along[1]((features * self.pool[1].softmax(0)).sum(2))
        weighted_rows = self.decode.weight[:, :, None] * rows[:, None]  # [F, 69, E, n]
        decoded: Tensor = weighted_rows.transpose(2, 3) @ columns[:, None] + self.decode.bias[:, None, None]
        return decoded

    def flops(self, size: int) -> int:
        """Projection and two poolings on the map; two lines; the outer product decoded as our details are."""
        features = self.project.out_channels + len(self.encoding)
        on_map = size**2 * (self.project.weight.numel() + 2 * features)
        on_lines = size * sum(p.numel() for p in self.along.parameters() if p.dim() == 3)
        return 2 * (on_map + on_lines + self.decode.weight.numel() * (size + size**2))


class BandNetwork(Network):
    """Subbands of blendshapes, of convolutions, or of both, each band of one of them."""

    def __init__(
        self,
        sizes: Sizes,
        *,
        ranks: Sequence[Ranks] = (),  # of geometry and appearance; a level of rank 0 is left to convolutions
        ll: Convolutions | None = None,  # maps to [F, 23, n, n]
        details: Sequence[
            Sequence["Convolutions | Lines"]
        ] = (),  # of D3 and D2, each with networks from maps to [F, 3 C, n, n]
    ) -> None:
        super().__init__(sizes)
        side, settings = sizes.settings.texels // COARSE_TEXELS, sizes.settings
        self.branches = tuple(
            Branch(part.stop - part.start, rank, side, inputs=self.inputs, hidden=settings.hidden)
            for part, rank in zip(PARTS.values(), ranks, strict=False)
        )
        self.ll, self.details = ll, details
        self.maps = (Maps(side), Maps(2 * side))
        self.convolutions = nn.ModuleList([*([ll] if ll else []), *(n for level in details for n in level)])
        self.registered = nn.ModuleList([*self.branches, *self.maps])

    def attach(self, frames: TrainingFrames, device: torch.device) -> None:
        super().attach(frames, device)
        if len(self.convolutions):
            for maps in self.maps:
                maps.attach(frames, device)

    def start(self, frames: TrainingFrames, *, rate: float, run: Run) -> Groups:
        """Convolutions start from noise, blendshapes as our student's."""
        settings = frames.sizes.settings
        inputs, components = frames.motion.descriptors.to(run.device), frames.components(run.device)
        for branch, (name, part) in zip(self.branches, PARTS.items(), strict=False):
            source = partial(_bands_from, frames, part.start)
            fit_branch(
                branch,
                inputs,
                source,
                channels=part,
                components=components,
                settings=settings,
                name=name,
                run=run,
                parts=frames.parts,
                until="regression",
            )
            scale_branch(branch, self.weights[part])
        start_convolutions(self.convolutions, run.generator)
        groups: Groups = [{"params": list(self.convolutions.parameters()), "lr": rate}]
        mlps, bases = [b.mlp for b in self.branches], [p for b in self.branches for p in bases_of(b)]
        return groups + parameter_groups(mlps, bases, rate=settings.finetune.lr)

    def loss(self, frames: TrainingFrames, rows: Tensor) -> Tensor:
        """The paper's, over weighted subbands."""
        truth = Bands(*(band.to(self.weights.device) for band in frames.band_deviations(rows)))
        return subband_loss(self.band_deviations(frames.motion.of(rows).to(self.weights.device)), truth)

    def deviations(self, motion: Motion) -> Tensor:
        return lowpass_texels(self.band_deviations(motion), self.sizes.wavelet, self.texels)

    def band_deviations(self, motion: Motion) -> Bands:
        """Weighted deviations of all subbands from their mean."""
        inputs = motion.inputs
        ll, d3, d2 = None, None, None
        if self.branches:
            ll, d3, d2 = join(branch.synthesize(branch.split(branch.mlp(inputs))) for branch in self.branches)
        if len(self.convolutions):
            coarse, fine = (maps(motion.posed) for maps in self.maps)
        if self.ll is not None:
            ll = self.ll(coarse)
        if self.details:
            levels = zip(self.details, (coarse, fine), strict=True)
            d3, d2 = (torch.cat([n(maps).unflatten(1, (3, -1)) for n in level], dim=2) for level, maps in levels)
        assert ll is not None, "no network gives LL"
        assert d3 is not None, "no network gives D3"
        assert d2 is not None, "no network gives D2"
        return Bands(ll, d3, d2)

    def flops(self) -> int:
        """Networks, blendshapes, synthesis and the mean; making the maps is part of posing, as for every system."""
        side = self.maps[0].size
        taps = len(filters(self.sizes.wavelet).rec_lo)
        total = synthesis(CHANNELS, side, DYNAMIC_LEVELS, LEVELS, taps=taps) + self.mean_texture.numel()
        total += sum(branch_flops(branch) for branch in self.branches)
        total += self.ll.flops(side) if self.ll is not None else 0
        return total + sum(n.flops(side << i) for i, level in enumerate(self.details) for n in level)

    def parameter_count(self) -> int:
        """The mean is that of the subbands and of what the finest levels add to it, as in our file."""
        side = self.maps[0].size
        return super().parameter_count() + CHANNELS * 16 * side**2  # LL, 3 D3 and 3 D2: 1 + 3 + 3 x 4


def ours(sizes: Sizes) -> BandNetwork:
    """Our student."""
    return BandNetwork(sizes, ranks=own_ranks(sizes))


def conv_conv(sizes: Sizes) -> Network:
    """Convolutions for every subband (paper, Ablations, 2D Conv (All Levels))."""
    details = [_detail_convolutions(sizes) for _ in range(2)]
    return BandNetwork(sizes, ll=Convolutions(CHANNELS, sizes), details=details)


def conv_blendshapes(sizes: Sizes) -> Network:
    """Convolutions for LL, our details (paper, Ablations, 2D Conv (LL) + 1D Factorized Blendshapes)."""
    ranks = [replace(own, ll=0) for own in own_ranks(sizes)]
    return BandNetwork(sizes, ranks=ranks, ll=Convolutions(CHANNELS, sizes))


def blendshapes_conv1d(sizes: Sizes) -> Network:
    """Our LL, details by 1D convolutions (paper, Ablations, 2D Blendshapes (LL) + 1D Conv)."""
    ranks = [replace(own, d3=0, d2=0) for own in own_ranks(sizes)]
    side = sizes.settings.texels // COARSE_TEXELS
    return BandNetwork(sizes, ranks=ranks, details=[[Lines(side << level, sizes)] for level in range(2)])


def own_ranks(sizes: Sizes) -> list[Ranks]:
    """Those of our student's geometry and appearance."""
    return [sizes.ranks(own) for own in (sizes.settings.geometry, sizes.settings.appearance)]


def join(parts: Iterable[Bands]) -> Bands:
    """The subbands of all channels."""
    ll, d3, d2 = zip(*parts, strict=True)
    return Bands(torch.cat(ll, dim=1), torch.cat(d3, dim=2), torch.cat(d2, dim=2))


@torch.no_grad()
def scale_branch(branch: Branch, weights: Tensor) -> None:
    """Express a branch in weighted channels [C], about its mean."""
    branch.ll_basis.mul_(weights[:, None, None, None])
    branch.ll_mean.zero_()
    for detail in (branch.d3, branch.d2):
        detail.mean.zero_()
        for factor in (detail.h, detail.w):
            factor.mul_(weights.sqrt()[:, None, None])


@torch.no_grad()
def start_convolutions(network: nn.Module, generator: torch.Generator) -> None:
    """He et al.'s start for what feeds a ReLU, uniform pooling, decoders at zero: the training mean."""
    for name, parameter in sorted(network.named_parameters()):
        if "decode" in name or "pool" in name or parameter.dim() == 1:
            parameter.zero_()
        else:
            fan_in = parameter[0].numel()
            drawn = torch.randn(parameter.shape, generator=generator)
            parameter.copy_((2 / fan_in) ** 0.5 * drawn)


def bases_of(branch: Branch) -> list[nn.Parameter]:
    return [branch.ll_basis, branch.d3.h, branch.d3.w, branch.d2.h, branch.d2.w]


def branch_flops(branch: Branch) -> int:
    """As `mua.asset.count`: an MLP, a blend of LL, outer products of the details."""
    details = sum(d.h.numel() * (1 + d.h.shape[-1]) for d in (branch.d3, branch.d2))
    return mlp_flops(branch.mlp) + 2 * (branch.ll_basis.numel() + details)


def texture_encoding(size: int) -> Tensor:
    """Sines and cosines [4 octaves, n, n] of the texel centres' row and column."""
    centres = (torch.arange(size) + 0.5) / size
    angles = torch.pi * 2.0 ** torch.arange(OCTAVES)[:, None] * centres
    waves = torch.cat([angles.sin(), angles.cos()])  # [2 octaves, n]
    return torch.cat([waves[:, :, None].expand(-1, -1, size), waves[:, None].expand(-1, size, -1)])


def _line(fan_in: int, fan_out: int) -> list[nn.Module]:
    return [nn.Conv1d(fan_in, fan_out, KERNEL, padding=KERNEL // 2), nn.ReLU()]


def _detail_convolutions(sizes: Sizes) -> list[Convolutions]:
    return [Convolutions(3 * (part.stop - part.start), sizes) for part in PARTS.values()]


def _bands_from(frames: TrainingFrames, first: int, channels: slice, rows: Tensor) -> Bands:
    """Subbands of channels that are counted from `first`."""
    return frames.bands(slice(first + channels.start, first + channels.stop), rows)
