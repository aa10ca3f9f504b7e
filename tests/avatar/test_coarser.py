"""Levels of fewer texels: what becomes of a block of four, and when a level is refused."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic_avatar import empty_avatar, sparse_avatar, synthetic_avatar, with_surface, with_texels

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.write import encode
from mua.avatar.coarser import REACH, at_level, coarsest, texel_length
from mua.errors import InputError
from mua.limits import GROWTH
from mua.rig.texel_map import TexelMap

SCALES = slice(7, 10)
SINGLE = 4 * float(np.finfo(np.float32).eps)


def block(avatar: Avatar, members: list[int]) -> Avatar:
    """The avatar with some of the four texels of one block alone, all at one place of the mesh."""
    texels = avatar.rig.texels
    numbers = block_numbers(texels)
    full = np.flatnonzero(np.bincount(numbers) == 4)[0]
    few = with_texels(avatar, np.isin(np.arange(len(numbers)), np.flatnonzero(numbers == full)[members]))
    held = few.rig.texels
    alone = replace(held, triangles=np.zeros_like(held.triangles), barycentrics=np.full_like(held.barycentrics, 1 / 3))
    return replace(few, rig=replace(few.rig, texels=alone))


def block_numbers(texels: TexelMap) -> Array:
    """The number of the block [N] of each texel, row * size / 2 + column."""
    row, column = np.divmod(texels.texels, texels.size)
    return np.asarray(row // 2 * (texels.size // 2) + column // 2)


def with_static(avatar: Avatar, static: Array) -> Avatar:
    return replace(avatar, geometry=replace(avatar.geometry, static=static.astype(np.float32)))


@pytest.mark.parametrize("members", [[0], [1, 2], [0, 1, 3], [0, 1, 2, 3]])
def test_a_texel_is_the_mean_of_its_block_and_grows_with_their_number(members: list[int]) -> None:
    avatar = block(synthetic_avatar(), members)
    rng = np.random.default_rng(0)
    static = rng.normal(0, 1e-3, (11, len(members)))
    coarse = at_level(with_static(avatar, static), 1)
    expected = static.mean(axis=1)
    expected[SCALES] += np.log(GROWTH) * np.log2(len(members)) / 2
    np.testing.assert_allclose(coarse.geometry.static[:, 0], expected, rtol=0, atol=SINGLE)
    exact = avatar.appearance.static.astype(float).mean(axis=1)
    np.testing.assert_allclose(coarse.appearance.static[:, 0], exact, rtol=SINGLE, atol=SINGLE)
    assert coarse.rig.texels.size == avatar.rig.texels.size // 2
    assert coarse.rig.texels.texels.tolist() == block_numbers(avatar.rig.texels)[:1].tolist()


@pytest.mark.parametrize(("hidden", "expected"), [([True] * 3, True), ([True, False, True], False)])
def test_a_block_is_one_sided_where_all_of_it_is(hidden: list[bool], expected: bool) -> None:
    avatar = block(synthetic_avatar(), [0, 1, 3])
    texels = replace(avatar.rig.texels, one_sided=np.array(hidden))
    coarse = at_level(replace(avatar, rig=replace(avatar.rig, texels=texels)), 1)
    assert coarse.rig.texels.one_sided is not None
    assert coarse.rig.texels.one_sided.tolist() == [expected]


def test_quaternions_of_opposite_signs_do_not_cancel() -> None:
    avatar = block(synthetic_avatar(), [0, 1])
    static = np.zeros((11, 2))
    static[3] = 1, -1
    np.testing.assert_array_equal(at_level(with_static(avatar, static), 1).geometry.static[3:7, 0], [1, 0, 0, 0])


def test_what_lies_far_apart_is_not_merged() -> None:
    """The texel that has more others near it stays; the one that is far away is left out."""
    avatar = block(synthetic_avatar(), [0, 1, 2])
    static = np.zeros((11, 3))
    static[0] = 1.001 * REACH * texel_length(avatar), 0, 0
    coarse = at_level(with_static(avatar, static), 1)
    np.testing.assert_allclose(coarse.geometry.static[0], 0, rtol=0, atol=SINGLE)
    static[0] *= 0.99
    coarse = at_level(with_static(avatar, static), 1)
    np.testing.assert_allclose(coarse.geometry.static[0], static[0].mean(), rtol=SINGLE, atol=SINGLE)


def test_a_texel_takes_its_place_from_one_of_its_block() -> None:
    avatar = sparse_avatar(1)
    texels, coarse = avatar.rig.texels, at_level(avatar, 1).rig.texels
    held: dict[int, list[tuple[int, list[float]]]] = {}
    for number, triangle, point in zip(block_numbers(texels), texels.triangles, texels.barycentrics, strict=True):
        held.setdefault(int(number), []).append((int(triangle), point.tolist()))
    assert coarse.texels.tolist() == sorted(held)
    for texel, triangle, point in zip(coarse.texels, coarse.triangles, coarse.barycentrics, strict=True):
        assert (int(triangle), point.tolist()) in held[int(texel)]


def test_a_texel_lies_in_the_middle_of_its_block() -> None:
    """Wherever on the mesh its place is taken from."""
    avatar = block(synthetic_avatar(), [0, 1, 3])
    barycentrics = np.array([[0.34, 0.33, 0.33], [0.36, 0.3, 0.34], [0.3, 0.36, 0.34]])
    texels = replace(avatar.rig.texels, barycentrics=barycentrics)
    avatar = with_static(replace(avatar, rig=replace(avatar.rig, texels=texels)), np.zeros((11, 3)))
    coarse = at_level(avatar, 1)
    corners = avatar.coarse.mean[avatar.rig.mesh.faces[0]].astype(float)
    found = coarse.rig.texels.barycentrics @ corners + coarse.geometry.static[:3].T
    np.testing.assert_allclose(found, [barycentrics.mean(axis=0) @ corners], rtol=0, atol=SINGLE)


def test_the_length_of_a_texel_is_that_of_its_share_of_the_mesh() -> None:
    """By Heron's formula."""
    avatar = synthetic_avatar()
    corners = avatar.coarse.mean[avatar.rig.mesh.faces].astype(float)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    half = sides.sum(axis=1) / 2
    area = np.sqrt(half * np.prod(half[:, None] - sides, axis=1)).sum()
    assert texel_length(avatar) == pytest.approx(np.sqrt(area / 676))


def test_what_varies_with_the_frame_is_averaged_as_well() -> None:
    """Channels that neither grow nor move with the place are means of the block's at every frame."""
    avatar = synthetic_avatar()
    fine, coarse = (a.decode(a.clips[0], 5, dtype=np.float64) for a in (avatar, avatar.at_level(1)))
    numbers = block_numbers(avatar.rig.texels)
    full = np.flatnonzero(np.bincount(numbers) == 4)
    expected = np.stack([fine.texture[numbers == number].mean(axis=0) for number in full])
    found = coarse.texture[np.searchsorted(avatar.at_level(1).rig.texels.texels, full)]
    alike = np.abs(found[:, SCALES] - expected[:, SCALES] - np.log(GROWTH)).max(axis=1) < 1e-6
    assert alike.mean() > 0.5  # a block without distant texels
    np.testing.assert_allclose(found[alike, 10:], expected[alike, 10:], rtol=0, atol=1e-6)


def test_an_avatar_without_texels_has_levels_without_texels() -> None:
    coarse = empty_avatar().at_level(2)
    assert coarse.rig.texels.size == 8
    assert len(coarse.decode(coarse.clips[0]).centres) == 0


def test_levels_end_where_details_vary_with_the_frame() -> None:
    avatar = synthetic_avatar()
    assert coarsest(avatar) == 2
    assert coarsest(replace(avatar, wavelet=replace(avatar.wavelet, levels=3))) == 1
    assert coarsest(replace(avatar, wavelet=replace(avatar.wavelet, levels=8))) == 2
    for name in ("geometry", "appearance"):  # one has no details, the other still has
        plain = replace(avatar, **{name: replace(getattr(avatar, name), details=())})
        assert coarsest(replace(plain, wavelet=replace(plain.wavelet, levels=3))) == 1
    long = np.zeros(34)
    assert coarsest(replace(avatar, wavelet=replace(avatar.wavelet, rec_lo=long, rec_hi=long))) == 0


def test_rejects_a_missing_level() -> None:
    with pytest.raises(InputError, match="level is 3; the avatar has levels 0 to 2"):
        synthetic_avatar().at_level(3)


def test_the_finest_level_is_the_avatar_itself() -> None:
    avatar = synthetic_avatar()
    assert avatar.at_level(0) is avatar


def test_a_coarser_level_has_no_triangles_of_the_finest() -> None:
    assert with_surface(synthetic_avatar()).at_level(1).surface is None


def test_a_file_holds_the_finest_level_alone() -> None:
    with pytest.raises(InputError, match="the avatar is at level 1; expected level 0"):
        encode(synthetic_avatar().at_level(1))
