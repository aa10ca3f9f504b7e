"""Surfels of a sheet that lets light through, laid over each other one by one."""

import numpy as np
import pytest

from mua.texture.sharpness import SPREAD
from mua.texture.sheet_opacity import surfel_opacities

BY_PLACE = 0.01  # a mean over a thousand places


@pytest.mark.parametrize("alpha", [0.05, 0.3, 0.5, 0.9])
def test_surfels_together_hide_what_the_sheet_hides(alpha: float) -> None:
    (opacity,) = surfel_opacities(np.array([alpha]))
    places = np.random.default_rng(0).uniform(8, 9, (1000, 2))
    through = np.ones(len(places))
    for x in range(17):
        for y in range(17):
            square = ((places - (x, y)) ** 2).sum(axis=1)
            through *= 1 - opacity * np.exp(-square / (2 * SPREAD**2))
    assert 1 - through.mean() == pytest.approx(alpha, abs=BY_PLACE)


def test_what_is_clear_stays_clear_and_what_is_solid_solid() -> None:
    assert surfel_opacities(np.array([0.0, 1.0])).tolist() == [0, 1]
