"""Sampling of a character's atlas."""

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from mua.atlas.filtering import CLEAR, TRACE
from mua.texture.albedo import sample_albedo

SINGLE = 8 * float(np.finfo(np.float32).eps)  # four products of values up to 1


@pytest.mark.parametrize("side", [1, 7, 16])
def test_bilinear_as_scipy_samples(side: int) -> None:
    rng = np.random.default_rng(side)
    atlas = rng.integers(CLEAR, 256, (side, side, 4), dtype=np.uint8)
    uv = rng.random((50, 2))
    places = np.stack([uv[:, 1], uv[:, 0]]) * side - 0.5
    alpha = (atlas[..., 3:] + TRACE) / 255
    planes = np.concatenate([atlas[..., :3] / 255 * alpha, atlas[..., 3:] / 255], axis=2)
    channels = [map_coordinates(planes[..., c], places, order=1, mode="nearest") for c in range(4)]
    channels[:3] = [
        channel / map_coordinates(alpha[..., 0], places, order=1, mode="nearest") for channel in channels[:3]
    ]
    position = 2 * side * float(np.finfo(np.float32).eps)  # weights are rounded to float32
    np.testing.assert_allclose(sample_albedo(atlas, uv, 32), np.stack(channels, axis=1), atol=SINGLE + position)


def test_a_finer_atlas_is_averaged() -> None:
    checks = (255 * (np.indices((64, 64)).sum(axis=0) % 2)).astype(np.uint8)
    atlas = np.stack([checks, checks, checks, np.full_like(checks, 255)], axis=2)
    colors = sample_albedo(atlas, np.random.default_rng(0).random((20, 2)), 16)
    np.testing.assert_allclose(colors[:, :3], 0.5, atol=1 / 255)


def test_what_is_transparent_lends_no_colour_when_averaged() -> None:
    checks = (255 * (np.indices((64, 64)).sum(axis=0) % 2)).astype(np.uint8)
    atlas = np.stack([checks, checks, checks, checks], axis=2)
    colors = sample_albedo(atlas, np.random.default_rng(0).random((20, 2)), 16)
    np.testing.assert_allclose(colors, np.tile([1, 1, 1, 0.5], (20, 1)), atol=1 / 255)


def test_what_is_clear_has_the_colour_of_the_nearest_that_is_not() -> None:
    atlas = np.zeros((4, 4, 4), np.uint8)
    atlas[:, :2] = 255
    colors = sample_albedo(atlas, np.array([[0.45, 0.5], [0.7, 0.5], [0.9, 0.1]]), 4)
    np.testing.assert_allclose(colors[:, :3], 1, atol=SINGLE)
    np.testing.assert_allclose(colors[:, 3], [0.7, 0, 0], atol=SINGLE)


def test_no_points() -> None:
    assert sample_albedo(np.zeros((4, 4, 4), np.uint8), np.zeros((0, 2)), 4).shape == (0, 4)
