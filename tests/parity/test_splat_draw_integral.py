"""The integral of a Gaussian over a pixel against quadrature; how splats are blended is in test_splat_draw.py."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.kernels.splat_draw import pixel_integral

# The square's fourth cumulant, -1/120 along either axis, over 4!, times the Gaussian's fourth derivative, at most
# 3 / sigma^4; higher ones take a little more. Of splats smaller than a pixel, the largest error that quadrature finds.
CUMULANT_BOUND = 2 * 3 / 120 / 24
SMALL_BOUND = 0.09


def integral_bound(minor: Array) -> Array:
    return np.minimum(1.02 * CUMULANT_BOUND / minor**4, SMALL_BOUND)


def quadrature(x: Array, y: Array, angle: Array, major: Array, minor: Array) -> Array:
    """The integral over the upright unit square about (x, y), by 64 x 64 Gauss-Legendre points."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    u, v = x[:, None, None] + nodes[:, None] / 2, y[:, None, None] + nodes / 2
    c, s = np.cos(angle)[:, None, None], np.sin(angle)[:, None, None]
    along, across = c * u + s * v, c * v - s * u
    density = np.exp(-((along / major[:, None, None]) ** 2 + (across / minor[:, None, None]) ** 2) / 2)
    return np.asarray(np.einsum("i,j,nij->n", weights, weights, density) / 4)


def random_ellipses(count: int, least: float) -> tuple[Array, Array, Array, Array, Array]:
    """Pixel offsets x and y, angles and deviations from `least` to 30 pixels."""
    rng = np.random.default_rng(count)
    deviations = -np.sort(-np.exp(rng.uniform(np.log(least), np.log(30), (count, 2))), axis=1).T
    x, y = rng.normal(size=(2, count)) * deviations[0]
    return x, y, rng.uniform(-np.pi, np.pi, count), deviations[0], deviations[1]


def test_pixel_integral_of_upright_ellipses() -> None:
    x, y, _, major, minor = random_ellipses(400, 0.05)
    found = pixel_integral(x, y, major, minor)
    assert np.all(np.abs(found - quadrature(x, y, 0 * x, major, minor)) <= integral_bound(minor))


def test_pixel_integral_of_turned_ellipses() -> None:
    x, y, angle, major, minor = random_ellipses(401, 0.05)
    along, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    found = pixel_integral(along, across, major, minor)
    assert np.all(np.abs(found - quadrature(x, y, angle, major, minor)) <= integral_bound(minor))


def test_pixels_together_hold_all_of_a_gaussian() -> None:
    rows, columns = np.mgrid[-40:41, -40:41]
    for deviation, aliased in ((0.01, 0.04), (0.3, 1e-3), (5.0, 1e-9)):  # pixels sample the wider Gaussian
        total = pixel_integral(columns + 0.3, rows - 0.2, np.array(deviation), np.array(deviation)).sum()
        assert total == pytest.approx(2 * np.pi * deviation**2, rel=aliased)


def test_pixel_integral_keeps_float32_and_raises_no_warning_far_away() -> None:
    found = pixel_integral(np.float32([1e4]), np.float32([-1e4]), np.float32([0.01]), np.float32([0.01]))
    assert found.dtype == np.float32
    assert found == 0
