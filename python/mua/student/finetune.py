"""Joint training of bases and MLP on the paper's loss (paper, Supervision and Training Objectives)."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import torch
from torch import Tensor, nn

from mua.student.model import Branch
from mua.student.settings import Generalisation
from mua.training.optimise import Run, optimise
from mua.training.processes import Share
from mua.training.schedule import Schedule
from mua.wavelets import Bands

LL_WEIGHT = 5.0  # lambda_LL of the paper; lambda_2 = lambda_3 = 1
BASIS_RATE = 3.0  # learning rate of the bases relative to that of the MLP
HUE = 3.0  # how much more errors of colours count by which red, green and blue differ: a tint stands out, a shade less


def subband_loss(predicted: Bands, truth: Bands) -> Tensor:
    """5 |LL| + |D3| + |D2|, L1 (paper, Eq. L_rec), each as a mean over its numbers (docs/research/paper.md)."""
    ll, d3, d2 = ((a - b).abs().mean() for a, b in zip(predicted, truth, strict=True))
    return LL_WEIGHT * ll + d3 + d2


def picture_loss(
    predicted: Bands,
    truth: Bands,
    sensitivities: Bands,  # for one frame, from `mua.student.sensitivity`
    *,
    hue: float = 0.0,  # how much more errors count that are not alike in red, green and blue; channels are such threes
) -> Tensor:
    """Mean squared error weighted by the change of images per unit: to first order, the error of images."""
    errors = [(a - b) * s for a, b, s in zip(predicted, truth, sensitivities, strict=True)]
    squares = [error.square().sum() for error in errors]
    if hue:
        colours = [error.unflatten(-3, (-1, 3)) for error in errors]
        squares += [hue * (own - own.mean(-3, keepdim=True)).square().sum() for own in colours]
    return torch.stack(squares).sum() / sum(error.numel() for error in errors)


def relative(
    sensitivities: Bands,
    weights: Tensor,  # [C] that subbands are multiplied by
) -> Bands:
    """Sensitivities to weighted subbands, with a root mean square of one."""
    by_weight = [own / weights[:, None, None] for own in sensitivities]
    mean = torch.cat([own.square().flatten() for own in by_weight]).mean()
    return Bands(*(own / mean.sqrt().clamp(min=torch.finfo(mean.dtype).tiny) for own in by_weight))


@contextmanager
def weighted(branch: Branch, weights: Tensor) -> Iterator[None]:
    """Scale the branch's subbands by `weights` [C] within the block: Adam's steps then suit all channels."""
    _scale(branch, weights)
    yield
    _scale(branch, 1 / weights)


def _scale(branch: Branch, weights: Tensor) -> None:
    with torch.no_grad():
        branch.ll_mean.mul_(weights[:, None, None])
        branch.ll_basis.mul_(weights[:, None, None, None])
        for detail in (branch.d3, branch.d2):
            detail.mean.mul_(weights[:, None, None])
            detail.h.mul_(weights.sqrt()[:, None, None])
            detail.w.mul_(weights.sqrt()[:, None, None])


def finetune(
    branch: Branch,
    inputs: Tensor,  # [F, K] components of descriptors
    bands: Callable[[Tensor], Bands],  # the subbands of a batch of frames
    *,
    weights: Tensor,  # [C]
    schedule: Schedule,
    stage: str,
    run: Run,
    basis_rate: float = BASIS_RATE,
    weight_decay: float = Generalisation.weight_decay,
    error: Callable[[Bands, Bands], Tensor] = subband_loss,
    frames: Tensor | None = None,  # [F] how often each frame is drawn; None: equally
) -> None:
    """Train bases and MLP together on an error of weighted subbands, by default the paper's loss."""
    schedule = schedule.over(len(inputs))

    def loss(model: nn.Module) -> Tensor:
        def part(share: Share) -> Tensor:
            ll, d3, d2 = (band.to(run.device) for band in bands(share.rows))
            scale = weights[:, None, None]
            predicted = model(inputs[share.rows.to(inputs.device)])
            return error(predicted, Bands(ll * scale, d3 * scale, d2 * scale))

        return run.processes.mean_loss(draw_frames(len(inputs), schedule, run, frames), part, frames=len(inputs))

    mlp = list(branch.mlp.parameters())
    bases = [branch.ll_basis, branch.d3.h, branch.d3.w, branch.d2.h, branch.d2.w]
    groups: list[dict[str, object]] = [
        {"params": mlp, "weight_decay": weight_decay},
        {"params": bases, "weight_decay": 0.0, "lr": basis_rate},
    ]
    with weighted(branch, weights):
        optimise(branch, loss, schedule=schedule, parameters=groups, stage=stage, run=run)


def draw_frames(count: int, schedule: Schedule, run: Run, weights: Tensor | None = None) -> Tensor:
    """The indices [B] of a step's frames out of `count`, each at most once, as often as its weight [F] says."""
    if weights is not None:
        return torch.multinomial(weights.cpu(), min(schedule.batch, count), generator=run.generator)
    return torch.randperm(count, generator=run.generator)[: schedule.batch]
