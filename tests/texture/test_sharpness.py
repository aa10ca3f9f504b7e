"""How narrow surfels are where an image is busy, and how they lie along its lines."""

import numpy as np
import pytest

from mua import rotation
from mua.arrays import Array
from mua.texture.albedo import FINER, finer_picture
from mua.texture.sharpness import LONGER, NARROW, SPREAD, WIDE, Sharpness, along_lines, sharpness

SIZE = 16
SINGLE = 64 * float(np.finfo(np.float32).eps)  # a few products of float32


def wanted_by(gray: Array, alpha: int = 255) -> Sharpness:
    """The surfels that an image of greys [S, S] asks for."""
    channels = [gray, gray, gray, np.full_like(gray, alpha)]
    return sharpness(finer_picture(np.stack(channels, axis=2).astype(np.uint8), SIZE))


def stripes(degrees: float, *, apart: float = 4.0) -> Array:
    """Smooth stripes so many texels apart that change most in one direction, on an image four times as fine."""
    row, column = (np.indices((4 * SIZE, 4 * SIZE)) + 0.5) / 4
    angle = np.radians(degrees)
    return 127 + 120 * np.sin(2 * np.pi / apart * (np.cos(angle) * column + np.sin(angle) * row))


def test_an_even_picture_has_wide_round_surfels() -> None:
    found = wanted_by(np.full((SIZE, SIZE), 90))
    np.testing.assert_allclose(found.spreads, WIDE, atol=SINGLE)
    assert not found.longer.any()


def test_a_busy_picture_without_lines_has_narrow_round_surfels() -> None:
    checks = 200 * (np.indices((SIZE, SIZE)).sum(axis=0) % 2)
    found = wanted_by(checks)
    np.testing.assert_allclose(found.spreads, NARROW, atol=SINGLE)
    inner = np.zeros((SIZE, SIZE), bool)
    inner[4:-4, 4:-4] = True
    assert found.longer[inner.ravel()].max() < 0.2 * LONGER


@pytest.mark.parametrize("degrees", [0, 30, 45, 90, 120])
def test_surfels_are_long_along_stripes(degrees: float) -> None:
    found = wanted_by(stripes(degrees))
    inner = np.zeros((SIZE, SIZE), bool)
    inner[4:-4, 4:-4] = True
    inner = inner.ravel() & (found.longer > 0.5 * LONGER)
    assert inner.sum() > 20
    angle = np.radians(degrees)
    aligned = np.abs(found.across[inner] @ [np.cos(angle), np.sin(angle)])
    assert np.degrees(np.arccos(np.minimum(aligned, 1))).max() < 3


@pytest.mark.parametrize("alpha", [128, 253])
def test_what_lets_light_through_has_surfels_that_are_all_alike(alpha: int) -> None:
    assert wanted_by(stripes(30), alpha=254).longer.any()  # as good as solid
    found = wanted_by(stripes(30), alpha=alpha)
    assert np.all(found.spreads == SPREAD)
    assert not found.longer.any()


@pytest.mark.parametrize("shear", [0.0, 0.4])
def test_a_surfel_gets_longer_along_the_line_and_narrower_across_by_as_much(shear: float) -> None:
    rng = np.random.default_rng(0)
    count = 50
    frames = rotation.to_matrix(rotation.normalize(rng.normal(size=(count, 4))))
    extents = rng.uniform(1, 2, (count, 2))
    steps = np.array([[1.0, 0, 0], [shear, 1.5, 0]]) @ frames.transpose(0, 2, 1)
    angle, longer = rng.uniform(0, np.pi, count), rng.uniform(0.1, 0.4, count)
    wanted = Sharpness(np.full(count, SPREAD), np.stack([np.cos(angle), np.sin(angle)], axis=1), longer)
    turns, found = along_lines(frames, extents, steps=steps, wanted=wanted)
    assert np.abs(turns).max() <= np.pi / 4 + 1e-9
    line = np.stack([-np.sin(angle), np.cos(angle)], axis=1)  # a step along it in the texture, then on the surface
    along = np.einsum("nk,nkc,nci->ni", line, steps, frames[:, :, :2])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    before = extents[:, None] ** 2 * np.eye(2)
    cos, sin = np.cos(turns), np.sin(turns)
    axes = np.stack([cos, -sin, sin, cos], axis=1).reshape(-1, 2, 2)
    after = axes @ (found[:, None] ** 2 * np.eye(2)) @ axes.transpose(0, 2, 1)
    for direction, factor in ((along, np.exp(2 * longer)), (across, np.exp(-2 * longer))):
        lengths = [np.einsum("ni,nij,nj->n", direction, squares, direction) for squares in (before, after)]
        np.testing.assert_allclose(lengths[1], factor * lengths[0], rtol=1e-9)
    np.testing.assert_allclose(found.prod(axis=1), extents.prod(axis=1), rtol=1e-9)


def test_without_a_picture_surfels_stay_as_they_are() -> None:
    extents = np.array([[1.0, 2.0]])
    turns, found = along_lines(np.eye(3)[None], extents, steps=np.eye(3)[None, :2], wanted=None)
    assert not turns.any()
    np.testing.assert_array_equal(found, extents)


def test_points_of_a_finer_picture_lie_between_texels() -> None:
    ramp = np.repeat(np.arange(4 * SIZE)[None], 4 * SIZE, axis=0)
    found = finer_picture(np.stack([ramp, ramp, ramp, 0 * ramp + 255], axis=2).astype(np.uint8), SIZE)
    assert found.shape == (FINER * SIZE, FINER * SIZE, 4)
    expected = (np.arange(FINER * SIZE) + 0.5) * 4 / FINER - 0.5
    np.testing.assert_allclose(255 * found[3, :, 0], expected, atol=0.5)  # averages are rounded to bytes
