"""Smoothing on a surface against the filter's own gain on waves."""

import numpy as np
from tube import tube

from mua.teachers.simulated.smoothing import low_pass


def test_low_pass_keeps_long_waves_and_halves_those_of_its_length() -> None:
    character = tube(rings=200, sides=7)
    height = character.mesh.vertices[:, 1]
    inner = np.abs(height - 0.875) < 0.4
    for ratio, gain in ((0.5, 1 / 5), (1.0, 1 / 2), (4.0, 16 / 17)):
        wave = np.sin(2 * np.pi * height / (0.12 * ratio))[:, None]
        smooth = low_pass(character.mesh.vertices, character.mesh.faces, 0.12)(wave)
        np.testing.assert_allclose(
            smooth[inner], gain * wave[inner], atol=0.02
        )  # edges of 9 mm: sampling, and the rims
