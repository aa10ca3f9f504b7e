"""Whether rays meet a surface, against every triangle in turn in double precision."""

# mypy: disable-error-code="index, no-untyped-def"
# (the body of the kernel is Warp's language, not Python)

from itertools import product

import numpy as np
import pytest
import warp as wp
from tube import tube

from mua.arrays import Array
from mua.teachers.simulated.rays import DEVICE, LANES, Boxes, Tree, meets


@wp.kernel(enable_backward=False)
def ask(
    tree: Boxes,
    origins: wp.array[wp.vec3],
    directions: wp.array[wp.vec3],
    met: wp.array[wp.bool],
):
    i = wp.tid()
    met[i] = meets(tree, origins[i], directions[i])


def met(tree: Tree, vertices: Array, origins: Array, directions: Array) -> Array:
    """Which rays [n] meet a surface."""
    found = wp.zeros(len(origins), dtype=bool, device=DEVICE)
    rays: list[wp.array] = [wp.array(values, dtype=wp.vec3, device=DEVICE) for values in (origins, directions)]
    wp.launch(ask, dim=len(origins), inputs=[tree.at(vertices), *rays], outputs=[found], device=DEVICE)
    return np.asarray(found.numpy())


def by_every_triangle(triangles: Array, origins: Array, directions: Array) -> Array:
    """Which rays [n] meet any of triangles [F, 3, 3]: the plane's point, and its barycentric coordinates."""
    columns = np.moveaxis(triangles, 1, 2)[None] - origins[:, None, :, None]
    along = np.linalg.solve(columns, directions[:, None, :, None])[..., 0]  # directions as sums of corners
    return np.asarray(along.min(axis=2).max(axis=1) >= 0)


def random_rays(count: int, seed: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    directions = rng.normal(size=(count, 3))
    return rng.uniform(-1, 1, (count, 3)), directions / np.linalg.norm(directions, axis=1, keepdims=True)


@pytest.mark.parametrize("count", [1, LANES, LANES + 1, LANES**2 - 1, LANES**2 + 1, LANES**3 + 1])
def test_rays_meet_what_they_meet_of_every_triangle(count: int) -> None:
    rng = np.random.default_rng(count)
    size = 2 / np.sqrt(count)
    triangles = rng.uniform(-1, 1, (count, 1, 3)) + rng.uniform(-size, size, (count, 3, 3))
    vertices, faces = triangles.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)
    rays = random_rays(200, count)
    expected = by_every_triangle(triangles, *rays)
    np.testing.assert_array_equal(met(Tree(vertices, faces), vertices, *rays), expected)
    assert 0 < expected.sum() < 200


def test_a_surface_may_move_beneath_its_tree() -> None:
    mesh = tube().mesh
    moved = mesh.vertices * [3, 1, 0.5] + [0.2, -0.1, 0.1]
    rays = random_rays(300, 0)
    found = met(Tree(mesh.vertices, mesh.faces), moved, *rays)
    np.testing.assert_array_equal(found, by_every_triangle(moved[mesh.faces], *rays))
    assert (found != met(Tree(mesh.vertices, mesh.faces), mesh.vertices, *rays)).any()


def test_no_ray_passes_between_triangles_or_along_an_axis() -> None:
    """From the middle of a cube to its corners and to the middles of its sides and edges, which lie between faces."""
    corners = np.array(list(product((-1, 1), repeat=3))) / 2
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [0, 2, 6, 4], [1, 5, 7, 3], [2, 3, 7, 6]])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    steps = np.array([step for step in product((-1.0, 0.0, 1.0), repeat=3) if any(step)])
    away = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    tree = Tree(corners, faces)
    assert met(tree, corners, np.zeros_like(away), away).all()
    assert not met(tree, corners, 2 * away, away).any()


def test_nothing_meets_a_surface_without_faces() -> None:
    assert not met(Tree(np.zeros((3, 3)), np.empty((0, 3), int)), np.zeros((3, 3)), *random_rays(20, 1)).any()
