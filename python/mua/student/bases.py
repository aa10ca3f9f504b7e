"""The bases of a branch in closed form, channel by channel, and the coefficients that fit given subbands best."""

import time
from functools import partial
from threading import Lock

import torch
from torch import Tensor

from mua.student.branches import fit_apart
from mua.student.factorize import blendshapes, frame_weights, separable_blendshapes
from mua.student.model import Alphas, Branch, outer_products
from mua.student.settings import Settings
from mua.student.subband_source import Source
from mua.student.texture_metric import in_texture, to_subbands
from mua.training.memory import release_memory
from mua.training.optimise import Progress, Run
from mua.wavelets import Bands

FRAMES_AT_ONCE = 64  # whose subbands are turned: copies of all would take much memory


@torch.no_grad()
def factorize_branch(
    branch: Branch,
    source: Source,
    *,
    frames: int,
    settings: Settings,
    stage: str,
    run: Run,
    sensitivities: Bands | None = None,  # of images to the samples of the branch's channels, for one frame
    counts: Tensor | None = None,  # [F] how much each frame counts
    wavelet: str | None = None,  # of the subbands, to fit the texture that they make; None: errors of subbands count
) -> tuple[Tensor, Tensor]:
    """Set means and bases of `branch` channel by channel; returns coefficients [F, M] and the texel variance [C].

    Bases are the best for images where sensitivities to its samples are given.
    """
    kept = run.checkpoints.load(stage)
    if kept is not None:
        branch.load_state_dict(kept["branch"])
        return kept["flat"].to(run.device), kept["variance"].to(run.device)
    started, owned = time.monotonic(), run.processes.channels(branch.channels)
    ranks, room = branch.ranks, partial(torch.empty, device=run.device)
    alphas = Alphas(*(room(frames, branch.channels, rank) for rank in (ranks.ll, ranks.d3, ranks.d2)))
    energy = room(branch.channels)
    done: list[int] = []
    counting = Lock()  # of two threads

    def solve(channel: int, run: Run) -> None:
        bands = Bands(*(band.to(run.device) for band in source(slice(channel, channel + 1), torch.arange(frames))))
        bands = bands if wavelet is None else _in_texture(bands, wavelet)
        generator = run.alone(f"{stage} {channel}").generator  # whoever solves for it draws the same numbers
        worth = None if sensitivities is None else worth_of(sensitivities, channel)
        with torch.no_grad():  # of this thread
            solved, energy[channel] = factorize_channel(
                branch, channel, bands, sweeps=settings.sweeps, generator=generator, worth=worth, counts=counts
            )
            if wavelet is not None:
                to_subbands(branch, channel, wavelet)
        for level, own in zip(alphas, solved, strict=True):
            level[:, channel] = own
        release_memory()
        with counting:
            done.append(channel)
            run.report(Progress(stage, len(done), len(owned), None, len(done) / (time.monotonic() - started)))

    fit_apart([partial(solve, channel) for channel in owned], run)
    for channel in range(branch.channels):
        found = (*branch.channel(channel), *(level[:, channel] for level in alphas), energy[channel])
        run.processes.broadcast(*found, source=run.processes.owner(channel))
    flat, spread = alphas.flat(), energy / (frames * settings.texels**2)
    run.checkpoints.save(stage, {"branch": branch.state_dict(), "flat": flat, "variance": spread})
    return flat, spread


def _in_texture(bands: Bands, wavelet: str) -> Bands:
    """The subbands in units of the texture, overwritten some frames at a time."""
    for some in zip(*(band.split(FRAMES_AT_ONCE) for band in bands), strict=True):
        for own, turned in zip(some, in_texture(Bands(*some), wavelet), strict=True):
            own.copy_(turned)
    return bands


def factorize_channel(
    branch: Branch,
    channel: int,
    bands: Bands,  # subbands of this channel alone; overwritten
    *,
    sweeps: int,
    generator: torch.Generator,
    worth: tuple[Tensor, ...] | None = None,  # from `worth_of`; None: errors of all samples count alike
    counts: Tensor | None = None,  # [F] how much each frame counts
) -> tuple[Alphas, Tensor]:
    """Set means and bases of one channel; returns its coefficients [F, R] and the sum of squares about the mean."""
    ll, d3, d2 = bands.ll[:, 0], bands.d3[:, :, 0], bands.d2[:, :, 0]
    coarse, *fine = (None, None, None) if worth is None else worth
    counts = frame_weights(ll, counts)
    roots = counts.sqrt()
    branch.ll_mean[channel] = torch.einsum("f,fij->ij", counts, ll) / len(ll)
    ll = (ll - branch.ll_mean[channel]) * roots[:, None, None]
    coarse = None if coarse is None else coarse.flatten()
    shapes = blendshapes(ll.flatten(1), branch.ranks.ll, generator=generator, worth=coarse)
    branch.ll_basis[channel] = shapes.basis.unflatten(1, ll.shape[1:])
    energy = ll.square().sum()
    coefficients = [shapes.coefficients / roots[:, None]]
    levels = ((branch.d3, branch.ranks.d3, d3), (branch.d2, branch.ranks.d2, d2))
    for (detail, rank, band), own in zip(levels, fine, strict=True):
        detail.mean[:, channel] = torch.einsum("f,fsij->sij", counts, band) / len(band)
        band = band.sub_(detail.mean[:, channel]).mul_(roots[:, None, None, None])  # of all frames: in place
        factors = separable_blendshapes(band, rank, sweeps=sweeps, generator=generator, worth=own)
        detail.h[:, channel], detail.w[:, channel] = factors.h, factors.w
        coefficients.append(factors.coefficients / roots[:, None])
        energy = energy + band.square().sum()
    return Alphas(*coefficients), energy


def worth_of(
    sensitivities: Bands,  # sensitivities of images to the samples of C channels, for one frame
    channel: int,
) -> tuple[Tensor, ...]:
    """Weights of the samples [n, n] of LL, D3 and D2 of a channel; equal where images show none of them."""
    levels = sensitivities.ll[0, channel], sensitivities.d3[0, 0, channel], sensitivities.d2[0, 0, channel]
    return tuple(own / own.mean() if own.any() else torch.ones_like(own) for own in levels)


class BestCoefficients:
    """The coefficients per frame and channel that fit given subbands best, by least squares, for the fitted bases."""

    @torch.no_grad()
    def __init__(self, branch: Branch) -> None:
        """Factorise the part that depends on the bases alone."""
        self._branch = branch
        outer = (outer_products(detail.h, detail.w) for detail in (branch.d3, branch.d2))
        self._levels = [_LeastSquares(basis) for basis in (branch.ll_basis.flatten(2), *outer)]

    @torch.no_grad()
    def __call__(
        self,
        bands: Bands,  # subbands of the branch's channels
    ) -> Alphas:
        branch = self._branch
        details = [(bands.d3 - branch.d3.mean).transpose(1, 2), (bands.d2 - branch.d2.mean).transpose(1, 2)]
        samples = (bands.ll - branch.ll_mean, *details)
        return Alphas(*(level(own) for level, own in zip(self._levels, samples, strict=True)))


class _LeastSquares:
    """Coefficients [F, C, R] of samples [F, C, ...], in double precision, of least norm where blendshapes are equal."""

    def __init__(
        self,
        basis: Tensor,  # [C, R, P]
    ) -> None:
        self._basis = basis.double()
        self._inverse = torch.linalg.pinv(self._basis @ self._basis.transpose(1, 2), hermitian=True, rtol=1e-10)

    def __call__(self, x: Tensor) -> Tensor:
        right = torch.einsum("fcp,crp->crf", x.flatten(2).double(), self._basis)
        return (self._inverse @ right).permute(2, 0, 1).to(x)
