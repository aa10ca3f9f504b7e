"""The systems that model the texture at full resolution: PCA, blendshapes, separable blendshapes, a linear map."""

from dataclasses import replace

import torch
from torch import Tensor, nn

from mua.channels import APPEARANCE, CHANNELS, FINE_TEXELS, GEOMETRY, STATIC_LEVELS
from mua.student.conditioned import Conditioned
from mua.student.factorize import separable_blendshapes
from mua.student.local import Locality, sample_locality, texture_locality
from mua.student.model import Branch, build_mlp
from mua.student.paper_recipe import start_mlp
from mua.student.regress import regress
from mua.student.settings import Ranks
from mua.student.targets import joint_targets
from mua.training.optimise import Run
from mua.wavelets import synthesise_lowpass, waverec2
from mua_research.network import Network, mlp_flops, parameter_groups
from mua_research.optimise import Groups
from mua_research.system import Motion, Sizes, TrainingFrames

PARTS = (GEOMETRY, APPEARANCE)
FRAMES_AT_ONCE = 64
SAMPLED = 2048  # frames that a closed form looks at, evenly spaced; bounds time and memory
RIDGE = 1e-2  # of the linear map, relative to a normalised descriptor's variance
CELL = 12  # texels along a side that share one corrective: 768 to 64 (SqueezeMe, arXiv 2412.15171)


class FullNetwork(Network):
    """Learns full-resolution textures on the L1 error of weighted valid texels."""

    def loss(self, frames: TrainingFrames, rows: Tensor) -> Tensor:
        truth = frames.deviations(rows).to(self.weights.device)
        return (self.deviations(frames.motion.of(rows).to(self.weights.device)) - truth).abs().mean()

    def mean_flops(self) -> int:
        return self.mean_texture.numel()


class Basis(nn.Module):
    """An MLP and the full-resolution blendshapes of some channels that its outputs weigh."""

    def __init__(self, channels: slice, rank: int, *, sizes: Sizes) -> None:
        super().__init__()
        self.channels, self.rank = channels, rank
        self.mlp: nn.Module = build_mlp(sizes.inputs, sizes.settings.hidden, rank)
        self.shapes = nn.Parameter(torch.zeros(rank, channels.stop - channels.start, len(sizes.texels)))

    def forward(self, inputs: Tensor) -> Tensor:
        """[F, C, N]"""
        return (self.mlp(inputs) @ self.shapes.flatten(1)).unflatten(1, self.shapes.shape[1:])


class Blendshapes(FullNetwork):
    """One basis for each of `parts`: all channels together (PCA-only), or one a branch (the TaoAvatar form)."""

    def __init__(self, sizes: Sizes, parts: tuple[slice, ...]) -> None:
        super().__init__(sizes)
        self.bases = tuple(Basis(part, sizes.times(sizes.settings.components), sizes=sizes) for part in parts)
        self.registered = nn.ModuleList(self.bases)

    def start(self, frames: TrainingFrames, *, rate: float, run: Run) -> Groups:
        for basis in self.bases:
            start_from_components(basis, frames, run=run)
        mlps, shapes = [basis.mlp for basis in self.bases], [basis.shapes for basis in self.bases]
        return parameter_groups(mlps, shapes, rate=frames.sizes.settings.finetune.lr)

    def deviations(self, motion: Motion) -> Tensor:
        inputs = motion.inputs
        return torch.cat([basis(inputs) for basis in self.bases], dim=1)

    def flops(self) -> int:
        blends = sum(mlp_flops(basis.mlp) + 2 * basis.shapes.numel() for basis in self.bases)
        return blends + self.mean_flops()


def pca_only(sizes: Sizes) -> Network:
    """One subspace for the whole texture (paper, Ablations, PCA-Only)."""
    return Blendshapes(sizes, (slice(0, CHANNELS),))


def full_blendshapes(sizes: Sizes) -> Network:
    """128 blendshapes of every splat for geometry and as many for appearance (paper, Comparison, TaoAvatar)."""
    return Blendshapes(sizes, PARTS)


@torch.no_grad()
def start_from_components(basis: Basis, frames: TrainingFrames, *, run: Run) -> None:
    """Principal components of the weighted textures, coefficients of unit variance, and an MLP trained on these.

    By the frames' Gram matrix, which needs one channel in memory at a time.
    """
    rows = sampled(frames)
    own = range(basis.channels.start, basis.channels.stop)
    gram = torch.zeros(len(rows), len(rows), dtype=torch.double, device=run.device)
    for channel in own:
        x = _channel(frames, rows, channel).to(run.device)
        gram += (x @ x.T).double()
    values, vectors = torch.linalg.eigh(gram)
    kept = min(basis.rank, int((values > values[-1].clamp(min=0) * 1e-9).sum()))
    u, s = vectors[:, -kept:].flip(1).float(), values[-kept:].flip(0).clamp(min=0).sqrt().float()
    if not kept:  # nothing moves
        start_mlp(basis.mlp, run.generator)
        return
    spread = s / len(rows) ** 0.5  # of each coefficient over frames
    for at, channel in enumerate(own):
        x = _channel(frames, rows, channel).to(run.device)
        basis.shapes[:kept, at] = (u / s).T @ x * spread[:, None]
    expand = torch.zeros(kept, basis.rank, device=run.device)
    expand[:, :kept] = torch.diag(1 / spread)
    local = None
    if frames.parts is not None:
        directions = (basis.shapes[:kept] / spread[:, None, None]).transpose(1, 2)
        owners = frames.parts.texel_owners(frames.sizes.texels)
        fade, light = frames.sizes.settings.generalisation.fade, basis.channels.stop > APPEARANCE.start
        local = sample_locality(frames.parts, directions, owners, fade=fade, light=light)
    basis.mlp = _train(frames, rows, u * s, expand, locality=local, run=run)


class SingleLevel(FullNetwork):
    """Outer products at full resolution, coefficients per channel, twice our LL ranks (paper, Single-level Fact.)."""

    def __init__(self, sizes: Sizes) -> None:
        super().__init__(sizes)
        settings = sizes.settings
        ranks = (sizes.times(2 * settings.geometry.ll), sizes.times(2 * settings.appearance.ll))
        self.parts = tuple(Separable(part, rank, sizes=sizes) for part, rank in zip(PARTS, ranks, strict=True))
        self.registered = nn.ModuleList(self.parts)

    def start(self, frames: TrainingFrames, *, rate: float, run: Run) -> Groups:
        for part in self.parts:
            start_from_quarter(part, frames, run=run)
        mlps, factors = [part.mlp for part in self.parts], [f for part in self.parts for f in (part.h, part.w)]
        return parameter_groups(mlps, factors, rate=frames.sizes.settings.finetune.lr)

    def deviations(self, motion: Motion) -> Tensor:
        inputs = motion.inputs
        return torch.cat([part(inputs).flatten(2)[..., self.texels] for part in self.parts], dim=1)

    def flops(self) -> int:
        """The products are counted where a texel is valid; alpha h everywhere."""
        products = sum(part.h.numel() + part.h.shape[0] * part.h.shape[1] * len(self.texels) for part in self.parts)
        return sum(mlp_flops(part.mlp) for part in self.parts) + 2 * products + self.mean_flops()


class Separable(nn.Module):
    """sum_r alpha(r, c) h(:, r, c) (x) w(:, r, c) of some channels."""

    def __init__(self, channels: slice, rank: int, *, sizes: Sizes) -> None:
        super().__init__()
        self.channels, self.rank = channels, rank
        count = channels.stop - channels.start
        self.mlp: nn.Module = build_mlp(sizes.inputs, sizes.settings.hidden, count * rank)
        self.h = nn.Parameter(torch.zeros(count, rank, sizes.settings.texels))
        self.w = nn.Parameter(torch.zeros(count, rank, sizes.settings.texels))

    def forward(self, inputs: Tensor) -> Tensor:
        """[F, C, H, W]"""
        alpha = self.mlp(inputs).unflatten(1, self.h.shape[:2])
        return (alpha[..., None] * self.h).transpose(-1, -2) @ self.w


@torch.no_grad()
def start_from_quarter(part: Separable, frames: TrainingFrames, *, run: Run) -> None:
    """Alternating least squares on the low-pass quarter-size images, carried to full size.

    A recorded texture is the low-pass synthesis of its quarter-size image, which takes outer products to outer
    products, so nothing is lost by the smaller problem. The MLP is trained as our student's are.
    """
    settings, wavelet = frames.sizes.settings, frames.sizes.wavelet
    rows, quarter = sampled(frames), settings.texels >> STATIC_LEVELS
    count = part.channels.stop - part.channels.start
    h, w, alphas = [], [], []
    for channel in range(part.channels.start, part.channels.stop):
        bands = frames.band_deviations(rows, slice(channel, channel + 1))
        image = waverec2(bands.ll, [bands.d3.transpose(1, 2), bands.d2.transpose(1, 2)], wavelet)
        factors = separable_blendshapes(
            image.to(run.device), part.rank, sweeps=settings.sweeps, generator=run.generator
        )
        h.append(factors.h[0])
        w.append(factors.w[0])
        alphas.append(factors.coefficients)
    rows_h, rows_w = torch.stack(h), torch.stack(w)  # [C, R, n]
    part.h.copy_(lines_to_full(rows_h, wavelet))
    part.w.copy_(lines_to_full(rows_w, wavelet))
    stand_in = Branch(count, Ranks(part.rank, 0, 0), quarter, inputs=1, hidden=1).to(run.device)
    stand_in.ll_basis.copy_(torch.einsum("cri,crj->crij", rows_h, rows_w))
    flat = torch.stack(alphas, dim=1).flatten(1)
    unit = torch.ones(count, device=run.device)
    rank = min(settings.hidden, len(rows))
    targets = joint_targets(stand_in, flat, unit, rank=rank, generator=run.generator)
    local = None
    if frames.parts is not None:
        fine = frames.parts.fine
        parts = replace(
            frames.parts, coarse=finer(fine, FINE_TEXELS >> STATIC_LEVELS), fine=finer(fine, FINE_TEXELS >> 1)
        )
        fade, light = settings.generalisation.fade, part.channels == APPEARANCE
        local = texture_locality(parts, stand_in, targets, unit, fade=fade, light=light)
    part.mlp = _train(frames, rows, targets.coordinates, targets.expand, locality=local, run=run)


def finer(owners: Tensor, times: int) -> Tensor:
    """Parts [n, n] of samples `times` smaller, [times n, times n]."""
    return owners.repeat_interleave(times, 0).repeat_interleave(times, 1)


def lines_to_full(
    lines: Tensor,  # [C, R, n]
    wavelet: str,
) -> Tensor:
    """Low-pass synthesis [C, R, 4 n] of lines: that of images constant along their other axis, whose gain is undone."""
    size = lines.shape[-1]
    image = lines[..., None].expand(*lines.shape, size)
    return synthesise_lowpass(image, wavelet, STATIC_LEVELS)[..., 0] * 2.0 ** (STATIC_LEVELS / 2)


class LinearMap(FullNetwork):
    """A linear code of the descriptor, a linear layer to a coarse grid of correctives that texels share (SqueezeMe)."""

    cells: Tensor

    def __init__(self, sizes: Sizes) -> None:
        super().__init__(sizes)
        side = min(sizes.times(self.size // CELL, 1 / 4), self.size)  # its square and the rank share the scale
        rank = sizes.times(sizes.settings.components // 2, 1 / 2)
        row, column = self.texels // self.size, self.texels % self.size
        self.register_buffer("cells", row * side // self.size * side + column * side // self.size)
        self.code = nn.Linear(self.inputs, rank)
        self.grid = nn.Linear(rank, CHANNELS * side * side, bias=False)

    def start(self, frames: TrainingFrames, *, rate: float, run: Run) -> Groups:
        self._solve(frames, run)
        lr = frames.sizes.settings.finetune.lr
        return parameter_groups([self.code], list(self.grid.parameters()), rate=lr, basis_rate=0.1)

    @torch.no_grad()
    def _solve(self, frames: TrainingFrames, run: Run) -> None:
        """Reduced-rank ridge regression of the cells' mean deviations."""
        rows = sampled(frames)
        inputs = frames.motion.inputs[rows].to(run.device).double()
        goal = torch.cat([self._cell_means(frames.deviations(part)) for part in rows.split(FRAMES_AT_ONCE)]).double()
        system = inputs.T @ inputs + RIDGE * len(rows) * torch.eye(self.inputs, dtype=torch.double, device=run.device)
        whole = torch.linalg.solve(system, inputs.T @ goal)
        _, s, v = torch.linalg.svd(inputs @ whole, full_matrices=False)
        kept = min(self.code.out_features, len(s))
        spread = (s[:kept] / len(rows) ** 0.5).clamp(min=torch.finfo(torch.float).tiny)
        for parameter in self.parameters():
            parameter.zero_()
        self.code.weight[:kept] = ((whole @ v[:kept].T) / spread).T.float()
        self.grid.weight[:, :kept] = (v[:kept].T * spread).float()

    def _cell_means(
        self,
        deviations: Tensor,  # [F, 23, N]
    ) -> Tensor:
        """[F, 23 cells], zero where a cell has no valid texel."""
        side2 = self.grid.out_features // CHANNELS
        total = torch.zeros(*deviations.shape[:2], side2, device=self.cells.device)
        total.index_add_(2, self.cells, deviations.to(self.cells.device))
        count = torch.bincount(self.cells, minlength=side2).clamp(min=1)
        return (total / count).flatten(1)

    def deviations(self, motion: Motion) -> Tensor:
        grid = self.grid(self.code(motion.inputs))
        return grid.unflatten(1, (CHANNELS, -1))[..., self.cells]

    def flops(self) -> int:
        return 2 * (self.code.weight.numel() + self.grid.weight.numel()) + self.mean_flops()


def sampled(frames: TrainingFrames) -> Tensor:
    """The rows that closed forms look at."""
    count = min(len(frames), SAMPLED)
    return torch.arange(count) * len(frames) // count


@torch.enable_grad()
def _train(
    frames: TrainingFrames,
    rows: Tensor,
    coordinates: Tensor,  # [F, K] of the rows
    expand: Tensor,  # [K, M]
    *,
    locality: Locality | None,
    run: Run,
) -> Conditioned:
    """An MLP to coordinates @ expand, trained as our student's are."""
    settings = frames.sizes.settings
    return regress(
        frames.motion.descriptors[rows].to(run.device),
        coordinates,
        components=frames.components(run.device),
        expand=expand,
        locality=locality,
        hidden=settings.hidden,
        schedule=settings.regression,
        stage="coefficients",
        run=run,
        generalisation=settings.generalisation,
    )


def _channel(frames: TrainingFrames, rows: Tensor, channel: int) -> Tensor:
    """Weighted deviations [F, N] of one channel."""
    own = slice(channel, channel + 1)
    return torch.cat([frames.deviations(part, own)[:, 0] for part in rows.split(FRAMES_AT_ONCE)])
