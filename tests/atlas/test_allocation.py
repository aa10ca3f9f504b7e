"""Texels go where they are seen: to what has detail, to what is in sight, and to the middle of a face."""

from dataclasses import replace

import numpy as np
import pytest
from patches import patch, plain, surfaces_of, uv_map
from people import upright

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.uv import build_atlas
from mua.rig.expressions import Expressions
from mua.rig.texel_map import build_texel_map

pytestmark = pytest.mark.usefixtures("first_try")

SIZE = 256
WHOLE = uv_map(1, 1, at=(0, 0))
NOISE = np.random.default_rng(0).integers(0, 256, (64, 64, 4), dtype=np.uint8) | np.array([0, 0, 0, 255], np.uint8)


def texels_of(surfaces: Surfaces, chosen: Array) -> int:
    """Texels on the triangles [F] that are chosen."""
    mesh = build_atlas(surfaces, uv="auto", size=64).mesh
    texels = build_texel_map(mesh, SIZE)
    assert texels.claimed_twice == 0
    return int(np.count_nonzero(chosen[texels.triangles]))


def middles(surfaces: Surfaces) -> Array:
    return np.asarray(surfaces.vertices[surfaces.faces].mean(axis=1))


def test_a_chart_with_detail_gets_more_texels_than_one_of_a_single_colour() -> None:
    surfaces = surfaces_of(patch(8, at=0, uv=WHOLE), patch(8, at=2, uv=WHOLE), images=(NOISE, plain(90, 90, 90, 255)))
    busy = middles(surfaces)[:, 0] < 1.5
    assert texels_of(surfaces, busy) > 1.5 * texels_of(surfaces, ~busy)


def test_charts_of_the_same_detail_get_as_many_texels() -> None:
    surfaces = surfaces_of(patch(8, at=0, uv=WHOLE), patch(8, at=2, uv=WHOLE), images=(NOISE, NOISE))
    first = middles(surfaces)[:, 0] < 1.5
    assert texels_of(surfaces, first) == pytest.approx(texels_of(surfaces, ~first), rel=0.1)


def test_one_chart_is_finer_where_its_texture_has_detail() -> None:
    image = np.full((64, 64, 4), 128, np.uint8)
    image[:, :32], image[..., 3] = NOISE[:, :32], 255
    surfaces = surfaces_of(patch(16, at=0, uv=WHOLE), images=(image,))
    busy = middles(surfaces)[:, 0] < 0.5
    assert texels_of(surfaces, busy) > 1.3 * texels_of(surfaces, ~busy)


def test_what_an_expression_makes_larger_gets_more_texels() -> None:
    surfaces = surfaces_of(patch(8, at=0, uv=WHOLE), patch(8, at=2, uv=WHOLE), images=(NOISE, NOISE))
    lid = np.flatnonzero(surfaces.vertices[:, 0] < 1.5)
    closes = Expressions(
        names=("blink",),
        starts=np.array([0, len(lid)], np.int32),
        vertices=lid.astype(np.int32),
        offsets=(surfaces.vertices[lid] * [0, 3, 0]).astype(np.float32),  # four times as high
    )
    first = middles(surfaces)[:, 0] < 1.5
    moving = replace(surfaces, expressions=closes)
    assert texels_of(moving, first) > 1.5 * texels_of(surfaces, first)
    assert texels_of(moving, ~first) > 0.3 * texels_of(surfaces, ~first)


def test_what_others_hide_gets_fewer_texels() -> None:
    surfaces = surfaces_of(*(patch(8, at=0, uv=WHOLE) for _ in range(5)), images=(NOISE,) * 5)
    depth = np.repeat([-0.02, -0.01, 0, 0.01, 0.02], len(surfaces.vertices) // 5)
    surfaces = replace(surfaces, vertices=surfaces.vertices + depth[:, None] * [0, 0, 5])
    inner = np.abs(middles(surfaces)[:, 2]) < 0.01
    outer = middles(surfaces)[:, 2] > 0.09
    assert texels_of(surfaces, inner) < 0.8 * texels_of(surfaces, outer)


def test_the_eyes_of_a_face_get_more_texels_than_its_skin() -> None:
    image = np.full((96, 96, 4), (190, 140, 120, 255), np.uint8)
    for column in (30, 58):
        image[40:50, column : column + 10] = NOISE[:10, :10]
    face = surfaces_of(patch(40, at=-0.1, uv=WHOLE, width=0.2), images=(image,))
    face = replace(
        face,
        skeleton=upright(("Hips", "Head"), (-1, 0)),
        skin_indices=np.ones_like(face.skin_indices),
    )
    place = middles(face)
    eyes = (np.abs(place[:, 1] - 0.2 * 45 / 96) < 0.014) & (np.abs(np.abs(place[:, 0]) - 0.2 * 14 / 96) < 0.014)
    share = np.count_nonzero(eyes) / len(eyes)
    assert texels_of(face, eyes) > 1.25 * share * texels_of(face, np.ones(len(eyes), bool))


def test_a_head_of_one_colour_leaves_texels_to_the_body() -> None:
    skin = plain(190, 140, 120, 255)
    shares = []
    for image in (skin, NOISE):
        figure = surfaces_of(patch(8, at=0, uv=WHOLE), patch(8, at=2, uv=WHOLE), images=(skin, image))
        head = middles(figure)[:, 0] > 1.5
        moved_by = np.where(figure.vertices[:, :1] > 1.5, 1, 0)
        figure = replace(
            figure,
            skeleton=upright(("Hips", "Head"), (-1, 0)),
            skin_indices=np.broadcast_to(moved_by, figure.skin_indices.shape).astype(figure.skin_indices.dtype),
        )
        shares.append(texels_of(figure, head) / texels_of(figure, np.ones(len(head), bool)))
    assert shares[1] > 1.1 * shares[0]


def test_a_mass_of_hair_on_cards_leaves_the_face_its_texels() -> None:
    """A head with as much hair as it has body: where that is no mass of see-through cards, it is the head itself."""
    texels = []
    for alpha in (255, 120):
        hair = NOISE.copy()
        hair[:32, :, 3] = alpha
        places = (2, -6, -4, -2, 0, 4, 6, 8, 10)  # the face, the body, the hair
        images = (plain(190, 140, 120, 255),) * 5 + (hair,) * 4
        figure = surfaces_of(*(patch(8, at=at, uv=WHOLE) for at in places), images=images)
        moved_by = np.where(figure.vertices[:, :1] > 1.5, 1, 0)
        figure = replace(
            figure,
            materials=tuple(replace(one, alpha_mode="mask") for one in figure.materials),
            skeleton=upright(("Hips", "Head"), (-1, 0)),
            skin_indices=np.broadcast_to(moved_by, figure.skin_indices.shape).astype(figure.skin_indices.dtype),
        )
        across = middles(figure)[:, 0]
        texels.append(texels_of(figure, (across > 1.5) & (across < 3.5)))
    assert texels[1] > 1.3 * texels[0]
