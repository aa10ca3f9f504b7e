"""Subbands in units of the texture, and bases that are fitted in them."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import torch
from synthetic_student import SETTINGS, SIZE, new_student, run_in
from torch import Tensor

from mua.channels import COARSE_TEXELS, STATIC_LEVELS
from mua.student.bases import factorize_branch
from mua.student.texture_metric import in_texture, to_subbands
from mua.wavelets import Bands, synthesise_lowpass, waverec2

FRAMES, CHANNELS, N = 20, 11, SIZE // COARSE_TEXELS
WAVELETS = ["spline3", "bior4.4", "db3"]
ROUNDING = SIZE * float(np.finfo(np.float32).eps)


def noise(frames: int = FRAMES) -> Bands:
    generator = torch.Generator().manual_seed(3)
    shapes = ((CHANNELS, N, N), (3, CHANNELS, N, N), (3, CHANNELS, 2 * N, 2 * N))
    return Bands(*(torch.randn(frames, *shape, generator=generator) for shape in shapes))


def texture(bands: Bands, wavelet: str) -> Tensor:
    quarter = waverec2(bands.ll, [bands.d3.transpose(1, 2), bands.d2.transpose(1, 2)], wavelet)
    return synthesise_lowpass(quarter, wavelet, STATIC_LEVELS)


def alone(bands: Bands, level: int, band: int) -> Bands:
    """The subbands with all but one at zero."""
    kept = Bands(*(torch.zeros_like(own) for own in bands))
    if level:
        kept[level][:, band] = bands[level][:, band]
    else:
        kept.ll.copy_(bands.ll)
    return kept


@pytest.mark.parametrize("wavelet", WAVELETS)
@pytest.mark.parametrize(("level", "band"), [(0, 0), *((level, band) for level in (1, 2) for band in range(3))])
def test_a_band_is_as_large_as_the_texture_that_it_makes(wavelet: str, level: int, band: int) -> None:
    bands = alone(noise(2), level, band)
    squares = sum(own.square().sum() for own in in_texture(bands, wavelet))
    torch.testing.assert_close(squares, texture(bands, wavelet).square().sum(), rtol=ROUNDING, atol=0)


@pytest.mark.parametrize("wavelet", WAVELETS)
def test_what_was_fitted_in_the_texture_is_given_in_subbands(wavelet: str) -> None:
    """A branch that is random in units of the texture synthesises there what it does in subbands afterwards."""
    branch, generator = new_student().geometry, torch.Generator().manual_seed(4)
    with torch.no_grad():
        for tensor in (
            branch.ll_mean,
            branch.ll_basis,
            *branch.d3.state_dict().values(),
            *branch.d2.state_dict().values(),
        ):
            tensor.normal_(generator=generator)
        alphas = branch.split(torch.randn(2, branch.channels * branch.ranks.total, generator=generator))
        before = branch.synthesize(alphas)
        for channel in range(branch.channels):
            to_subbands(branch, channel, wavelet)
        after = in_texture(branch.synthesize(alphas), wavelet)
    for own, expected in zip(after, before, strict=True):
        bound = 10 * ROUNDING * float(expected.abs().max())
        torch.testing.assert_close(own, expected, rtol=0, atol=bound)


def test_bases_of_splines_leave_less_of_a_texture_where_they_are_fitted_in_it(tmp_path: Path) -> None:
    bands, left = noise(), []

    def source(channels: slice, rows: Tensor) -> Bands:
        return Bands(*(band[rows] for band in bands.of(channels)))

    fit = partial(factorize_branch, frames=FRAMES, settings=SETTINGS, stage="bases")
    for number, wavelet in enumerate((None, "spline3")):
        branch = new_student().geometry
        (tmp_path / str(number)).mkdir()
        flat, _ = fit(branch, source, run=run_in(tmp_path / str(number), []), wavelet=wavelet)
        with torch.no_grad():
            missed = Bands(
                *(one - other for one, other in zip(branch.synthesize(branch.split(flat)), bands, strict=True))
            )
        left.append(float(texture(missed, "spline3").square().mean()))
    assert left[1] < left[0]
