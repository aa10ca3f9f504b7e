"""Surfels end where the surface does, on narrow strips and at borders; elsewhere they stay as they are."""

import numpy as np
import pytest
from patches import joined

from mua import rotation
from mua.rig.character import Mesh
from mua.rig.texel_map import build_texel_map
from mua.texture.ends import AWAY, EDGE
from mua.texture.footprints import TexelPoints
from mua.texture.sharpness import SPREAD
from mua.texture.surfels import Surfels, rest_surfels

SIZE = 40
SIDE = 0.005  # of a texel's square, metres
CORNERS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
FACES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def sheet(wide: float, high: float) -> Mesh:
    """A flat sheet of so many texels, whose lower border cuts the middle of a row of texels."""
    flat = CORNERS * [wide, high]
    uv = (flat + np.array([4, 20.5 - high / 2])) / SIZE
    return Mesh(np.column_stack([flat * SIDE, np.zeros(4)]), FACES, uv, FACES)


def surfels_of(mesh: Mesh) -> tuple[Surfels, np.ndarray]:
    """The surfels of a mesh and their centres."""
    texels = build_texel_map(mesh, SIZE)
    at = texels.texels, texels.triangles, texels.barycentrics
    found = rest_surfels(mesh, size=SIZE, texels=at[0], triangles=at[1], barycentrics=at[2])
    return found, TexelPoints(mesh, SIZE, *at).places + found.aside


def outlines(found: Surfels, centres: np.ndarray) -> np.ndarray:
    """Points [N, 4, 3] where the outline of each surfel crosses its axes."""
    axes = rotation.to_matrix(found.rotations)[:, :, :2] * np.exp(found.log_scales[:, None, :2])
    return centres[:, None] + EDGE * np.concatenate([axes, -axes], axis=2).transpose(0, 2, 1)


@pytest.mark.parametrize("high", [0.3, 0.5, 0.8])
def test_surfels_on_a_narrow_strip_are_hardly_wider_than_it(high: float) -> None:
    ends = outlines(*surfels_of(sheet(30, high)))[..., 1] / SIDE
    beyond = AWAY / (1 - AWAY) * high / 2
    assert ends.min() > -beyond - 0.05
    assert ends.max() < high + beyond + 0.05


def test_surfels_at_the_end_of_a_strip_do_not_stand_out() -> None:
    ends = outlines(*surfels_of(sheet(20.3, 12.3))) / SIDE
    assert ends[..., 0].max() < 20.3 + 0.4
    assert ends[..., 1].min() > -0.4


def test_a_sheet_ends_before_another_that_lies_close_behind_it() -> None:
    """An eyelid before the eye: what lies behind does not carry the lid's surfels on."""
    lid, eye = sheet(20.3, 12.3), sheet(36, 12.3)
    behind = Mesh(eye.vertices - [0, 0, 0.3 * SIDE], FACES, eye.uv / [2, 8], FACES)
    found, centres = surfels_of(joined(lid, behind))
    ends = outlines(found, centres)[centres[:, 2] > -0.1 * SIDE] / SIDE
    assert len(ends) > 200
    assert ends[..., 0].max() < 20.3 + 0.4


def test_a_slit_that_the_texture_does_not_show_is_an_end() -> None:
    """Lips: neighbours in the texture, apart in space by up to 1.3 texels at the right."""
    flat = np.array([[-4, 0], [0, 0], [20, 0], [20, 6], [0, 6], [20, 6], [20, 12], [0, 12], [-4, 12]], float)
    faces = np.array([[0, 1, 4], [0, 4, 8], [4, 7, 8], [1, 2, 3], [1, 3, 4], [4, 5, 6], [4, 6, 7]], np.int32)
    open_by = np.zeros_like(flat)
    open_by[5:7, 1] = 1.3
    points = np.column_stack([(flat + open_by) * SIDE, np.zeros(len(flat))])
    found, centres = surfels_of(Mesh(points, faces, (flat + 8) / SIZE, faces))
    lower = (centres[:, 0] > 15 * SIDE) & (centres[:, 1] < 6 * SIDE)
    assert outlines(found, centres)[lower][..., 1].max() / SIDE < 6.3


def test_surfels_inside_a_sheet_are_not_shortened() -> None:
    found, centres = surfels_of(sheet(20, 20))
    inside = (np.abs(centres[:, :2] / SIDE - 10) < 8).all(axis=1)
    assert inside.sum() > 200
    np.testing.assert_allclose(np.exp(found.log_scales[inside, :2]), SPREAD * SIDE, rtol=0.01)
    assert not found.aside[inside].any()


def test_a_crease_has_no_gap() -> None:
    """A roof whose sides fall by 30 degrees: the surfels on its ridge cover the surface on both sides."""
    cosine, sine = np.cos(np.radians(30)), np.sin(np.radians(30))
    flat = np.array([[0, 0], [20, 0], [0, 10.5], [20, 10.5], [0, 21], [20, 21]])
    faces = np.array([[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]], np.int32)
    up = np.minimum(flat[:, 1], 21 - flat[:, 1])
    points = np.column_stack([flat[:, 0], flat[:, 1], up]) * [1, cosine, sine] * SIDE
    found, centres = surfels_of(Mesh(points, faces, (flat + 8) / SIZE, faces))
    ridge = np.abs(centres[:, 1] / SIDE - 10.5 * cosine) < 0.3
    assert ridge.sum() > 15
    across = np.ptp(outlines(found, centres)[ridge][..., 1], axis=1) / SIDE
    assert across.mean() > 0.7 * cosine  # of a texel's square, seen from above


def test_a_seam_between_charts_is_not_an_end() -> None:
    """Two halves of one sheet, apart in the texture: surfels reach the seam as far as without it."""
    flat = np.array([[0, 0], [10, 0], [10, 12], [0, 12], [20, 0], [20, 12]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]], np.int32)
    uv = np.concatenate([flat[[0, 1, 2, 3]] + 2, flat[[1, 4, 5, 2]] + [6, 2]]) / SIZE
    uv_faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.int32)
    ends = outlines(*surfels_of(Mesh(np.column_stack([flat * SIDE, np.zeros(6)]), faces, uv, uv_faces))) / SIDE
    left = ends[ends.mean(axis=1)[:, 0] < 10]
    assert left[..., 0].max() > 10.1
