"""Surfels along the borders of charts: an outline is where half is covered, wherever it cuts through the texels."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from patches import joined
from surfel_coverage import coverage

from mua.rig.character import Mesh
from mua.rig.texel_map import TexelMap, build_texel_map
from mua.texture.footprints import Samples, TexelPoints
from mua.texture.rims import FARTHEST, NARROWEST, WIDEST, fit_rims
from mua.texture.sharpness import SPREAD
from mua.texture.surfels import Surfels, rest_surfels

SIZE = 40
SIDE = 0.05  # side of a texel's square, in units of the sheet
BY_TEXEL = 0.3  # texels, by which an outline may be missed: surfels that also close a seam reach a little beyond theirs


def square(texels: float) -> Mesh:
    """A sheet of so many texels a side, from the corner of a texel on."""
    flat = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * texels
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return Mesh(np.column_stack([flat * SIDE, np.zeros(4)]), faces, (flat + 2) / SIZE, faces)


def laid(mesh: Mesh) -> tuple[TexelMap, Surfels]:
    """The texels of a sheet and their surfels."""
    texels = build_texel_map(mesh, SIZE)
    return texels, rest_surfels(
        mesh, size=SIZE, texels=texels.texels, triangles=texels.triangles, barycentrics=texels.barycentrics
    )


@pytest.mark.parametrize("beyond", [0.05, 0.3, 0.55, 0.8])
def test_half_is_covered_at_an_outline_that_cuts_through_texels(beyond: float) -> None:
    mesh = square(12 + beyond)
    texels = build_texel_map(mesh, SIZE)
    at: dict[str, Any] = {"texels": texels.texels, "triangles": texels.triangles, "barycentrics": texels.barycentrics}
    found = rest_surfels(mesh, size=SIZE, **at)
    centres = TexelPoints(mesh, SIZE, **at).places + found.aside
    along, out = np.meshgrid(np.linspace(5, 7, 9), np.linspace(11, 14, 121), indexing="ij")
    places = np.stack([out.ravel(), along.ravel(), 0 * out.ravel()], axis=1) * SIDE
    covered = coverage(places, centres, found.rotations, np.exp(found.log_scales)).reshape(out.shape).mean(axis=0)
    outline = np.interp(-0.5, -covered, out[0])
    assert outline == pytest.approx(12 + beyond, abs=BY_TEXEL)


@pytest.mark.parametrize("beyond", [0.05, 0.3, 0.55, 0.8])
def test_little_shows_through_the_seam_of_an_even_sheet(beyond: float) -> None:
    """The charts end in different places of their squares."""
    seam, left, right = 12 + beyond, square(12 + beyond), square(12)
    aside = np.array([seam, 0, 0]) * SIDE
    mesh = joined(left, replace(right, vertices=right.vertices + aside, uv=right.uv + 16 / SIZE))
    texels, found = laid(mesh)
    points = TexelPoints(mesh, SIZE, texels.texels, texels.triangles, texels.barycentrics).places
    across, along = np.meshgrid(seam + np.linspace(-1, 1, 41), np.linspace(4, 8, 33))
    places = np.stack([across.ravel(), along.ravel(), 0 * along.ravel()], axis=1) * SIDE
    assert coverage(places, points + found.aside, found.rotations, np.exp(found.log_scales)).min() > 0.9


def test_a_border_between_charts_is_one_where_they_touch_in_the_texture() -> None:
    """Neighbours in the texture, of charts that lie apart."""
    left, right = square(10), square(10)
    mesh = joined(left, replace(right, vertices=np.add(right.vertices, [1, 0, 0]), uv=np.add(right.uv, [10 / SIZE, 0])))
    texels, found = laid(mesh)
    row, column = np.divmod(texels.texels, SIZE)
    at_border = np.isin(row, (2, 11)) | np.isin(column, (2, 11, 12, 21))
    np.testing.assert_array_equal(found.at_border, at_border)


def test_surfels_inside_stay_where_their_texels_are() -> None:
    mesh = square(12.3)
    texels, found = laid(mesh)
    row, column = np.divmod(texels.texels, SIZE)
    inside = (np.minimum(row, column) > row.min()) & (np.maximum(row, column) < row.max())
    assert not found.aside[inside].any()
    moved = np.linalg.norm(found.aside[~inside], axis=1)
    assert 0 < moved.max() <= FARTHEST * SIDE
    assert np.exp(found.log_scales[:, :2]).max() <= WIDEST * SPREAD * SIDE * (1 + 1e-6)


@pytest.mark.parametrize(("spread", "width"), [(3.0, WIDEST), (0.0, NARROWEST)])
def test_surface_far_from_a_texel_does_not_pull_its_surfel_out_of_its_place(spread: float, width: float) -> None:
    """A strip between texels, say, that is long or has no width."""
    mesh = square(3)
    texels = build_texel_map(mesh, SIZE)
    points = TexelPoints(mesh, SIZE, texels.texels, texels.triangles, texels.barycentrics)
    strip = points.places[:1] + SIDE * np.array([[2, 2, 0]]) + SIDE * spread * np.linspace(-1, 1, 9)[:, None]
    own = np.zeros(len(strip), int)
    samples = Samples(places=strip, triangles=own, texels=own, bare=own > 0)
    count = len(texels.texels)
    found = fit_rims(points, samples, np.tile(np.eye(3), (count, 1, 1)), steps=np.full((count, 2), SIDE))
    assert found.texels.tolist() == [0]
    np.testing.assert_allclose(found.aside, [FARTHEST * SIDE * np.array([0.5**0.5, 0.5**0.5, 0])])
    np.testing.assert_allclose(found.steps, width * SIDE)
