"""Templates of spheres, whose volume, seam and parts are known, and of a real character."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import trimesh
from patches import joined
from people import upright

from mua.arrays import Array
from mua.characters.read import read_character
from mua.rig.build import build_rig
from mua.rig.character import Character, Mesh
from mua.rig.expressions import Expressions
from mua.rig.template import CLOSE_ENOUGH, make_template
from mua.rig.texel_map import build_texel_map

TWO_JOINTS = upright(("low", "high"), (-1, 0), [[0.0, 0, 0], [0.0, 1, 0]])


def sphere(rows: int, columns: int, *, at: tuple[float, float, float], radius: float, square: Array) -> Mesh:
    """A closed sphere cut along one meridian and at the poles; its UVs fill `square` (low corner, side)."""
    latitude, longitude = np.linspace(0, 1, rows), np.linspace(0, 1, columns + 1)
    v, u = (grid.ravel() for grid in np.meshgrid(latitude[1:-1], longitude, indexing="ij"))
    around = np.stack(
        [np.sin(np.pi * v) * np.cos(2 * np.pi * u), np.cos(np.pi * v), np.sin(np.pi * v) * np.sin(2 * np.pi * u)]
    )
    poles = np.array([[0, 1.0, 0]] * columns + [[0, -1.0, 0]] * columns)
    middle = (np.arange(columns) + 0.5) / columns
    uv = np.concatenate([np.stack([u, v], 1), np.stack([middle, 0 * middle], 1), np.stack([middle, 1 + 0 * middle], 1)])
    ring = np.arange((rows - 3) * (columns + 1)).reshape(rows - 3, columns + 1)[:, :-1].ravel()
    k, last, top = np.arange(columns), (rows - 3) * (columns + 1), (rows - 2) * (columns + 1)
    uv_faces = np.concatenate(
        [
            np.stack([ring, ring + 1, ring + columns + 1], 1),
            np.stack([ring + 1, ring + columns + 2, ring + columns + 1], 1),
            np.stack([top + k, k + 1, k], 1),
            np.stack([last + k, last + k + 1, top + columns + k], 1),
        ]
    )
    places = np.concatenate([around.T, poles])
    _, first, weld = np.unique(np.round(places, 9), axis=0, return_index=True, return_inverse=True)
    return Mesh(
        vertices=places[first] * radius + at,
        faces=weld.ravel()[uv_faces].astype(np.int32),
        uv=uv * square[2] + square[:2],
        uv_faces=uv_faces.astype(np.int32),
    )


def character_of(*meshes: Mesh) -> Character:
    """Spheres as one mesh, bound to the high joint the more the higher they are."""
    mesh = joined(*meshes)
    vertices = mesh.vertices
    indices, weights = np.zeros((len(vertices), 8), np.int32), np.zeros((len(vertices), 8), np.float32)
    indices[:, 1] = 1
    weights[:, 1] = np.clip(vertices[:, 1] / 2 + 0.5, 0, 1)
    weights[:, 0] = 1 - weights[:, 1]
    return Character(
        name="spheres",
        skeleton=TWO_JOINTS,
        mesh=mesh,
        skin_indices=indices,
        skin_weights=weights,
        base_color=np.zeros((4, 4, 4), np.uint8),
    )


def one_sphere(rows: int = 41, columns: int = 61) -> Character:
    return character_of(sphere(rows, columns, at=(0, 0, 0), radius=1.0, square=np.array([0.05, 0.05, 0.9])))


def solid(mesh: Mesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


@pytest.mark.parametrize("wanted", [2000, 2381])
def test_a_mesh_that_is_small_enough_passes_unchanged(wanted: int) -> None:
    character = one_sphere()
    template = make_template(character, vertices=wanted)
    assert np.array_equal(template.mesh.faces, character.mesh.faces)
    assert np.array_equal(template.mesh.uv_faces, character.mesh.uv_faces)
    assert np.array_equal(template.source_vertices, np.arange(len(character.mesh.vertices)))


@pytest.mark.parametrize("wanted", [1009, 400])
def test_decimation_keeps_shape_closure_and_texels(wanted: int) -> None:
    character = one_sphere()
    template = make_template(character, vertices=wanted)
    assert abs(len(template.mesh.vertices) - wanted) <= CLOSE_ENOUGH * wanted
    assert solid(template.mesh).is_watertight
    # A chord of half the mean edge's angle lies under its arc by edge^2 / 8; a volume loses three times that.
    edge = solid(template.mesh).edges_unique_length.max()
    assert solid(character.mesh).volume * (1 - 3 * edge**2 / 8) < solid(template.mesh).volume
    dense, kept = build_texel_map(character.mesh, 97), build_texel_map(template.mesh, 97)
    assert np.isin(dense.texels, kept.texels).mean() > 0.98
    assert kept.claimed_twice == 0


def test_template_vertices_are_dense_vertices_with_their_weights() -> None:
    character = one_sphere()
    template = make_template(character, vertices=500)
    source = template.source_vertices
    assert np.array_equal(template.mesh.vertices, character.mesh.vertices[source])
    assert np.array_equal(template.skin_indices, character.skin_indices[source])
    assert np.array_equal(template.skin_weights, character.skin_weights[source])
    assert template.mesh.faces.max() == len(source) - 1
    assert np.array_equal(np.unique(template.mesh.uv_faces), np.arange(len(template.mesh.uv)))


def test_no_triangle_crosses_a_seam() -> None:
    character = one_sphere()
    template = make_template(character, vertices=400)
    pairs = {tuple(p) for p in np.stack([character.mesh.faces.ravel(), character.mesh.uv_faces.ravel()], 1).tolist()}
    uv_of = {tuple(uv): k for k, uv in enumerate(character.mesh.uv.tolist())}
    left = np.stack(
        [
            template.source_vertices[template.mesh.faces.ravel()],
            [uv_of[tuple(uv)] for uv in template.mesh.uv[template.mesh.uv_faces.ravel()].tolist()],
        ],
        axis=1,
    )
    assert {tuple(p) for p in left.tolist()} <= pairs
    corners = template.mesh.uv[template.mesh.uv_faces]
    assert np.ptp(corners[..., 0], axis=1).max() < 0.45  # a triangle over the seam would span the chart


def test_small_parts_survive() -> None:
    body = sphere(61, 81, at=(0, 0, 0), radius=1.0, square=np.array([0.0, 0.0, 0.7]))
    eyes = [sphere(15, 21, at=(x, 0.3, 1.1), radius=0.02, square=np.array([x + 0.5, 0.75, 0.2])) for x in (-0.3, 0.3)]
    template = make_template(character_of(body, *eyes), vertices=900)
    parts = solid(template.mesh).split(only_watertight=False)
    assert len(parts) == 3
    assert all(part.is_watertight for part in parts)
    dense = build_texel_map(character_of(body, *eyes).mesh, 128)
    assert np.isin(dense.texels, build_texel_map(template.mesh, 128).texels).mean() > 0.98


def test_a_part_that_cannot_be_simplified_does_not_dissolve_the_others() -> None:
    """Where every triangle is a chart of its own, no edge can be collapsed: its vertices are more than are wanted."""
    torn = sphere(41, 61, at=(0, 0, 0), radius=1.0, square=np.array([0.0, 0.0, 0.4]))
    own = np.arange(3 * len(torn.faces), dtype=np.int32).reshape(-1, 3)
    torn = Mesh(vertices=torn.vertices, faces=torn.faces, uv=torn.uv[torn.uv_faces.ravel()], uv_faces=own)
    cap = sphere(21, 31, at=(0, 1.5, 0), radius=0.6, square=np.array([0.5, 0.5, 0.4]))
    character = character_of(torn, cap)
    template = make_template(character, vertices=400)
    assert len(template.mesh.vertices) < len(character.mesh.vertices)
    kept = build_texel_map(template.mesh, 128).texels
    assert np.isin(build_texel_map(character_of(cap).mesh, 128).texels, kept).mean() > 0.9


def test_build_rig_maps_texels_of_the_template() -> None:
    character = one_sphere()
    rig, source = build_rig(character, texels=33, template_vertices=400)
    assert rig.skeleton is character.skeleton
    assert rig.texels.size == 33
    assert rig.texels.triangles.max() < len(rig.mesh.faces)
    assert np.array_equal(rig.mesh.vertices, character.mesh.vertices[source])


@pytest.mark.usefixtures("first_try")
def test_real_character_loses_little(shared_data: Any) -> None:
    character = read_character(shared_data.path("characters/White_F_3_Casual.glb"), atlas_size=256)
    rig, source = build_rig(character, texels=384)
    assert abs(len(source) - 5000) <= CLOSE_ENOUGH * 5000
    dense = build_texel_map(character.mesh, 384)
    assert np.isin(dense.texels, rig.texels.texels).mean() > 0.98
    rows = np.searchsorted(dense.texels, rig.texels.texels)
    triangles, barycentrics = dense.triangles[rows], dense.barycentrics[rows]
    there = np.einsum("nk,nkd->nd", barycentrics, character.mesh.vertices[character.mesh.faces[triangles]])
    here = np.einsum("nk,nkd->nd", rig.texels.barycentrics, rig.mesh.vertices[rig.mesh.faces[rig.texels.triangles]])
    assert np.linalg.norm(there - here, axis=1).mean() < 0.002


def test_vertices_are_kept_where_expressions_move_them() -> None:
    """A patch of a tenth of the sphere, on which every second vertex moves."""
    plain = one_sphere()
    patch = np.flatnonzero(plain.mesh.vertices[:, 2] > 0.8)
    moved = patch[::2].astype(np.int32)
    starts, offsets = np.array([0, len(moved)], np.int32), np.tile(np.array([0, 0, 0.1], np.float32), (len(moved), 1))
    character = replace(plain, expressions=Expressions(("grin",), starts, moved, offsets))
    kept = [np.isin(make_template(one, vertices=800).source_vertices, patch).sum() for one in (plain, character)]
    assert kept[0] < 0.5 * len(patch)
    assert kept[1] > 0.9 * len(patch)
    assert len(make_template(character, vertices=800).source_vertices) <= 1.25 * (1 + CLOSE_ENOUGH) * 800
    rig, source = build_rig(character, texels=64, template_vertices=800)
    assert rig.expressions is not None
    assert np.isin(source[rig.expressions.vertices], moved).all()
