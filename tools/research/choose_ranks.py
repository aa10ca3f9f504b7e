"""Print which ranks show least error in images for what they cost, from few to many.

python tools/research/choose_ranks.py hero.work/recording-* other.work/recording-*

Bases are fitted in closed form to frames of each recording, at several ranks. What counts is the error of the best
coefficients, weighted by how much images change, on training and held-out frames alike. From the smallest ranks on, the
step that removes most error for its parameters and operations is taken, again and again.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.asset.count import flops, parameters
from mua.bench.random_avatar import ENCODING, RINGS, SPOKES
from mua.channels import APPEARANCE, GEOMETRY
from mua.pose.clip import is_range
from mua.recording import Recording
from mua.student.factorize import separable_blendshapes, truncated_svd
from mua.student.outline import Body, outline
from mua.student.sensitivity import measure_sensitivities
from mua.student.settings import PAPER_SIZES, Ranks, Settings, preset
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Run
from mua.wavelets import Bands

FRAMES = 400  # of each kind, at most
EVERY = 3  # of which channels one is measured: those of an attribute are alike
PICTURES = 8
SWEEPS = 3
RANKS = (8, 16, 32, 64, 96, 128)  # that are tried
BRANCHES = {"geometry": GEOMETRY, "appearance": APPEARANCE}
PAPER = replace(preset("paper"), **vars(PAPER_SIZES))
BODY = Body(ENCODING.width, 3 * (9 + 6 * len(ENCODING.joints)), RINGS * SPOKES, 300_000)  # as comparisons.md counts
KINDS = ("training", "held out")


class Group(NamedTuple):
    """The blendshapes that share a rank."""

    branch: str
    level: str


Errors = dict[Group, np.ndarray]  # [1 + ranks, kinds] of images, mean square: of the mean texture, then at each rank


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("recordings", type=Path, nargs="+")
    paths: list[Path] = arguments.parse_args().recordings
    measured = [measure(Recording(path)) for path in paths]
    shown = [f"{path.parent.stem}, {kind}" for path, kind in product(paths, KINDS)]
    print(f"| geometry | appearance | GFLOPs | M parameters | {' | '.join(shown)} |\n|{' --- |' * (4 + len(shown))}")
    for settings, at in frontier(measured):
        left = np.concatenate([sum(own[group][at[group]] for group in own) for own in measured])
        cells = [" ".join(map(str, vars(ranks).values())) for ranks in (settings.geometry, settings.appearance)]
        cells += [f"{cost / unit:.4g}" for cost, unit in zip(costs(settings), (1e9, 1e6), strict=True)]
        print("|", " | ".join(cells + [f"{-10 * np.log10(error):.2f}" for error in left]), "|", flush=True)


def frontier(measured: Sequence[Errors]) -> Iterator[tuple[Settings, dict[Group, int]]]:
    """Settings from the fewest ranks on, each with one step more than the last."""
    relative = {group: np.sum([(own[group] / total(own)).sum(1) for own in measured], axis=0) for group in measured[0]}
    at = dict.fromkeys(relative, 1)
    yield with_ranks(at), dict(at)
    while steps := [{**at, group: place + 1} for group, place in at.items() if place < len(RANKS)]:
        at = max(steps, key=partial(gain, relative, at))
        yield with_ranks(at), at


def gain(relative: dict[Group, np.ndarray], before: dict[Group, int], after: dict[Group, int]) -> float:
    """Error that a step removes for a share of what the paper's sizes cost, in parameters and operations."""
    removed = sum(relative[group][before[group]] - relative[group][after[group]] for group in before)
    price = (costs(with_ranks(after)) - costs(with_ranks(before))) / costs(PAPER)
    return float(removed / price.sum())


def total(errors: Errors) -> np.ndarray:
    """The error of the mean texture by kind."""
    return np.sum([own[0] for own in errors.values()], axis=0)


def costs(settings: Settings) -> np.ndarray:
    """Operations of a frame and parameters."""
    student = outline(settings, BODY)
    spent = flops(student)
    return np.array([sum(spent.values()) - spent["components of the pose"], sum(parameters(student).values())])


def with_ranks(at: dict[Group, int]) -> Settings:
    geometry, appearance = (
        Ranks(*(RANKS[at[Group(branch, level)] - 1] for level in Bands._fields)) for branch in BRANCHES
    )
    return replace(PAPER, geometry=geometry, appearance=appearance)


def measure(recording: Recording) -> Errors:
    """The errors of images that ranks leave, to first order, summed over the channels of each branch."""
    run = Run(torch.Generator().manual_seed(0), Checkpoints(Path(), ""), lambda _: None, torch.device("cpu"))
    sensitivities = measure_sensitivities(recording, PICTURES, run)
    rows = [user_rows(recording, held_out=kind) for kind in (False, True)]
    errors: Errors = {}
    for branch, channels in BRANCHES.items():
        for channel in range(channels.start, channels.stop, EVERY):
            one = slice(channel, channel + 1)
            kinds = [recording.subbands(one, own, held_out=bool(kind)) for kind, own in enumerate(rows)]
            for level, own in zip(Bands._fields, zip(*kinds, strict=True), strict=True):
                changes = getattr(sensitivities, level)[..., channel, :, :].reshape(own[0].shape[-2:])
                group = Group(branch, level)
                errors[group] = errors.get(group, 0) + left(own, changes, level, run.generator)
            print(f"channel {channel} of 23", file=sys.stderr, flush=True)
    return errors


def user_rows(recording: Recording, *, held_out: bool) -> np.ndarray:
    """Rows of a kind, evenly spaced, without those of the built-in range of motion."""
    clips = [clip for clip in recording.clips if clip.held_out == held_out]
    own = np.flatnonzero(np.repeat([not is_range(clip.name) for clip in clips], [len(clip.recorded) for clip in clips]))
    return own[np.linspace(0, len(own) - 1, min(len(own), FRAMES)).astype(int)]


def left(
    kinds: tuple[Tensor, ...],  # of each kind [F, ..., n, n] samples of one channel
    changes: Tensor,  # [n, n] of images by a unit of each sample
    level: str,
    generator: torch.Generator,
) -> np.ndarray:
    """Mean squared errors of images [1 + ranks, kinds]: of the mean, then of the best coefficients at each rank."""
    mean, scale = kinds[0].mean(0), changes.mean()
    worth = changes / scale if scale > 0 else torch.ones_like(changes)
    seen, unseen = ((own - mean).reshape(len(own), -1, *changes.shape) for own in kinds)
    flat = [(own * worth).flatten(1) for own in (seen, unseen)]
    nested = truncated_svd(flat[0], max(RANKS), generator=generator)[2]
    errors = [[float(own.square().sum() / len(own)) for own in flat]]
    for rank in RANKS:
        basis = nested[:rank].T
        if level != "ll":
            factors = separable_blendshapes(seen, rank, sweeps=SWEEPS, generator=generator, worth=worth)
            products = factors.basis().unflatten(1, seen.shape[1:]) * worth
            basis = torch.linalg.qr(products.flatten(1).double().T).Q.float()
        errors.append([float((own - own @ basis @ basis.T).square().sum() / len(own)) for own in flat])
    return scale.square().item() * np.array(errors)


if __name__ == "__main__":
    main()
