"""Texels on a decimated template: each is carried by its own piece of surface and moves with its own joints."""

from dataclasses import replace

import numpy as np
import pytest
from patches import grid_faces, grid_points, joined
from tube import tube

from mua.arrays import Array
from mua.rig.character import Character, Mesh
from mua.rig.surface_points import interpolate, nearest_barycentrics
from mua.rig.template import Template, make_template
from mua.rig.texel_binding import bind_texels
from mua.rig.texel_map import TexelMap, build_texel_map
from mua.teachers.simulated.teacher import SimulatedTeacher

SIZE = 64
CELLS = 40
GAP = 0.02  # between the sheets; each is 1 high and wide


def two_sheets() -> Character:
    """A jacket over a shirt: two sheets on a joint each, whose charts meet along a wave in the texture."""
    x, y = grid_points(CELLS).T
    wave, faces, count = 0.5 + 0.04 * np.sin(4 * np.pi * y), grid_faces(CELLS, CELLS), len(x)
    sheets = [
        Mesh(np.stack([x, y, 0 * x + z], axis=1), faces, np.stack([u, y], axis=1), faces)
        for z, u in ((0, wave * x), (GAP, wave + (1 - wave) * x))
    ]
    weights = np.zeros((2 * count, 8), np.float32)
    weights[:, 0] = 1
    indices = np.zeros((2 * count, 8), np.int32)
    indices[count:, 0] = 1
    return Character(
        name="sheets",
        skeleton=tube().skeleton,
        mesh=joined(*sheets),
        skin_indices=indices,
        skin_weights=weights,
        base_color=np.zeros((4, 4, 4), np.uint8),
    )


def on_other_joint(character: Character, template: Template, texels: TexelMap) -> Array:
    """Which texels a triangle of the other sheet carries."""
    dense = build_texel_map(character.mesh, SIZE)
    kept = np.isin(dense.texels, texels.texels)
    own = character.skin_indices[character.mesh.faces[dense.triangles[kept], 0], 0]
    assert np.array_equal(dense.texels[kept], texels.texels)
    return np.asarray(template.skin_indices[template.mesh.faces[texels.triangles, 0], 0] != own)


def test_each_texel_stays_on_its_own_sheet_though_decimation_moves_the_charts_border() -> None:
    character = two_sheets()
    template = make_template(character, vertices=60)
    under = build_texel_map(template.mesh, SIZE)
    assert on_other_joint(character, template, under).any()  # the binding by the texture alone
    carried = bind_texels(character, template, size=SIZE)
    assert not on_other_joint(character, template, carried.texels).any()
    assert carried.moved > 0
    assert carried.cost.max() < 0.01
    assert carried.notes == ()


def test_every_texel_of_the_dense_surface_is_carried_by_a_point_of_a_triangle() -> None:
    character = two_sheets()
    carried = bind_texels(character, make_template(character, vertices=60), size=SIZE)
    assert np.array_equal(carried.texels.texels, build_texel_map(character.mesh, SIZE).texels)
    assert (carried.texels.barycentrics >= 0).all()
    np.testing.assert_allclose(carried.texels.barycentrics.sum(axis=1), 1, atol=1e-6)


def test_a_mesh_that_is_its_own_template_carries_its_texels_where_they_are() -> None:
    character = two_sheets()
    carried = bind_texels(character, make_template(character), size=SIZE)
    dense = build_texel_map(character.mesh, SIZE)
    assert np.array_equal(carried.texels.triangles, dense.triangles)
    assert carried.moved == 0
    assert carried.cost.max() < 1e-6


def test_what_nothing_carries_is_counted() -> None:
    character = two_sheets()
    whole = make_template(character)
    half = whole.mesh.faces[: len(whole.mesh.faces) // 2]
    template = Template(
        mesh=Mesh(whole.mesh.vertices, half, whole.mesh.uv, half),
        skin_indices=whole.skin_indices,
        skin_weights=whole.skin_weights,
        source_vertices=whole.source_vertices,
        source_uv=whole.source_uv,
    )
    carried = bind_texels(character, template, size=SIZE)
    lost = character.mesh.faces[build_texel_map(character.mesh, SIZE).triangles, 0] >= (CELLS + 1) ** 2
    assert np.array_equal(carried.unbound, lost)
    assert np.array_equal(carried.kept.texels, carried.texels.texels[~lost])
    assert carried.notes[0].startswith(f"{np.count_nonzero(lost):,} of {len(lost):,} texels are left out")


def test_what_moves_just_as_its_carrier_may_be_farther_from_it() -> None:
    """Small rigid parts vanish from the template; what is left of their joint carries their texels."""
    character = two_sheets()
    whole = make_template(character)
    first = whole.source_vertices[whole.mesh.faces[:, 0]] < (CELLS + 1) ** 2
    held = whole.mesh.faces[~first | (whole.mesh.vertices[whole.mesh.faces, 0].max(axis=1) <= 0.5)]
    template = replace(whole, mesh=Mesh(whole.mesh.vertices, held, whole.mesh.uv, held))
    carried = bind_texels(character, template, size=SIZE)
    dense = build_texel_map(character.mesh, SIZE)
    at = interpolate(character.mesh.vertices, character.mesh.faces[dense.triangles], dense.barycentrics)
    own = (at[:, 2] < GAP / 2) & (at[:, 0] > 0.5 + 0.04)  # lies on the sheet, beyond what is near at any rate
    kept = ~carried.unbound[own]
    assert np.array_equal(kept, at[own, 0] - 0.5 <= 0.15)
    assert kept.any()
    assert not on_other_joint(character, template, carried.kept).any()


def test_the_teacher_stands_on_carried_texels() -> None:
    character = two_sheets()
    teacher = SimulatedTeacher(character, texels=SIZE, template_vertices=60)
    assert not on_other_joint(character, make_template(character, vertices=60), teacher.rig.texels).any()


def test_no_texels_are_carried_by_nothing() -> None:
    character = two_sheets()
    nowhere = Mesh(character.mesh.vertices, character.mesh.faces, 0 * character.mesh.uv, character.mesh.uv_faces)
    empty = Character("none", character.skeleton, nowhere, character.skin_indices, character.skin_weights, np.zeros(0))
    carried = bind_texels(empty, make_template(empty), size=SIZE)
    assert len(carried.texels.texels) == len(carried.cost) == 0


@pytest.mark.parametrize("seed", [0, 1])
def test_nearest_points_of_triangles_are_nearer_than_any_other(seed: int) -> None:
    rng = np.random.default_rng(seed)
    corners, points = rng.normal(size=(50, 3, 3)), rng.normal(size=(50, 3))
    corners[::7, 1] = corners[::7, 0]  # triangles without area
    found = nearest_barycentrics(points, corners)
    assert (found >= 0).all()
    np.testing.assert_allclose(found.sum(axis=1), 1)
    least = np.linalg.norm(np.einsum("nk,nkc->nc", found, corners) - points, axis=1)
    grid = rng.dirichlet(np.ones(3), size=2000)
    others = np.linalg.norm(np.einsum("sk,nkc->nsc", grid, corners) - points[:, None], axis=2).min(axis=1)
    assert np.all(least <= others + 1e-12)
    assert np.all(others - least < 0.2)


def test_interpolation_meets_the_corners() -> None:
    values = np.arange(12.0).reshape(4, 3)
    np.testing.assert_array_equal(interpolate(values, np.array([[0, 1, 3]]), np.array([[0.0, 0, 1]])), values[3:])
