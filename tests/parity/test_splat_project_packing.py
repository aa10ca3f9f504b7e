"""Splats, texels and keys in the words of a GPU; how splats are projected is in test_splat_project.py."""

import numpy as np
import pytest
from packed_splats import LARGEST_HALF, unpacked

from mua.arrays import Array
from mua.kernels.splat_project import HIDDEN, pack_keys, pack_splats, pack_texels

COUNTS = [0, 1, 7, 503]


def random_splats_to_pack(count: int) -> tuple[Array, Array, Array, Array]:
    """Centres, colours, opacities and ellipses of two eyes."""
    rng = np.random.default_rng(count)
    angles, deviations = rng.uniform(-np.pi, np.pi, (2, count)), rng.uniform(0.1, 50, (2, count, 2))
    axes = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    ellipses = np.concatenate([rng.normal(size=(2, count, 2)), axes, deviations], axis=-1)
    return rng.normal(size=(count, 3)), rng.random((count, 3)), rng.random(count), ellipses


@pytest.mark.parametrize("count", COUNTS)
def test_packed_splat_holds_floats_and_half_floats_in_32_bytes(count: int) -> None:
    centres, colors, opacities, ellipses = random_splats_to_pack(count)
    packed = pack_splats(centres, colors, opacities, ellipses)
    assert packed.dtype == np.uint32
    assert packed.shape == (count, 8)
    fields = unpacked(packed)
    np.testing.assert_array_equal(fields["centre"], centres.astype(np.float32))
    np.testing.assert_array_equal(fields["color"], colors.astype(np.float16))
    np.testing.assert_array_equal(fields["opacity"], opacities.astype(np.float16))
    for eye in (0, 1):
        axes = ellipses[eye, :, 2:4] * ellipses[eye, :, 4:5]
        np.testing.assert_array_equal(fields["axes"][:, eye], axes.astype(np.float16))
        np.testing.assert_array_equal(fields["minors"][:, eye], ellipses[eye, :, 5].astype(np.float16))


def test_one_eye_stands_in_both_places_of_a_packed_splat() -> None:
    centres, colors, opacities, ellipses = random_splats_to_pack(7)
    one = unpacked(pack_splats(centres, colors, opacities, ellipses[:1]))
    np.testing.assert_array_equal(one["axes"][:, 0], one["axes"][:, 1])
    np.testing.assert_array_equal(one["minors"][:, 0], one["minors"][:, 1])


def test_a_packed_ellipse_keeps_its_direction_and_its_size() -> None:
    ellipses = random_splats_to_pack(503)[3]
    fields = unpacked(pack_splats(*random_splats_to_pack(503)[:3], ellipses))
    axes = fields["axes"][:, 0].astype(float)
    cosine = np.sum(axes * ellipses[0, :, 2:4], axis=1) / np.linalg.norm(axes, axis=1)
    assert np.all(np.arccos(np.minimum(cosine, 1)) < 2**-10)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), ellipses[0, :, 4], rtol=2**-11)


def test_what_half_floats_cannot_hold_is_held_at_the_largest() -> None:
    ellipse = np.array([[[0, 0, 0.6, 0.8, 1e9, 1e7]]])
    fields = unpacked(pack_splats(np.zeros((1, 3)), np.full((1, 3), 1e9), np.ones(1), ellipse))
    np.testing.assert_allclose(fields["axes"][0, 0].astype(float), LARGEST_HALF * np.array([0.6, 0.8]), rtol=2**-11)
    np.testing.assert_array_equal(fields["minors"][0], [LARGEST_HALF] * 2)
    np.testing.assert_array_equal(fields["color"], [[LARGEST_HALF] * 3])


def test_packed_texels_hold_barycentrics_in_16_bits() -> None:
    words = pack_texels(np.array([5, 7]), np.array([[0.25, 1, 0], [0, 0.5, 0.5]]))
    np.testing.assert_array_equal(words, [[5, 0xFFFF4000], [7, 0x80000000]])


@pytest.mark.parametrize("keys", [[], [7], [7, 9], [1, 2, HIDDEN]])
def test_two_keys_lie_in_a_word(keys: list[int]) -> None:
    found = pack_keys(np.array(keys, np.uint16)).view(np.uint16)
    np.testing.assert_array_equal(found, keys + [HIDDEN] * (len(keys) % 2))
