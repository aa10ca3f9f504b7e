"""Corners of triangles keep their place, texture coordinates, colour and material through all that assembling does."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from boxes import boxes
from scenes import BIND, GREY, HERE, at, part, placed, scene
from scipy.spatial.transform import Rotation

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.characters.assemble import assemble
from mua.scene import Material, Part, Skin

MIRROR = at(3, -2, 1, Rotation.from_euler("xyz", [40, 50, 60], degrees=True)) @ np.diag([-1.0, 1, 1, 1])


def look_of(places: Array, material: Array) -> tuple[Array, Array]:
    """Texture coordinates and colours that encode where a corner [..., 3] is, and of which material [...]."""
    uv = places[..., :2] + 0.25 * places[..., 2:]  # alike in both materials, which a seam parts nevertheless
    red = 0.5 + 0.4 * np.sin(5 * places + material[..., None])
    return uv, np.concatenate([red, np.ones((*red.shape[:-1], 1))], axis=-1)


def painted(source: Part, material: int, *, inward: Array) -> Part:
    """A part whose corners show where they are; triangles marked in `inward` are wound the other way."""
    faces = np.where(inward[:, None], source.faces[:, ::-1], source.faces)
    corners = source.positions[faces]
    uv, colors = look_of(corners, np.full(corners.shape[:2], material))
    uv_faces = np.arange(faces.size).reshape(-1, 3)
    return replace(source, material=material, faces=faces, uv=uv.reshape(-1, 2), uv_faces=uv_faces, colors=colors)


def first_three_twice(part: Part) -> dict[str, Any]:
    """The fields of a part whose first three rows come twice."""
    return {name: np.concatenate([getattr(part, name)[:3]] * 2 + [getattr(part, name)[3:]]) for name in NAMES}


def merged() -> tuple[Surfaces, list[Part]]:
    """Three boxes of two materials on one mesh, one wound inward, in a mirrored space; some triangles come twice."""
    box = boxes(wound=(1, 1, -1))
    box = replace(box, positions=(box.positions - [110, 0, 0]) * 0.05, joints=np.zeros((24, 1), int))
    upper = np.arange(36) % 12 >= 6
    parts = [
        painted(replace(box, faces=box.faces[own]), m, inward=np.zeros(18, bool))
        for m, own in enumerate((upper, ~upper))
    ]
    twice = [replace(one, **first_three_twice(one)) for one in parts]
    away = [replace(one, positions=placed(np.linalg.inv(MIRROR), one.positions)) for one in twice]
    skin = Skin(np.arange(5), np.linalg.inv(BIND) @ MIRROR)
    whole = scene(skins=(skin,), parts=tuple(away), materials=(GREY, Material("other", GREY.image)))
    return assemble(whole, HERE), parts


NAMES = ("faces", "uv_faces", "colors")


def test_corners_keep_what_they_show() -> None:
    surfaces, _ = merged()
    assert surfaces.corner_colors is not None
    corners = surfaces.vertices[surfaces.faces]
    material = np.broadcast_to(surfaces.face_material[:, None], corners.shape[:2])
    uv, colors = look_of(corners, material)
    np.testing.assert_allclose(surfaces.uv[surfaces.uv_faces], uv, atol=1e-9)
    np.testing.assert_allclose(surfaces.corner_colors, colors, atol=1e-9)
    assert (len(surfaces.faces), len(surfaces.vertices)) == (36, 24)


def test_a_texture_coordinate_belongs_to_one_vertex_and_one_material() -> None:
    surfaces, _ = merged()
    material = np.broadcast_to(surfaces.face_material[:, None], surfaces.faces.shape)
    owners = np.unique(np.stack([surfaces.uv_faces, surfaces.faces, material], axis=-1).reshape(-1, 3), axis=0)
    assert len(owners) == len(np.unique(owners[:, 0])) == len(surfaces.uv)


@pytest.mark.parametrize(("apart", "weight", "count"), [(0, 0, 4), (1e-8, 1e-7, 4), (1e-4, 0, 6), (0, 0.01, 6)])
def test_only_indistinguishable_vertices_are_welded(apart: float, weight: float, count: int) -> None:
    """Two triangles of 1 m that share an edge, whose ends are this far apart and weighted so differently."""
    edge = np.array([(1, 0, 0), (0, 1, 0)], float)
    positions = np.concatenate([[(0, 0, 0)], edge, edge + apart, [(1, 1, 0)]])
    faces = np.array([[0, 1, 2], [3, 5, 4]])
    weights = np.tile([0.75, 0.25], (6, 1))
    weights[3:5] += [-weight, weight]
    joints = np.tile([0, 1], (6, 1))
    quad = replace(part(count=6), positions=positions, faces=faces, uv_faces=faces, joints=joints, weights=weights)
    assert len(assemble(scene(parts=(quad,)), HERE).vertices) == count
