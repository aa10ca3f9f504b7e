"""What texels have to cover: surfaces come out closed whatever their triangles' share of the texture is."""

from typing import Any

import numpy as np
import pytest
from patches import grid_faces, joined
from surfel_coverage import coverage

from mua.rig.character import Mesh
from mua.rig.surface_points import spread_points
from mua.rig.texel_map import TexelMap, build_texel_map
from mua.texture.footprints import TexelPoints
from mua.texture.sharpness import SPREAD
from mua.texture.surfels import Surfels, rest_surfels

SIZE = 48
OPAQUE = 0.8  # where two charts meet, a fifth of what lies behind shines through


def laid(mesh: Mesh) -> tuple[TexelMap, Surfels, np.ndarray]:
    texels = build_texel_map(mesh, SIZE)
    at: dict[str, Any] = {"texels": texels.texels, "triangles": texels.triangles, "barycentrics": texels.barycentrics}
    found = rest_surfels(mesh, size=SIZE, **at)
    return texels, found, TexelPoints(mesh, SIZE, **at).places + found.aside


def sheet(points: np.ndarray, uv: np.ndarray) -> Mesh:
    """A grid [R, C, 3] of points and its UVs [R, C, 2] as triangles."""
    rows, columns = points.shape[:2]
    faces = grid_faces(rows - 1, columns - 1).astype(np.int32)
    return Mesh(points.reshape(-1, 3), faces, uv.reshape(-1, 2), faces)


def graded(widths: np.ndarray, height: float, *, size: float = 1.0) -> Mesh:
    """A flat sheet of `size` whose columns take equal shares of it, but `widths` of the texture."""
    u = np.concatenate([[0], np.cumsum(widths) / np.sum(widths)]) * 0.9 + 0.05
    x = np.linspace(0, size, len(u))
    points = np.stack(np.broadcast_arrays(x[None], np.array([[0], [size]]), 0), axis=-1)
    uv = np.stack(np.broadcast_arrays(u[None], np.array([[0.05], [0.05 + height]])), axis=-1)
    return sheet(points.astype(float), uv.astype(float))


def least_coverage(mesh: Mesh, *, border: float = 0.05) -> float:
    """The least over points a share of the width inside the surface's outline: at the outline itself half is right."""
    _, found, places = laid(mesh)
    triangles, barycentrics = spread_points(mesh, 4000)
    points = np.einsum("nk,nkc->nc", barycentrics, mesh.vertices[mesh.faces[triangles]])
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    inner = np.all((points >= low + border * (high - low)) & (points <= high - border * (high - low)), axis=1)
    return float(coverage(points[inner], places, found.rotations, np.exp(found.log_scales)).min())


@pytest.mark.parametrize("size", [1.3e-3, 1.0, 40.0])
def test_a_sheet_with_an_anisotropic_layout_is_closed_at_any_size(size: float) -> None:
    height = 0.1
    assert least_coverage(graded(np.ones(4), height, size=size), border=0.5 / (height * SIZE)) > OPAQUE


def test_columns_with_few_texels_beside_columns_with_many_are_closed() -> None:
    assert least_coverage(graded(np.array([1, 1, 0.2, 1, 1]), 0.9)) > OPAQUE


def test_a_texel_in_a_wide_gap_does_not_reach_far_beyond_it() -> None:
    """A column of 20 cm that has one texel across, of a sheet whose other texels are 2 cm wide."""
    _, found, _ = laid(graded(np.array([1, 1, 0.1, 1, 1]), 0.9))
    assert np.exp(found.log_scales[:, :2]).max() < 0.1


def test_a_seam_between_two_charts_is_closed() -> None:
    left, right = graded(np.ones(2), 0.37), graded(np.ones(2), 0.37)
    aside, below = np.array([1.0, 0, 0]), np.array([0, 0.47])
    moved = Mesh(right.vertices + aside, right.faces, right.uv + below, right.uv_faces)
    assert least_coverage(joined(left, moved)) > OPAQUE


def test_a_small_part_with_many_texels_is_closed() -> None:
    """An iris: waves of a few millimetres that fill most of the texture, beside a sheet of 10 m that has little."""
    u, v = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 41))
    waves = np.stack([u, v, 0.04 * np.sin(12 * u) * np.sin(12 * v)], axis=-1) * 0.005
    iris = sheet(waves, 0.05 + 0.7 * np.stack([u, v], axis=-1))
    wide, above = graded(np.ones(4), 0.1, size=10.0), np.array([0, 1.0, 0])
    mesh = joined(iris, Mesh(wide.vertices + above, wide.faces, wide.uv + 0.8 * above[:2], wide.uv_faces))
    _, found, places = laid(mesh)
    assert coverage(waves[4:-4, 4:-4].reshape(-1, 3), places, found.rotations, np.exp(found.log_scales)).min() > OPAQUE


def test_a_sliver_in_the_texture_makes_no_fog() -> None:
    """One triangle of a large sheet has a single row of texels: its surfels stay about as large as it is."""
    body = graded(np.ones(4), 0.6)
    flap = sheet(
        np.array([[[0, 2.0, 0], [0.3, 2.0, 0]], [[0, 2.3, 0], [0.3, 2.3, 0]]]),
        np.array([[[0.05, 0.9], [0.95, 0.9]], [[0.05, 0.922], [0.95, 0.922]]]),
    )
    texels, found, places = laid(joined(body, flap))
    assert np.exp(found.log_scales[places[:, 1] > 1.5]).max() < 0.3
    assert len(texels.texels)


def test_neighbouring_surfels_overlap() -> None:
    mesh = graded(np.array([1, 0.3, 2, 1.0]), 0.5)
    texels, found, places = laid(mesh)
    inner = ~found.aside.any(axis=1)  # those at the border are as wide as the surface that is left to them
    beside = np.flatnonzero((np.diff(texels.texels) == 1) & inner[1:] & inner[:-1])  # type: ignore[index]
    gap = np.linalg.norm(places[beside + 1] - places[beside], axis=1)
    extent = np.exp(found.log_scales[:, :2]).max(axis=1)
    assert np.all(gap <= (extent[beside] + extent[beside + 1]) / (2 * SPREAD) * (1 + 1e-6))


@pytest.mark.parametrize("count", [0, 1])
def test_hardly_any_texels_have_finite_surfels(count: int) -> None:
    corner = np.array([[0.0, 0.0], [1.2 / SIZE, 0.0], [0.0, 1.2 / SIZE]]) * count
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]), corner, np.array([[0, 1, 2]]))
    texels, found, _ = laid(mesh)
    assert len(texels.texels) == count
    assert np.isfinite(found.log_scales).all()


def test_surfels_lie_in_large_triangles_and_are_round_along_their_edges() -> None:
    ridge = np.array([[[0, 0, -1], [1, 0, -1]], [[0, 1, 0], [1, 1, 0]], [[0, 0, 1], [1, 0, 1]]], float)
    uv = np.stack(np.meshgrid([0.05, 0.95], [0.05, 0.5, 0.95]), axis=-1)
    roof = sheet(ridge, uv)
    texels, surfels, places = laid(roof)
    corners = roof.vertices[roof.faces[texels.triangles]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    cosines = np.sum(normals * surfels.normals, axis=1) / np.linalg.norm(normals, axis=1)
    askew = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    middle, top = np.abs(places[:, 1] - 0.5) < 0.05, places[:, 1] > 0.96
    assert np.median(askew[middle]) < 8  # normals that are smooth from edge to edge are askew by 22
    assert askew[top].min() > 15  # without what lies beyond the ridge, 10
