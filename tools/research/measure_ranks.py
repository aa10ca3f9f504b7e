"""Print what bases of each rank leave of the error that images show, subband by subband.

    python tools/research/measure_ranks.py RECORDING --pictures 12 --channel 11 --rank 64 --rank 128

Bases are solved in closed form on the training frames; every frame then takes the best coefficients there are. Squared
errors are weighted by what a sample changes in images; one of 10,000 is what the mean texture leaves in all three
subbands together. Where a rank exceeds the number of training frames, LL is exact on these.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import torch
import typer
from torch import Tensor

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.recording import Recording
from mua.student.bases import worth_of
from mua.student.factorize import blendshapes, separable_blendshapes
from mua.student.sensitivity import STAGE, measure_sensitivities
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Run
from mua.wavelets import Bands

PARTS = 10_000  # of the error of the mean texture
SWEEPS = 10

Errors = tuple[float, float]  # of training frames and of held-out ones


def main(
    recording: Annotated[Path, typer.Argument(help="Recording with held-out clips.")],
    channel: Annotated[list[int], typer.Option(help="Channel of the texture, may be repeated.")],
    rank: Annotated[list[int], typer.Option(help="Rank of each subband, may be repeated.")],
    pictures: Annotated[int, typer.Option(help="Images that sensitivities are measured in.")] = 12,
) -> None:
    """Measure what ranks are worth."""
    opened = Recording(recording)
    run = Run(torch.Generator().manual_seed(0), Checkpoints(Path(), ""), lambda _: None, torch.device("cpu"))
    sensitivities = measure_sensitivities(opened, pictures, run.alone(STAGE))
    total: dict[tuple[str, int], Tensor] = {}
    for own in channel:
        for subband, size, errors in left_by_channel(opened, own, sensitivities, rank):
            total[subband, size] = total.get((subband, size), torch.zeros(2)) + torch.tensor(errors)
    mean = sum(error for (_, size), error in total.items() if size == 0)
    for (subband, size), error in total.items():
        training, held_out = (PARTS * error / mean).tolist()
        print(f"{subband} {size:4}: {training:7.1f} training, {held_out:7.1f} held out")


def left_by_channel(
    recording: Recording, channel: int, sensitivities: Bands, ranks: list[int]
) -> Iterator[tuple[str, int, Errors]]:
    """Subband, rank and errors; rank 0 is the mean texture."""
    one, generator = slice(channel, channel + 1), torch.Generator().manual_seed(channel)
    training = recording.subbands(one, torch.arange(recording.count()))
    held_out = recording.subbands(one, torch.arange(recording.count(held_out=True)), held_out=True)
    weights = sensitivities.ll[0, channel], sensitivities.d3[0, 0, channel], sensitivities.d2[0, 0, channel]
    worth = worth_of(sensitivities, channel)
    for at, (subband, known, other) in enumerate(zip(("LL", "D3", "D2"), training, held_out, strict=True)):
        mean = known.mean(0)
        frames = (known - mean, other - mean)
        for rank in (0, *ranks):
            basis = solve(frames[0], rank, worth[at], generator) if rank else known.new_zeros(0, mean.numel())
            yield subband, rank, (left(frames[0], basis, weights[at]), left(frames[1], basis, weights[at]))


def solve(x: Tensor, rank: int, worth: Tensor, generator: torch.Generator) -> Tensor:
    """The basis [R, P] of samples [F, 1, n, n] of LL, or [F, 3, 1, n, n] of a detail level."""
    if x.ndim == 4:
        return blendshapes(x.flatten(1), rank, generator=generator, worth=worth.flatten()).basis
    return separable_blendshapes(x[:, :, 0], rank, sweeps=SWEEPS, generator=generator, worth=worth).basis()


def left(x: Tensor, basis: Tensor, weights: Tensor) -> float:
    """What the best coefficients leave, weighted and squared."""
    flat, rows = x.flatten(1).double(), basis.double()
    best = flat @ rows.T @ torch.linalg.pinv(rows @ rows.T, hermitian=True, rtol=1e-10) @ rows
    return float(((flat - best).view_as(x) * weights).square().sum())


if __name__ == "__main__":
    typer.run(main)
