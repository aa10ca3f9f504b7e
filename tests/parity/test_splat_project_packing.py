"""Splats, texels and keys in the words of a GPU; how splats are projected is in test_splat_project.py."""

import numpy as np
import pytest
from packed_splats import LARGEST_HALF, color_scales, colors_of, opacities_of, unpacked

from mua.arrays import Array
from mua.kernels.splat_project import HIDDEN, pack_colors, pack_keys, pack_splats, pack_texels

COUNTS = [0, 1, 7, 503]


def random_splats_to_pack(count: int) -> tuple[Array, Array, Array, Array]:
    """Centres; colours of two eyes, a little apart; opacities; ellipses of two eyes."""
    rng = np.random.default_rng(count)
    angles, deviations = rng.uniform(-np.pi, np.pi, (2, count)), rng.uniform(0.1, 50, (2, count, 2))
    axes = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    ellipses = np.concatenate([rng.normal(size=(2, count, 2)), axes, deviations], axis=-1)
    colors = rng.uniform(0.06, 0.94, (count, 3)) + rng.uniform(-0.06, 0.06, (2, count, 3))
    return rng.normal(size=(count, 3)), colors, rng.random(count), ellipses


@pytest.mark.parametrize("count", COUNTS)
def test_packed_splat_holds_two_eyes_in_32_bytes(count: int) -> None:
    centres, colors, opacities, ellipses = random_splats_to_pack(count)
    packed = pack_splats(centres, colors, opacities, ellipses)
    assert packed.dtype == np.uint32
    assert packed.shape == (count, 8)
    fields = unpacked(packed)
    np.testing.assert_array_equal(fields["centre"], centres.astype(np.float32))
    np.testing.assert_allclose(
        colors_of(fields), colors, rtol=0, atol=(1 + 1e-9) / 1023
    )  # half of a step each of mean and tint
    np.testing.assert_allclose(opacities_of(fields), opacities, rtol=0, atol=(1 + 1e-9) * 0.5 / 2047)
    for eye in (0, 1):
        axes = ellipses[eye, :, 2:4] * ellipses[eye, :, 4:5]
        np.testing.assert_array_equal(fields["axes"][:, eye], axes.astype(np.float16))
        np.testing.assert_array_equal(fields["minors"][:, eye], ellipses[eye, :, 5].astype(np.float16))


def test_one_eye_stands_in_both_places_of_a_packed_splat() -> None:
    centres, colors, opacities, ellipses = random_splats_to_pack(7)
    one = unpacked(pack_splats(centres, colors[:1], opacities, ellipses[:1]))
    np.testing.assert_array_equal(*colors_of(one))
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
    fields = unpacked(pack_splats(np.zeros((1, 3)), np.full((1, 1, 3), 1e9), np.ones(1), ellipse))
    np.testing.assert_allclose(fields["axes"][0, 0].astype(float), LARGEST_HALF * np.array([0.6, 0.8]), rtol=2**-11)
    np.testing.assert_array_equal(fields["minors"][0], [LARGEST_HALF] * 2)


@pytest.mark.parametrize(
    ("mean", "tint", "scale"),
    [(0.1, 0, 1), (1, 0, 1), (1, 0.05, 1), (1.2, 0.05, 2), (0.2, 0.15, 4), (3, 0.2, 4), (7, 0.3, 8)],
)
def test_the_scale_of_colours_is_the_least_that_holds_mean_and_tint(mean: float, tint: float, scale: float) -> None:
    colors = np.array([mean + tint, mean - tint])[:, None, None].repeat(3, axis=2)
    fields = unpacked(pack_splats(np.zeros((1, 3)), colors, np.ones(1), np.ones((1, 1, 6))))
    assert color_scales(fields) == scale
    np.testing.assert_allclose(colors_of(fields), colors, rtol=0, atol=(1 + 1e-9) * scale / 1023)


def test_colours_are_packed_bit_for_bit() -> None:
    colors = np.array([[[0.0, 0.5, 1.0]], [[0.0, 0.49, 1.0]]])  # the scale is 1; steps 0, 506.385, 1023 and tint 5.115
    word, other = pack_colors(colors, np.array([0.5]))[0]
    assert word == 0 | 506 << 10 | 1023 << 20 | 0 << 30
    assert other == 1024 | 64 << 11 | 69 << 18 | 64 << 25


def test_colours_beyond_the_largest_scale_are_held_there() -> None:
    fields = unpacked(pack_splats(np.zeros((1, 3)), np.full((1, 1, 3), 1e9), np.ones(1), np.ones((1, 1, 6))))
    np.testing.assert_allclose(colors_of(fields), 8, rtol=1e-12)


def test_packed_texels_hold_barycentrics_in_16_bits() -> None:
    words = pack_texels(np.array([5, 7]), np.array([[0.25, 1, 0], [0, 0.5, 0.5]]))
    np.testing.assert_array_equal(words, [[5, 0xFFFF4000], [7, 0x80000000]])


@pytest.mark.parametrize("keys", [[], [7], [7, 9], [1, 2, HIDDEN]])
def test_two_keys_lie_in_a_word(keys: list[int]) -> None:
    found = pack_keys(np.array(keys, np.uint16)).view(np.uint16)
    np.testing.assert_array_equal(found, keys + [HIDDEN] * (len(keys) % 2))
