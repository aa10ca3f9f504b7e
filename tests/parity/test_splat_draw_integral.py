"""The window drawn for a Gaussian against its integral by quadrature; blending is in test_splat_draw.py."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.kernels.splat_draw import pixel_share
from mua.kernels.splat_project import PIXEL_VARIANCE, REACH

WINDOW_BOUND = float(np.exp(-(REACH**2) / 2))  # where the window ends, the Gaussian is so large yet


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


@pytest.mark.parametrize("turned", [0, 1])
def test_the_window_is_near_the_integral_over_a_pixel(turned: int) -> None:
    x, y, angle, major, minor = random_ellipses(400, 0.05)
    angle *= turned
    ellipses = np.stack([0 * x, 0 * y, np.cos(angle), np.sin(angle), major, minor], axis=1)
    found = pixel_share(np.stack([x, y], axis=1), ellipses)
    assert np.all(np.abs(found - quadrature(x, y, angle, major, minor)) <= WINDOW_BOUND)


def slanting(major: float, minor: float, *, angle: float = 0.7) -> np.ndarray:
    return np.array([0, 0, np.cos(angle), np.sin(angle), major, minor])


@pytest.mark.parametrize(("major", "minor"), [(0.01, 0.01), (0.3, 0.3), (5.0, 5.0), (6.0, 0.5)])
def test_the_window_holds_all_of_a_gaussian(major: float, minor: float) -> None:
    """And the variance of a pixel whole along any line, beside what the window has of the splat's."""
    ellipse = slanting(major, minor)
    side = 1.5 * REACH * np.sqrt(major**2 + PIXEL_VARIANCE)
    step = (np.arange(2000) + 0.5) / 2000 * 2 - 1
    offsets = side * np.stack(np.meshgrid(step, step), axis=-1)
    shares = pixel_share(offsets, ellipse)
    assert shares.mean() * (2 * side) ** 2 == pytest.approx(2 * np.pi * major * minor, rel=1e-3)
    axis = ellipse[2:4]
    for line, deviation in ((axis, major), (np.array([-axis[1], axis[0]]), minor)):
        variance = np.sum(shares * (offsets @ line) ** 2) / np.sum(shares)
        assert variance == pytest.approx(REACH**2 / 5 * deviation**2 + 1 / 12, rel=1e-3)


def test_where_the_axes_of_a_round_ellipse_lie_changes_nothing() -> None:
    offsets = np.random.default_rng(1).normal(size=(100, 2))
    level, turned = (pixel_share(offsets, slanting(1, 1 - 1e-6, angle=angle)) for angle in (0.0, 0.7))
    np.testing.assert_allclose(turned, level, rtol=0, atol=1e-5)


def test_pixels_together_hold_about_all_of_a_gaussian() -> None:
    rows, columns = np.mgrid[-40:41, -40:41]
    for deviation, aliased in ((0.3, 0.2), (1.0, 0.02), (5.0, 1e-3)):  # pixels sample the window
        total = pixel_share(np.stack([columns + 0.3, rows - 0.2], axis=-1), slanting(deviation, deviation)).sum()
        assert total == pytest.approx(2 * np.pi * deviation**2, rel=aliased)


def test_the_window_keeps_float32_and_raises_no_warning_far_away() -> None:
    found = pixel_share(np.array([1e4, -1e4], np.float32), np.array([0, 0, 0.6, 0.8, 0.01, 0.01], np.float32))
    assert found.dtype == np.float32
    assert found == 0
