"""Colours of splats against scipy's spherical harmonics; how they are drawn is in test_splat_draw.py."""

import numpy as np
import pytest
from scipy.special import sph_harm_y

from mua import rotation
from mua.kernels.splat_draw import splat_colors


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
