"""Exported splats: other programs read the avatar's splats, with equal colour from every direction."""

import gzip
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import splat_viewer
from splat_viewer import Array, Read, ply_vertices, read_by_gaussforge, read_ply
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.avatar.camera import orbit
from mua.avatar.decode import Splats
from mua.avatar.rendering import render_premultiplied
from mua.export.compressed_ply import CHUNK, compressed_ply_bytes
from mua.export.ply import ply_bytes
from mua.export.splats import HALF_TURN_Z, WorldSplats, morton_order, turned, world_splats
from mua.export.spz import spz_bytes
from mua.kernels.dq_skinning import LARGEST_LOG_SCALE
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import PIXEL_VARIANCE

EPSILON = 2.0**-23
COLOR_BOUND = 64 * EPSILON  # a turned vector of coefficients of about 1, and a sum of four products
TURN_BOUND = 16 * EPSILON  # a product of two unit quaternions
SAME_KERNEL, PUBLISHED = 60.0, 27.0  # decibels, beside our image: of our kernel, and of the published one
LEVEL = 1 / 255


@cache
def posed() -> Splats:
    avatar = synthetic_avatar()
    return avatar.decode("wave", 4)


@cache
def exported() -> WorldSplats:
    return world_splats(posed())


def as_read(splats: WorldSplats) -> Read:
    """The splats as a perfect reader would have them."""
    constant, linear = splats.sh[:, :3], splats.sh[:, 3:].reshape(-1, 3, 3)
    fields = (splats.centres, splats.log_scales, splats.rotations, splats.logits, constant, linear)
    return Read(*(a.astype(float) for a in fields))


def written(tmp_path: Path, content: bytes) -> Path:
    path = tmp_path / "a.bin"
    path.write_bytes(content)
    return path


def unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def test_a_ply_gives_trimesh_the_same_values(tmp_path: Path) -> None:
    found, splats = read_ply(written(tmp_path, ply_bytes(exported()))), posed()
    np.testing.assert_array_equal(found.centres, splats.centres)
    np.testing.assert_array_equal(found.log_scales, splats.texture[:, 7:10])
    np.testing.assert_array_equal(found.logits, splats.texture[:, 10])
    np.testing.assert_array_equal(found.constant, splats.sh[:, :3])
    np.testing.assert_allclose(np.exp(found.log_scales), splats.scales, rtol=4 * EPSILON)
    np.testing.assert_allclose(1 / (1 + np.exp(-found.logits)), splats.opacities, atol=4 * EPSILON)
    np.testing.assert_array_equal(found.wxyz, splats.rotations)


def test_a_ply_has_the_properties_that_viewers_look_for(tmp_path: Path) -> None:
    path = written(tmp_path, ply_bytes(exported()))
    names = list(ply_vertices(path).dtype.names or ())
    assert names[:3] == ["x", "y", "z"]
    assert names[3:6] == ["f_dc_0", "f_dc_1", "f_dc_2"]
    assert names[6:15] == [f"f_rest_{k}" for k in range(9)]
    assert names[15:] == ["opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    header = path.read_bytes().partition(b"end_header")[0].decode()
    assert "comment SplatRenderMode: mip" in header.splitlines()


def test_colours_are_the_same_from_every_direction(tmp_path: Path) -> None:
    found, splats = read_ply(written(tmp_path, ply_bytes(exported()))), posed()
    rng = np.random.default_rng(5)
    for _ in range(4):
        camera = 3 * rng.normal(size=3)
        ours = splat_colors(splats.centres, splats.texel_dq, splats.sh, camera)
        np.testing.assert_allclose(found.colors(unit(found.centres - camera)), ours, atol=COLOR_BOUND)


def test_colours_would_differ_if_coefficients_were_left_in_canonical_space() -> None:
    splats = posed()
    left = as_read(replace(exported(), sh=splats.sh))
    camera = np.array([0.0, 1, 3])
    ours = splat_colors(splats.centres, splats.texel_dq, splats.sh, camera)
    assert np.abs(left.colors(unit(splats.centres - camera)) - ours).max() > 0.02


def test_turned_splats_turned_back_by_a_viewer_are_the_same() -> None:
    down, splats = as_read(turned(exported(), HALF_TURN_Z)), as_read(exported())
    back = np.diag([-1.0, -1, 1])
    np.testing.assert_array_equal(down.centres @ back, splats.centres)
    np.testing.assert_allclose(back @ down.covariances() @ back, splats.covariances(), atol=TURN_BOUND)
    rays = unit(np.random.default_rng(1).normal(size=(len(splats.centres), 3)))
    np.testing.assert_allclose(down.colors(rays @ back), splats.colors(rays), atol=COLOR_BOUND)


def test_a_turn_takes_places_rotations_and_colours_along() -> None:
    q = rotation.normalize(np.array([0.3, -0.5, 0.2, 0.8]))
    found, splats, turn = as_read(turned(exported(), q)), as_read(exported()), rotation.to_matrix(q)
    np.testing.assert_allclose(found.centres, splats.centres @ turn.T, atol=8 * EPSILON)
    np.testing.assert_allclose(found.covariances(), turn @ splats.covariances() @ turn.T, atol=TURN_BOUND)
    rays = unit(np.random.default_rng(2).normal(size=(len(splats.centres), 3)))
    np.testing.assert_allclose(found.colors(rays @ turn.T), splats.colors(rays), atol=COLOR_BOUND)


@pytest.mark.parametrize("azimuth", [0.4, 2.6])
@pytest.mark.parametrize(("ours", "least"), [(True, SAME_KERNEL), (False, PUBLISHED)])
def test_another_renderer_draws_the_same_picture(tmp_path: Path, azimuth: float, ours: bool, least: float) -> None:
    splats = posed()
    bounds = np.stack([splats.centres.min(axis=0), splats.centres.max(axis=0)])
    camera = orbit(bounds, screen=(48, 64), azimuth=azimuth, elevation=0.2)
    found = read_ply(written(tmp_path, ply_bytes(exported())))
    kernel: dict[str, Any] = {"dilation": PIXEL_VARIANCE, "profile": splat_viewer.window} if ours else {}
    picture, expected = splat_viewer.draw(found, camera, **kernel), render_premultiplied(splats, camera)
    assert expected[..., 3].mean() > 0.1
    assert splat_viewer.decibels(picture, expected) > least


def test_a_spz_gives_another_reader_the_same_within_its_steps(tmp_path: Path) -> None:
    found, splats = read_by_gaussforge(written(tmp_path, spz_bytes(exported())), "spz"), as_read(exported())
    np.testing.assert_allclose(found.centres, splats.centres, atol=2.0**-20)
    np.testing.assert_allclose(found.log_scales, splats.log_scales, atol=1 / 32 + EPSILON)
    np.testing.assert_allclose(1 / (1 + np.exp(-found.logits)), 1 / (1 + np.exp(-splats.logits)), atol=LEVEL)
    np.testing.assert_allclose(found.constant, np.clip(splats.constant, -10 / 3, 10 / 3), atol=LEVEL / 0.15)
    assert np.abs(splats.linear).max() < 1
    np.testing.assert_allclose(found.linear, splats.linear, atol=1 / 256 + EPSILON)
    same = np.abs(np.sum(found.wxyz * splats.wxyz, axis=1))
    assert same.min() > 1 - (2 / 511) ** 2


@pytest.mark.parametrize(("kind", "step"), [("spz", 1 / 511), ("compressed.ply", 1 / 1023)])
def test_any_rotation_comes_back(tmp_path: Path, kind: str, step: float) -> None:
    any_way = unit(np.random.default_rng(3).normal(size=(len(exported()), 4)))
    spun = replace(exported(), rotations=any_way.astype(np.float32), centres=np.sort(exported().centres, axis=0))
    content = {"spz": spz_bytes, "compressed.ply": compressed_ply_bytes}[kind](spun)
    found = read_by_gaussforge(written(tmp_path, content), kind).wxyz
    order = np.arange(len(spun)) if kind == "spz" else morton_order(spun.centres)
    assert np.abs(np.sum(found * any_way[order], axis=1)).min() > 1 - (2 * step) ** 2


def test_a_spz_keeps_the_place_just_below_a_power_of_two(tmp_path: Path) -> None:
    """There rounding reaches the next bit."""
    edge = np.nextafter(np.float32(8), np.float32(0))
    far = replace(exported(), centres=np.tile(np.array([edge, -edge, 0], np.float32), (len(exported()), 1)))
    found = read_by_gaussforge(written(tmp_path, spz_bytes(far)), "spz")
    np.testing.assert_allclose(found.centres, far.centres, atol=2.0**-18)


def test_a_spz_does_not_hold_the_time_at_which_it_was_made() -> None:
    assert spz_bytes(exported())[4:8] == bytes(4)


def test_a_spz_says_that_its_splats_are_filtered() -> None:
    header = gzip.decompress(spz_bytes(exported()))[:16]
    assert header[:8] == b"NGSP\3\0\0\0"
    assert int.from_bytes(header[8:12], "little") == len(exported())
    assert (header[12], header[14], header[15]) == (1, 1, 0)


def test_scales_are_held_where_players_hold_them(tmp_path: Path) -> None:
    splats = posed()
    texture = splats.texture.copy()
    texture[:2, 7] = [12, -30]
    found = world_splats(replace(splats, texture=texture))
    assert found.log_scales[:2, 0].tolist() == [LARGEST_LOG_SCALE, -30]
    read = read_by_gaussforge(written(tmp_path, compressed_ply_bytes(found)), "compressed.ply")
    assert read.log_scales.min() == pytest.approx(-20, abs=1e-5)


def test_a_spz_far_from_the_origin_keeps_its_centres(tmp_path: Path) -> None:
    far = replace(exported(), centres=exported().centres + np.array([0, 0, 1000], np.float32))
    found = read_by_gaussforge(written(tmp_path, spz_bytes(far)), "spz")
    np.testing.assert_allclose(found.centres, far.centres, atol=2.0**-12)


def test_a_compressed_ply_gives_another_reader_the_same_within_its_steps(tmp_path: Path) -> None:
    assert len(exported()) % CHUNK, "the last chunk is not full"
    found = read_by_gaussforge(written(tmp_path, compressed_ply_bytes(exported())), "compressed.ply")
    order = morton_order(exported().centres)
    splats = as_read(WorldSplats(*(a[order] for a in vars(exported()).values())))
    size = np.ptp(splats.centres, axis=0).max()
    np.testing.assert_allclose(found.centres, splats.centres, atol=size / 1023)
    np.testing.assert_allclose(found.log_scales, splats.log_scales, atol=np.ptp(splats.log_scales) / 1023)
    np.testing.assert_allclose(1 / (1 + np.exp(-found.logits)), 1 / (1 + np.exp(-splats.logits)), atol=LEVEL)
    np.testing.assert_allclose(found.constant, splats.constant, atol=np.ptp(splats.constant) / 255)
    np.testing.assert_allclose(found.linear, splats.linear, atol=8 / 256)
    assert np.abs(np.sum(found.wxyz * splats.wxyz, axis=1)).min() > 1 - (2 / 1023) ** 2


def test_a_flat_chunk_has_no_range(tmp_path: Path) -> None:
    flat = replace(exported(), centres=exported().centres * np.array([1, 1, 0], np.float32))
    found = read_by_gaussforge(written(tmp_path, compressed_ply_bytes(flat)), "compressed.ply")
    np.testing.assert_array_equal(found.centres[:, 2], 0)


def test_a_chunk_that_is_all_but_flat_is_flat() -> None:
    """Readers take ranges this small for none, and shares of them for shares of 1."""
    thin = replace(exported(), centres=exported().centres * np.array([1, 1, 1e-6], np.float32))
    count, content = len(thin.centres), compressed_ply_bytes(thin)
    words = np.frombuffer(content[-25 * count : -9 * count], "<u4").reshape(count, 4)  # before 9 bytes for each splat
    assert 0 < np.ptp(thin.centres[:, 2]) < 1e-5
    np.testing.assert_array_equal(words[:, 0] & 0x7FF, 0)


def test_a_narrow_chunk_keeps_its_range(tmp_path: Path) -> None:
    narrow = replace(exported(), centres=exported().centres * np.array([1, 1, 1e-3], np.float32))
    found = read_by_gaussforge(written(tmp_path, compressed_ply_bytes(narrow)), "compressed.ply")
    expected = narrow.centres[morton_order(narrow.centres)]
    np.testing.assert_allclose(found.centres[:, 2], expected[:, 2], atol=np.ptp(expected[:, 2]) / 1023)


def test_points_in_one_place_keep_their_order() -> None:
    assert morton_order(np.ones((3, 3), np.float32)).tolist() == [0, 1, 2]


def test_neighbours_in_space_are_written_near_each_other() -> None:
    points = np.stack(np.meshgrid(*[np.arange(8.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    ordered = points[morton_order(np.random.default_rng(0).permutation(points))]
    assert sorted(morton_order(points)) == list(range(len(points)))
    cube = np.ptp(points[morton_order(points)].reshape(-1, 8, 3), axis=1)
    np.testing.assert_array_equal(cube, 1)  # every eight are a cube of two
    assert len(ordered) == len(points)
