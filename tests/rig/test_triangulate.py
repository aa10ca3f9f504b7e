"""The texel grid closes over UV seams, faces outwards and stays off what only lies beside it in the texture."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from patches import joined
from synthetic_avatar import texels_at
from tube import tube

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.texel_map import TexelMap, build_texel_map
from mua.rig.triangulate import triangulate

CUBE_CELLS = 5  # along an edge of the cube


def cube(*, mirrored: int = 0) -> Mesh:
    """The surface of the cube 0..1, each side a chart of its own; the first `mirrored` charts are turned over."""
    axis = np.linspace(0, 1, CUBE_CELLS + 1)
    s, t = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    corner = np.arange((CUBE_CELLS + 1) ** 2).reshape(CUBE_CELLS + 1, -1)
    a, b, c, d = (x.ravel() for x in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    quads = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    places, uv, faces = [], [], []
    for side in range(6):
        k, far = divmod(side, 2)
        place = np.empty((len(s), 3))
        place[:, k], place[:, (k + 1) % 3], place[:, (k + 2) % 3] = far, s, t
        row, column = divmod(side, 3)
        across = 1 - s if (far == 0) != (side < mirrored) else s
        faces.append((quads if far else quads[:, ::-1]) + side * len(s))
        places.append(place)
        uv.append((np.stack([across, t], axis=1) * 0.8 + [column + 0.1, row + 0.1]) / 3)
    vertices, welded = np.unique(np.concatenate(places).round(9), axis=0, return_inverse=True)
    corners = np.concatenate(faces).astype(np.int32)
    return Mesh(vertices, welded.astype(np.int32)[corners], np.concatenate(uv), corners)


def places(mesh: Mesh, texels: TexelMap) -> Array:
    return np.einsum("nk,nki->ni", texels.barycentrics, mesh.vertices[mesh.faces[texels.triangles]])


def solid(mesh: Mesh, size: int) -> trimesh.Trimesh:
    """The surface over the mesh at rest, as an independent library sees it."""
    texels = build_texel_map(mesh, size)
    return trimesh.Trimesh(places(mesh, texels), triangulate(mesh, texels).triangles(texels), process=False)


@pytest.mark.parametrize("size", [31, 64, 97])
def test_closes_six_charts_to_one_body(size: int) -> None:
    body = solid(cube(), size)
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.euler_number == 2
    # outwards: the volume is positive; smaller than the cube by the half texel that its edges are cut off by
    assert (1 - 3 * 3 / 0.8 / size) ** 3 < body.volume < 1


@pytest.mark.parametrize("size", [31, 64])
def test_turns_mirrored_charts_outwards(size: int) -> None:
    body = solid(cube(mirrored=3), size)
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.volume > 0


@pytest.mark.parametrize("size", [37, 64])
def test_keeps_the_openings_of_the_template(size: int) -> None:
    mesh = tube().mesh
    body = solid(mesh, size)
    once = trimesh.grouping.group_rows(body.edges_sorted, require_count=1)
    loops = trimesh.graph.connected_components(body.edges_sorted[once], min_len=1)
    assert len(loops) == 2  # top and bottom
    assert body.euler_number == 0
    outward = (body.face_normals * (body.triangles_center * [1, 0, 1])).sum(axis=1)
    assert (outward > 0).all()


def test_leaves_limbs_apart_that_touch_in_the_texture() -> None:
    one = tube().mesh
    low, high = one.uv.min(axis=0), one.uv.max(axis=0)
    uv = (one.uv - low) / (high - low) * [0.5, 1]
    beside = replace(one, vertices=one.vertices + np.array([1.0, 0, 0]), uv=uv + np.array([0.5, 0]))
    body = solid(joined(replace(one, uv=uv), beside), 64)
    assert len(body.split(only_watertight=False)) == 2
    assert body.edges_unique_length.max() < 0.2


@pytest.mark.parametrize("mirrored", [0, 6])
def test_every_square_of_texels_inside_a_chart_has_two_triangles_cut_along_its_shorter_diagonal(mirrored: int) -> None:
    mesh = cube(mirrored=mirrored)
    texels = build_texel_map(mesh, 31)
    at = places(mesh, texels)
    of_texel = {(t // 31, t % 31): n for n, t in enumerate(texels.texels.tolist())}
    side = texels.triangles // (len(mesh.faces) // 6)  # each a chart
    triangles = {frozenset(triangle) for triangle in triangulate(mesh, texels).triangles(texels).tolist()}
    squares = 0
    for row, column in of_texel:
        corners = [of_texel.get((row + r, column + c)) for r in (0, 1) for c in (0, 1)]
        if None not in corners and len({side[n] for n in corners}) == 1:
            a, b, c, d = corners
            along = {a, d} if np.linalg.norm(at[a] - at[d]) <= np.linalg.norm(at[b] - at[c]) else {b, c}
            assert {t for t in triangles if t <= {a, b, c, d}} == {frozenset(along | {n}) for n in {a, b, c, d} - along}
            squares += 1
    assert squares > 300


@pytest.mark.parametrize("count", [0, 1, 2])
def test_makes_no_triangle_of_too_few_texels(count: int) -> None:
    mesh = tube().mesh
    texels = build_texel_map(mesh, 32)
    few = texels_at(texels, slice(count))
    assert triangulate(mesh, few).triangles(few).shape == (0, 3)
