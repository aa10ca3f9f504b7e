"""Degree-1 spherical harmonics against their definition, evaluated direction by direction."""

import numpy as np
import pytest

from mua import rotation
from mua.channels import SH_C0, SH_C1
from mua.texture import sh

ROUNDING = 64 * float(np.finfo(np.float64).eps)  # a rotation and a sum of four products of values of about 1


def colors(coefficients: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """[N, M, 3] the colours that mua.channels defines, in M directions."""
    c0, c1, c2, c3 = coefficients.reshape(-1, 4, 1, 3).swapaxes(0, 1)
    x, y, z = directions.T[:, None, :, None]
    return 0.5 + SH_C0 * c0 + SH_C1 * (-y * c1 + z * c2 - x * c3)


def unit(rng: np.random.Generator, *shape: int) -> np.ndarray:
    return rotation.normalize(rng.standard_normal(shape))


@pytest.mark.parametrize("count", [0, 1, 7])
def test_rotated_coefficients_show_the_same_colours_in_rotated_directions(count: int) -> None:
    rng = np.random.default_rng(count)
    coefficients, q, directions = rng.standard_normal((count, 12)), unit(rng, count, 4), unit(rng, 101, 3)
    turned = sh.rotate(coefficients, q)
    for one, original, turn in zip(turned, coefficients, q, strict=True):
        there = rotation.rotate(turn, directions)
        seen = colors(one[None], there)
        np.testing.assert_allclose(seen, colors(original[None], directions), atol=ROUNDING)


def test_the_conjugate_undoes_a_rotation() -> None:
    rng = np.random.default_rng(0)
    coefficients, q = rng.standard_normal((5, 12)), unit(rng, 5, 4)
    back = sh.rotate(sh.rotate(coefficients, q), rotation.conjugate(q))
    np.testing.assert_allclose(back, coefficients, atol=ROUNDING)


def test_encoded_colour_changes_linearly_with_direction() -> None:
    rng = np.random.default_rng(0)
    color, slope, directions = rng.random((3, 3)), rng.standard_normal((3, 3, 3)), unit(rng, 17, 3)
    expected = color[:, None] + np.einsum("ncx,mx->nmc", slope, directions)
    np.testing.assert_allclose(colors(sh.encode(color, slope), directions), expected, atol=ROUNDING)
