"""The pixel integral against quadrature, blending against a loop, colours against scipy's spherical harmonics."""

import numpy as np
import pytest
from scipy.special import ndtr, sph_harm_y

from mua import rotation
from mua.arrays import Array
from mua.kernels import splat_draw as kernel
from mua.kernels.splat_draw import MOST_ALPHA, pixel_integral, splat_colors, splat_draw
from mua.kernels.splat_project import half_lengths

# How far the logistic S(x) and its slope lie from the normal distribution and its density, at most, over all x.
CUMULATIVE_BOUND = 4e-4
DENSITY_BOUND = 1.1e-3
# Turning the unit square changes only its moments of fourth order and above: by up to 1/240 each. The Gaussian's fourth
# derivatives are at most 3 / sigma^4 each, so the integral changes by at most (1 + 1 + 6) 3 / 24 / 240 / sigma^4.
TURN_BOUND = 1 / 240

SCREENS = [(1, 1), (1, 7), (13, 5), (31, 29)]


def test_logistic_stays_within_its_stated_bounds() -> None:
    x = np.linspace(-12, 12, 240_001)
    approximate = kernel._cumulative(x)
    assert np.max(np.abs(approximate - ndtr(x))) < CUMULATIVE_BOUND
    density = np.exp(-x * x / 2) / np.sqrt(2 * np.pi)
    assert np.max(np.abs(np.gradient(approximate, x) - density)) < DENSITY_BOUND


def integral_bound(major: Array, minor: Array) -> Array:
    """Error of the product of two masses, each off by at most twice the one bound or the other over the deviation."""
    sides = np.stack([major, minor])
    mass = np.minimum(1, 0.4 / sides)
    off = np.minimum(2 * CUMULATIVE_BOUND, DENSITY_BOUND / sides)
    return np.asarray(2 * np.pi * major * minor * (mass[0] * off[1] + mass[1] * off[0] + off[0] * off[1]))


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
    assert np.all(np.abs(found - quadrature(x, y, 0 * x, major, minor)) <= integral_bound(major, minor))


def test_pixel_integral_of_turned_ellipses() -> None:
    x, y, angle, major, minor = random_ellipses(401, 0.5)
    along, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    found = pixel_integral(along, across, major, minor)
    bound = integral_bound(major, minor) + TURN_BOUND / minor**4
    assert np.all(np.abs(found - quadrature(x, y, angle, major, minor)) <= bound)


def test_pixels_together_hold_all_of_a_gaussian() -> None:
    rows, columns = np.mgrid[-40:41, -40:41]
    for deviation in (0.01, 0.3, 5.0):
        total = pixel_integral(columns + 0.3, rows - 0.2, np.array(deviation), np.array(deviation)).sum()
        assert total == pytest.approx(2 * np.pi * deviation**2, rel=1e-9)


def test_pixel_integral_keeps_float32_and_raises_no_warning_far_away() -> None:
    found = pixel_integral(np.float32([1e4]), np.float32([-1e4]), np.float32([0.01]), np.float32([0.01]))
    assert found.dtype == np.float32
    assert found == 0


def random_scene(count: int, screen: tuple[int, int]) -> tuple[Array, Array, Array, Array]:
    """Ellipses in and around the screen, colours, opacities and a back-to-front order."""
    rng = np.random.default_rng(count)
    angle = rng.uniform(-np.pi, np.pi, count)
    deviations = -np.sort(-np.exp(rng.uniform(-2, 2, (count, 2))), axis=1)
    middle = rng.uniform(-0.3, 1.3, (count, 2)) * screen
    ellipses = np.concatenate([middle, np.cos(angle)[:, None], np.sin(angle)[:, None], deviations], axis=1)
    return ellipses, rng.random((count, 3)), rng.uniform(0.01, 1, count), rng.permutation(count)


def painted(ellipses: Array, colors: Array, opacities: Array, order: Array, screen: tuple[int, int]) -> Array:
    """Each splat painted over the image, back to front, on all pixels whose centre lies in its quad."""
    row, column = np.mgrid[: screen[1], : screen[0]] + 0.5
    image = np.zeros((screen[1], screen[0], 4))
    for splat in order:
        x, y, cosine, sine, major, minor = ellipses[splat]
        along = cosine * (column - x) + sine * (row - y)
        across = cosine * (row - y) - sine * (column - x)
        reach = half_lengths(ellipses[[splat]], opacities[[splat]])[0]
        inside = (np.abs(along) <= reach[0]) & (np.abs(across) <= reach[1])
        alpha = np.minimum(opacities[splat] * pixel_integral(along, across, major, minor), MOST_ALPHA) * inside
        image = image * (1 - alpha[..., None]) + alpha[..., None] * np.append(colors[splat], 1)
    return image


def running_sum_bound(count: int, screen: tuple[int, int]) -> float:
    """Rounding of transmittances that are differences of one running sum over all pairs of splat and pixel."""
    largest_sum = -np.log(1 - MOST_ALPHA) * count * screen[0] * screen[1]
    return float(np.finfo(float).eps * max(largest_sum, 1))


@pytest.mark.parametrize("screen", SCREENS)
@pytest.mark.parametrize("count", [0, 1, 7, 211])
def test_equals_painting_back_to_front(count: int, screen: tuple[int, int]) -> None:
    scene = random_scene(count, screen)
    image = splat_draw(*scene, screen=screen)
    assert image.shape == (screen[1], screen[0], 4)
    np.testing.assert_allclose(image, painted(*scene, screen), rtol=0, atol=running_sum_bound(count, screen))


def test_neither_bands_nor_chunks_show(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = random_scene(211, (31, 29))
    whole = splat_draw(*scene, screen=(31, 29))
    monkeypatch.setattr(kernel, "BAND_PIXELS", 70)
    monkeypatch.setattr(kernel, "CHUNK_PAIRS", 101)
    bound = running_sum_bound(211, (31, 29))
    np.testing.assert_allclose(splat_draw(*scene, screen=(31, 29)), whole, rtol=0, atol=bound)


def test_draws_nothing_of_what_this_eye_does_not_see() -> None:
    ellipses, colors, opacities, order = random_scene(7, (13, 5))
    ellipses[:, 4:6] = 0
    assert not splat_draw(ellipses, colors, opacities, order, screen=(13, 5)).any()


def test_float32_scene_draws_as_float64() -> None:
    scene = [a.astype(np.float32) for a in random_scene(31, (13, 5))[:3]]
    order = np.arange(31)
    exact = splat_draw(*(a.astype(float) for a in scene), order, screen=(13, 5))
    # Offsets of up to 20 pixels, in units of deviations of at least exp(-2), through 8 operations, then 31 blends.
    bound = 31 * 8 * 20 * np.exp(2) * np.finfo(np.float32).eps
    np.testing.assert_allclose(splat_draw(*scene, order, screen=(13, 5)), exact, rtol=0, atol=bound)


def test_colours_equal_real_spherical_harmonics() -> None:
    rng = np.random.default_rng(0)
    centres, camera, sh = rng.normal(size=(101, 3)), np.array([3.0, 1, 2]), 0.1 * rng.normal(size=(101, 12))
    texel_dq = np.tile([1.0, 0, 0, 0, 0, 0, 0, 0], (101, 1))
    x, y, z = ((centres - camera) / np.linalg.norm(centres - camera, axis=1, keepdims=True)).T
    polar, azimuth = np.arccos(z), np.arctan2(y, x)
    positive = sph_harm_y(1, 1, polar, azimuth)  # with the Condon-Shortley phase, as the 3DGS constants have it
    basis = [sph_harm_y(0, 0, polar, azimuth).real, np.sqrt(2) * positive.imag, sph_harm_y(1, 0, polar, azimuth).real]
    basis.append(np.sqrt(2) * positive.real)
    expected = np.maximum(0.5 + np.einsum("kn,nkc->nc", basis, sh.reshape(-1, 4, 3)), 0)
    np.testing.assert_allclose(splat_colors(centres, texel_dq, sh, camera), expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_colours_turn_with_the_body(dtype: type) -> None:
    rng = np.random.default_rng(1)
    centres, camera, sh = rng.normal(size=(31, 3)), np.array([3.0, 1, 2]), rng.normal(size=(31, 12))
    turn = rotation.normalize(rng.normal(size=4))
    still = np.tile([1.0, 0, 0, 0, 0, 0, 0, 0], (31, 1))
    turned = np.tile(np.append(turn, np.zeros(4)), (31, 1))
    expected = splat_colors(centres, still, sh, camera)
    arguments = rotation.rotate(turn, centres), turned, sh, rotation.rotate(turn, camera)
    found = splat_colors(*(a.astype(dtype) for a in arguments))
    assert found.dtype == dtype
    np.testing.assert_allclose(found, expected, rtol=0, atol=64 * np.finfo(dtype).eps * np.abs(sh).max())


def test_colours_are_not_negative_nor_nan_at_the_camera_itself() -> None:
    camera = np.array([1.0, 2, 3])
    colors = splat_colors(camera[None], np.eye(1, 8), np.full((1, 12), -9.0), camera)
    np.testing.assert_array_equal(colors, 0)
