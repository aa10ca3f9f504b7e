"""Texel maps against a brute-force search over all triangles in exact arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from patches import grid_faces, grid_points

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.texel_map import TexelMap, build_texel_map

# A barycentric is a quotient of areas of a few float64 operations, then rounded to float32.
BARYCENTRIC_BOUND = 4 * float(np.finfo(np.float32).eps)
# uv * size and the centre lie below 64 texels; their rounding moves a point by a few ulps of that, twice per corner.
POSITION_BOUND = 64 * 16 * float(np.finfo(np.float32).eps)


def flat_mesh(uv: Array, uv_faces: Array) -> Mesh:
    """A mesh whose positions are its UVs, so that a barycentric point says where it is."""
    vertices = np.column_stack([uv, np.zeros(len(uv))])
    return Mesh(vertices=vertices, faces=uv_faces.astype(np.int32), uv=uv, uv_faces=uv_faces.astype(np.int32))


def random_mesh(seed: int, faces: int) -> Mesh:
    """Triangles on a coarse grid of binary fractions, so that edges often run through texel centres."""
    rng = np.random.default_rng(seed)
    uv = rng.integers(0, 17, (3 * faces, 2)) / 16
    return flat_mesh(uv, rng.integers(0, len(uv), (faces, 3)))


def grid_mesh(cells: int) -> Mesh:
    """The unit square as 2 x cells x cells triangles that share edges and vertices."""
    return flat_mesh(grid_points(cells), grid_faces(cells, cells))


def exact_search(mesh: Mesh, size: int) -> tuple[dict[int, int], int]:
    """First covering triangle of each texel, and how many texels lie strictly inside two, in rational numbers."""
    owners: dict[int, int] = {}
    twice = 0
    for texel in range(size * size):
        row, column = divmod(texel, size)
        point = (Fraction(2 * column + 1, 2 * size), Fraction(2 * row + 1, 2 * size))
        inside = 0
        for face, corners in enumerate(mesh.uv_faces):
            a, b, c = [tuple(map(Fraction, mesh.uv[k])) for k in corners]
            spans = [_span(a, b, point), _span(b, c, point), _span(c, a, point)]
            if sum(spans) == 0:
                continue
            signs = [span * sum(spans) for span in spans]
            if min(signs) >= 0:
                owners.setdefault(texel, face)
            inside += min(signs) > 0
        twice += inside > 1
    return owners, twice


def _span(a: tuple[Fraction, ...], b: tuple[Fraction, ...], p: tuple[Fraction, ...]) -> Fraction:
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def assert_points_are_texel_centres(mesh: Mesh, texel_map: TexelMap) -> None:
    corners = mesh.vertices[mesh.faces[texel_map.triangles], :2]
    points = np.einsum("nk,nkd->nd", texel_map.barycentrics.astype(np.float64), corners) * texel_map.size
    row, column = np.divmod(texel_map.texels, texel_map.size)
    np.testing.assert_allclose(points, np.stack([column, row], axis=1) + 0.5, rtol=0, atol=POSITION_BOUND)
    assert (texel_map.barycentrics >= 0).all()
    np.testing.assert_allclose(texel_map.barycentrics.sum(axis=1), 1, rtol=0, atol=BARYCENTRIC_BOUND)


@pytest.mark.parametrize("size", [1, 2, 7, 16])
@pytest.mark.parametrize("seed", [0, 1])
def test_equals_exact_search_over_all_triangles(seed: int, size: int) -> None:
    mesh = random_mesh(seed, 6)
    owners, twice = exact_search(mesh, size)
    found = build_texel_map(mesh, size)
    assert dict(zip(found.texels.tolist(), found.triangles.tolist(), strict=True)) == owners
    assert found.claimed_twice == twice
    assert_points_are_texel_centres(mesh, found)


@pytest.mark.parametrize(("cells", "size"), [(1, 1), (3, 31), (8, 32), (13, 64)])
def test_shared_edges_leave_no_gap_and_no_overlap(cells: int, size: int) -> None:
    found = build_texel_map(grid_mesh(cells), size)
    assert np.array_equal(found.texels, np.arange(size * size))
    assert found.claimed_twice == 0


def test_first_face_in_file_order_wins_an_overlap() -> None:
    square = grid_mesh(1)
    mesh = flat_mesh(square.uv, np.concatenate([square.uv_faces, square.uv_faces[::-1]]))
    found = build_texel_map(mesh, 8)
    assert set(found.triangles.tolist()) == {0, 1}
    assert found.claimed_twice == 64 - 8  # the centres on the diagonal are strictly inside none


def test_mirrored_triangles_cover_what_their_mirror_image_covers() -> None:
    mesh = grid_mesh(3)
    found = build_texel_map(mesh, 11)
    mirrored = build_texel_map(flat_mesh(mesh.uv, mesh.uv_faces[:, ::-1]), 11)
    assert np.array_equal(found.triangles, mirrored.triangles)
    np.testing.assert_allclose(found.barycentrics, mirrored.barycentrics[:, ::-1], rtol=0, atol=BARYCENTRIC_BOUND)


def test_triangles_without_area_cover_nothing() -> None:
    uv = np.array([[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]])
    found = build_texel_map(flat_mesh(uv, np.array([[0, 1, 2], [1, 1, 1], [0, 0, 2]])), 4)
    assert not found.texels.size


def test_empty_mesh_has_no_texels() -> None:
    found = build_texel_map(flat_mesh(np.empty((0, 2)), np.empty((0, 3), np.int32)), 5)
    assert found.texels.shape == (0,)
    assert found.barycentrics.shape == (0, 3)


def test_what_leaves_the_unit_square_is_cut_off() -> None:
    uv = np.array([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]])
    found = build_texel_map(flat_mesh(uv, np.array([[0, 1, 2]])), 3)
    assert np.array_equal(found.texels, np.arange(9))


def test_more_candidates_than_fit_at_once_give_the_same_map(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = random_mesh(2, 9)
    whole = build_texel_map(mesh, 16)
    monkeypatch.setattr("mua.rig.texel_map.CANDIDATES_AT_ONCE", 50)
    pieces = build_texel_map(mesh, 16)
    assert np.array_equal(whole.triangles, pieces.triangles)
    assert whole.claimed_twice == pieces.claimed_twice
