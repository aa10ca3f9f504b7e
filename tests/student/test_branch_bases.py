"""Bases of a branch in closed form: residuals, reports, and the coefficients that fit them best."""

from pathlib import Path

import pytest
import torch
from synthetic_student import SETTINGS, SIZE, bands_of_frames, new_student, random_student, run_in
from torch import Tensor

from mua.channels import CHANNELS, GEOMETRY
from mua.student.bases import BestCoefficients, factorize_branch, worth_of
from mua.training.optimise import Progress
from mua.wavelets import Bands

FRAMES = 12


def geometry(channels: slice, rows: Tensor) -> Bands:
    own = bands_of_frames(FRAMES)[1].of(GEOMETRY).of(channels)
    return Bands(*(band[rows] for band in own))


@torch.no_grad()
def test_bases_come_with_coefficients_and_the_variance_of_a_texel_and_are_kept(tmp_path: Path) -> None:
    reports: list[Progress] = []
    solved = []
    for _ in range(2):
        branch = new_student().geometry
        flat, variance = factorize_branch(
            branch, geometry, frames=FRAMES, settings=SETTINGS, stage="bases", run=run_in(tmp_path, reports)
        )
        solved.append((flat, variance, branch.ll_basis.clone()))
    assert [(one.step, one.steps) for one in reports] == [(k, branch.channels) for k in range(1, branch.channels + 1)]
    assert all(torch.equal(*pair) for pair in zip(*solved, strict=True))
    bands = geometry(slice(0, branch.channels), torch.arange(FRAMES))
    away = [(band - band.mean(0)).square().sum(0) for band in bands]
    energy = away[0].sum((1, 2)) + sum(one.sum((0, 2, 3)) for one in away[1:])
    torch.testing.assert_close(variance, energy / (FRAMES * SIZE**2))
    ll = branch.synthesize(branch.split(flat)).ll  # whose blendshapes are more than the factors behind the frames
    torch.testing.assert_close(ll, bands.ll, rtol=1e-3, atol=1e-4)


@torch.no_grad()
def test_coefficients_of_blendshapes_that_are_nearly_alike_are_found() -> None:
    branch = random_student().geometry
    branch.ll_basis[:, 1] = branch.ll_basis[:, 0] + 0.03 * branch.ll_basis[:, 1]
    generator = torch.Generator().manual_seed(1)
    alphas = branch.split(torch.randn(5, branch.channels * branch.ranks.total, generator=generator))
    bands = branch.synthesize(alphas)
    found = branch.synthesize(BestCoefficients(branch)(bands))
    torch.testing.assert_close(found.ll, bands.ll, rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize("channel", [0, 22])
def test_samples_count_for_one_on_average(channel: int) -> None:
    """In whatever unit pictures are measured; equally where they show nothing."""
    generator = torch.Generator().manual_seed(2)
    shapes = ((1, CHANNELS, 3, 3), (1, 1, CHANNELS, 3, 3), (1, 1, CHANNELS, 6, 6))
    seen = Bands(*(7 * torch.rand(shape, generator=generator) for shape in shapes))
    seen.d2[:, :, channel] = 0
    ll, d3, d2 = worth_of(seen, channel)
    assert (float(ll.mean()), float(d3.mean())) == (pytest.approx(1), pytest.approx(1))
    torch.testing.assert_close(ll / ll[0, 0], seen.ll[0, channel] / seen.ll[0, channel, 0, 0])
    assert torch.equal(d2, torch.ones(6, 6))
