"""Atlases of small made surfaces, whose every texel has a known colour."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from patches import patch, plain, points, ramp, surfaces_of, texels_and_colours, uv_map
from scipy import ndimage

from mua.atlas.bake_texture import bake_texture
from mua.atlas.chart_quality import isometric
from mua.atlas.uv import build_atlas
from mua.rig.charts import areas, find_charts, signed_areas
from mua.rig.texel_map import build_texel_map
from mua.scene import Material, Wrap

pytestmark = pytest.mark.usefixtures("first_try")

ROUNDED = 1  # a colour of a linear ramp is exact before it is rounded to a byte, once in the ramp and once in the atlas
LENGTH_BOUND = 1e-9  # float64 of metres through a handful of products and an eigendecomposition
SNAPPED = 0.1  # xatlas snaps the extent of a chart to whole texels of the square that it packs in


def test_keep_leaves_a_clean_layout_and_its_picture_as_they_are() -> None:
    surfaces = surfaces_of(patch(3, at=0, uv=uv_map(0.5, 0.5, at=(0.1, 0.2))), images=(ramp(31),))
    character = build_atlas(surfaces, uv="keep", size=64)
    assert character.base_color is surfaces.materials[0].image
    assert np.array_equal(character.mesh.uv[character.mesh.uv_faces], surfaces.uv[surfaces.uv_faces])
    assert character.notes == surfaces.notes


@pytest.mark.parametrize("mirrored", [False, True])
def test_auto_moves_charts_that_share_texels_apart_and_carries_the_colours_over(mirrored: bool) -> None:
    square = uv_map(0.8, 0.8, at=(0.1, 0.1))
    twin = uv_map(-0.8, 0.8, at=(0.9, 0.1)) if mirrored else square
    surfaces = surfaces_of(patch(4, at=0, uv=square), patch(4, at=2, uv=twin), images=(ramp(64),))
    character = build_atlas(surfaces, uv="auto", size=96)
    texels, colours = texels_and_colours(character)
    assert texels.claimed_twice == 0
    assert character.notes[-1] == "2 charts of the file's UV layout are kept, finer where more is seen."
    place = points(character, texels)
    across = place[:, 0] - np.where(place[:, 0] > 1.5, 2, 0)
    u = np.where((place[:, 0] > 1.5) & mirrored, 0.9 - 0.8 * across, 0.1 + 0.8 * across)
    np.testing.assert_allclose(colours[:, 0], 255 * u, atol=ROUNDED)
    np.testing.assert_allclose(colours[:, 1], 255 * (0.1 + 0.8 * place[:, 1]), atol=ROUNDED)
    assert (colours[:, 2:] == (7, 200)).all()


def test_auto_halves_that_meet_at_a_fold_become_two_charts() -> None:
    left = patch(2, at=-1, uv=uv_map(-0.5, 1, at=(1, 0)))
    right = patch(2, at=0, uv=uv_map(0.5, 1, at=(0.5, 0)))
    surfaces = surfaces_of(left, right, images=(ramp(16),))
    welded, index = np.unique(surfaces.vertices, axis=0, return_inverse=True)
    surfaces = replace(surfaces, vertices=welded, faces=index[surfaces.faces].astype(np.int32))
    character = build_atlas(surfaces, uv="auto", size=64)
    assert build_texel_map(character.mesh, 64).claimed_twice == 0
    assert character.notes[-1] == "2 charts of the file's UV layout are kept, finer where more is seen."


@pytest.mark.parametrize("uv", ["auto", "keep"])
def test_materials_share_one_picture_without_mixing(uv: Any) -> None:
    whole = uv_map(1, 1, at=(0, 0))
    red, blue = plain(255, 0, 0, 255), plain(0, 0, 255, 90)
    surfaces = surfaces_of(patch(2, at=0, uv=whole), patch(2, at=3, uv=whole, width=0.5), images=(red, blue))
    character = build_atlas(surfaces, uv=uv, size=64)
    texels, colours = texels_and_colours(character)
    is_red = points(character, texels)[:, 0] < 2
    assert 0 < np.count_nonzero(~is_red) < np.count_nonzero(is_red)
    assert (colours[is_red] == red[0, 0]).all()
    assert (colours[~is_red] == blue[0, 0]).all()
    assert texels.claimed_twice == 0
    assert character.mesh.uv.min() >= 0
    assert character.mesh.uv.max() <= 1


@pytest.mark.parametrize("uv", ["auto", "keep", "unwrap"])
def test_triangles_without_uvs_are_cut_anew(uv: Any) -> None:
    surfaces = surfaces_of(
        patch(3, at=0, uv=uv_map(0.5, 0.5, at=(0, 0))),
        patch(3, at=2, uv=uv_map(0.5, 0.5, at=(0, 0))),
        images=(plain(9, 8, 7, 255),),
    )
    uv_faces = surfaces.uv_faces.copy()
    uv_faces[18:] = -1
    character = build_atlas(replace(surfaces, uv_faces=uv_faces), uv=uv, size=128)
    texels, colours = texels_and_colours(character)
    assert set(texels.triangles.tolist()) == set(range(36))
    assert texels.claimed_twice == 0
    assert (colours == (9, 8, 7, 255)).all()


def test_charts_in_other_tiles_return_by_whole_tiles() -> None:
    surfaces = surfaces_of(patch(2, at=0, uv=uv_map(0.5, 0.5, at=(3.25, -1.75))), images=(ramp(16),))
    character = build_atlas(surfaces, uv="keep", size=32)
    assert character.base_color is surfaces.materials[0].image
    assert character.mesh.uv.min() == 0.25
    assert character.mesh.uv.max() == 0.75


def test_a_texture_that_repeats_across_a_chart_is_written_out() -> None:
    surfaces = surfaces_of(patch(4, at=0, uv=uv_map(2, 2, at=(0, 0))), images=(ramp(64),))
    character = build_atlas(surfaces, uv="auto", size=200)
    texels, colours = texels_and_colours(character)
    u = points(character, texels)[:, 0] * 2 % 1
    inside = np.abs(u - 0.5) < 0.45  # at the border of a tile the ramp jumps
    np.testing.assert_allclose(colours[inside, 0], 255 * u[inside], atol=ROUNDED)


def test_surface_drawn_with_one_point_of_a_palette_is_cut_anew() -> None:
    surfaces = surfaces_of(patch(3, at=0, uv=uv_map(0, 0, at=(0.5, 0.25))), images=(ramp(16),))
    character = build_atlas(surfaces, uv="auto", size=64)
    texels, colours = texels_and_colours(character)
    assert set(texels.triangles.tolist()) == set(range(18))
    assert np.ptp(colours, axis=0).max() <= ROUNDED  # the point lies between two bytes
    assert character.notes[-1] == "All 18 triangles are cut into 1 new UV charts."


def test_a_band_with_too_few_texels_is_cut_anew() -> None:
    vertices, faces, uv = patch(12, at=0, uv=uv_map(1, 1, at=(0, 0)))
    uv[:, 0] = np.where(uv[:, 0] < 0.5, 1.9 * uv[:, 0], 0.9 + 0.1 * uv[:, 0])
    character = build_atlas(surfaces_of((vertices, faces, uv), images=(ramp(256),)), uv="auto", size=64)
    assert "1 charts of the file's UV layout are kept" in character.notes[-1]
    assert "next to no texels and are cut into" in character.notes[-1]
    drawn = areas(character.mesh.uv[character.mesh.uv_faces])
    assert np.mean(drawn < drawn.max() / 4) < 0.02


def test_a_layout_that_squeezes_one_end_of_a_chart_is_cut_anew() -> None:
    """Palettes of gradients look like this: no texel is shared, but lengths along u differ by up to eight times."""
    vertices, faces, uv = patch(12, at=0, uv=uv_map(1, 1, at=(0, 0)))
    uv[:, 0] = 2 ** (3 * uv[:, 0] - 3)
    character = build_atlas(surfaces_of((vertices, faces, uv), images=(ramp(256),)), uv="auto", size=64)
    assert character.notes[-1] == "All 288 triangles are cut into 1 new UV charts."
    drawn = areas(character.mesh.uv[character.mesh.uv_faces])
    np.testing.assert_allclose(drawn, drawn.mean(), rtol=SNAPPED)


def test_a_chart_that_winds_over_itself_is_cut_anew_and_others_are_kept() -> None:
    turns = np.linspace(0, 3 * np.pi, 31)
    ring = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    uv = np.concatenate([0.3 + 0.3 * ring, 0.3 + 0.15 * ring])
    vertices = np.concatenate([np.insert(ring * radius, 2, turns, axis=1) for radius in (1.0, 0.5)])
    k = np.arange(30)
    faces = np.concatenate([np.stack([k, k + 1, k + 31], 1), np.stack([k + 1, k + 32, k + 31], 1)])
    aside = patch(2, at=5, uv=uv_map(0.3, 0.3, at=(0.7, 0.7)))
    character = build_atlas(surfaces_of((vertices, faces, uv), aside, images=(ramp(16),)), uv="auto", size=128)
    assert build_texel_map(character.mesh, 128).claimed_twice == 0
    assert "1 charts of the file's UV layout are kept, finer where more is seen; 60 of 68" in character.notes[-1]


def test_keep_says_what_it_leaves() -> None:
    square = uv_map(1, 1, at=(0, 0))
    surfaces = surfaces_of(patch(2, at=0, uv=square), patch(2, at=2, uv=square), images=(ramp(16),))
    character = build_atlas(surfaces, uv="keep", size=32)
    assert character.base_color is surfaces.materials[0].image
    assert character.notes[-1].startswith("The UV layout was kept although 100% of its texels")


def test_unwrap_gives_every_triangle_texels_of_its_own() -> None:
    surfaces = surfaces_of(patch(4, at=0, uv=uv_map(1, 1, at=(0, 0))), images=(ramp(16),))
    character = build_atlas(surfaces, uv="unwrap", size=64)
    texels, colours = texels_and_colours(character)
    assert set(texels.triangles.tolist()) == set(range(32))
    place = points(character, texels)
    inside = (np.abs(place[:, :2] - 0.5) < 0.45).all(axis=1)  # the texture repeats at its border
    np.testing.assert_allclose(colours[inside, 0], 255 * place[inside, 0], atol=ROUNDED)


def test_a_large_surface_is_cut_in_blocks_that_do_not_overlap(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mua.atlas.uv.BLOCK", 100)
    surfaces = surfaces_of(patch(12, at=0, uv=uv_map(1, 1, at=(0, 0))), images=(ramp(16),))  # 288 triangles
    character = build_atlas(surfaces, uv="unwrap", size=128)
    texels, _ = texels_and_colours(character)
    assert set(texels.triangles.tolist()) == set(range(288))
    assert texels.claimed_twice == 0
    assert character.notes[-1] == "All 288 triangles are cut into 4 new UV charts."


@pytest.mark.parametrize("width", [1e-4, 1e-3, 100])  # lashes of a head alone, and a figure in centimetres
def test_unwrap_cuts_surfaces_of_any_size(width: float) -> None:
    surfaces = surfaces_of(patch(4, at=0, uv=uv_map(1, 1, at=(0, 0)), width=width), images=(ramp(16),))
    texels, _ = texels_and_colours(build_atlas(surfaces, uv="unwrap", size=64))
    assert set(texels.triangles.tolist()) == set(range(32))


def test_charts_of_uneven_density_become_even() -> None:
    coarse, fine = uv_map(0.05, 0.05, at=(0, 0)), uv_map(0.9, 0.3, at=(0.1, 0.1))
    patches = [patch(1, at=2 * k, uv=fine if k > 7 else coarse) for k in range(10)]
    character = build_atlas(surfaces_of(*patches, images=(ramp(64),)), uv="auto", size=64)
    drawn = areas(character.mesh.uv[character.mesh.uv_faces])
    np.testing.assert_allclose(drawn, drawn.mean(), rtol=SNAPPED)


def test_isometric_takes_the_stretch_out_of_a_chart() -> None:
    vertices, faces, uv = patch(3, at=0, uv=np.array([[0.9, 0.2], [-0.1, 0.05], [0, 0]]))
    flat = isometric(uv[faces], vertices[faces], np.zeros(len(faces), int))
    for a, b in ((0, 1), (1, 2), (2, 0)):
        expected = np.linalg.norm(vertices[faces[:, a]] - vertices[faces[:, b]], axis=1)
        found = np.linalg.norm(flat[:, a] - flat[:, b], axis=1)
        np.testing.assert_allclose(found, expected, atol=LENGTH_BOUND)


def test_a_folded_sliver_stays_in_its_chart() -> None:
    uv = np.array([[0, 0], [0.5, 0], [0.5, 0.5], [0.3, 0.2999], [0.1, 0.1]])
    faces = np.array([[0, 1, 2], [4, 2, 3], [0, 2, 4]])
    assert np.sign(signed_areas(uv[faces])).tolist() == [1, -1, 0]
    assert find_charts(faces, uv[faces]).tolist() == [0, 0, 0]


@pytest.mark.parametrize(("wrap", "mode"), [("repeat", "grid-wrap"), ("mirror", "reflect"), ("clamp", "nearest")])
def test_sampling_follows_the_materials_wrap(wrap: Wrap, mode: str) -> None:
    rng = np.random.default_rng(0)
    image = rng.integers(0, 256, (5, 7, 4), dtype=np.uint8)
    image[..., 3] = 255
    corners = np.array([[[-2.2, -1.7], [3.1, -1.7], [-2.2, 2.9]], [[3.1, -1.7], [3.1, 2.9], [-2.2, 2.9]]])
    square = np.array([[[0, 0], [1, 0], [0, 1]], [[1, 0], [1, 1], [0, 1]]], float)
    vertices, faces, uv = patch(1, at=0, uv=uv_map(1, 1, at=(0, 0)))
    character = build_atlas(surfaces_of((vertices, faces, uv), images=(image,)), uv="keep", size=53)
    assert np.array_equal(character.mesh.uv[character.mesh.uv_faces], square)
    texels = build_texel_map(character.mesh, 53)
    baked = bake_texture(
        texels, corners, np.zeros(2, np.int32), materials=(Material("m", image, wrap_u=wrap, wrap_v=wrap),)
    )
    centre = (np.arange(53) + 0.5) / 53
    columns = (centre * 5.3 - 2.2) * 7 - 0.5
    rows = (centre * 4.6 - 1.7) * 5 - 0.5
    place = np.stack(np.meshgrid(rows, columns, indexing="ij"))
    for channel in range(4):
        expected = ndimage.map_coordinates(image[..., channel].astype(float), place, order=1, mode=mode)
        np.testing.assert_allclose(baked[..., channel], expected, atol=ROUNDED)


def test_gutters_take_the_nearest_colour() -> None:
    half = surfaces_of(patch(1, at=0, uv=uv_map(0.25, 1, at=(0, 0))), images=(np.concatenate([ramp(16), ramp(16)]),))
    character = build_atlas(half, uv="keep", size=16)
    assert (character.base_color[:, 4:] == character.base_color[:, 3:4]).all()


def test_a_picture_finer_than_the_atlas_is_averaged_without_the_colour_of_what_is_clear() -> None:
    checks = np.zeros((64, 64, 4), np.uint8)
    checks[::2, ::2] = checks[1::2, 1::2] = (90, 60, 30, 254)
    whole = uv_map(1, 1, at=(0, 0))
    surfaces = surfaces_of(patch(1, at=0, uv=whole), patch(1, at=2, uv=whole), images=(checks, plain(0, 0, 0, 9)))
    character = build_atlas(surfaces, uv="keep", size=32)
    texels, colours = texels_and_colours(character)
    of_checks = points(character, texels)[:, 0] < 1.5
    np.testing.assert_allclose(colours[of_checks], [[90, 60, 30, 127]] * of_checks.sum(), atol=ROUNDED)
