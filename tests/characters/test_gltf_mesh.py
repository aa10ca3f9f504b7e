"""Triangles and skin weights of glTF meshes."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import (
    BONES,
    FLOAT_BOUND,
    HEIGHTS,
    POINTS,
    TRIANGLES,
    UV,
    Glb,
    assert_is_column,
    body,
    primitive,
    read,
    weighted,
)

from mua.characters.read import read_character
from mua.errors import InputError


def test_reads_positions_weights_and_texture_coordinates(tmp_path: Path) -> None:
    surfaces = read(body(), tmp_path)
    assert_is_column(surfaces)
    assert surfaces.skeleton.names == ("hips", "spine", "head")
    assert surfaces.skeleton.names[surfaces.skeleton.root] == "hips"
    np.testing.assert_allclose(surfaces.skeleton.bind_translations[:, 1], [0, 0.5, 0.5], atol=FLOAT_BOUND)
    assert not surfaces.notes


def test_welds_unindexed_triangles(tmp_path: Path) -> None:
    glb = body()
    corners = TRIANGLES.reshape(-1)
    joints, weights = weighted(BONES[corners])
    primitive(glb)["attributes"] = {
        "POSITION": glb.accessor(POINTS[corners]),
        "TEXCOORD_0": glb.accessor(UV[corners]),
        "JOINTS_0": glb.accessor(joints, "u2"),
        "WEIGHTS_0": glb.accessor(weights),
    }
    del primitive(glb)["indices"]
    surfaces = read(glb, tmp_path)
    assert len(surfaces.vertices) == len(POINTS)
    assert_is_column(surfaces)


def test_merges_primitives_and_materials(tmp_path: Path) -> None:
    glb = body()
    whole = primitive(glb)
    halves = [whole | {"indices": glb.accessor(t.reshape(-1), "u4"), "material": m}
              for m, t in ((1, TRIANGLES[:12]), (0, TRIANGLES[12:]))]  # fmt: skip
    glb.json["meshes"][0]["primitives"] = halves
    glb.json["materials"] = [
        {"name": "skin", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.2140411, 0, 0.5]}},
        {"name": "veil", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}},
    ]
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert len(surfaces.vertices) == len(POINTS)  # the border between the halves is one row of vertices
    names = [surfaces.materials[m].name for m in surfaces.face_material]
    assert names == ["veil"] * 12 + ["skin"] * 12
    colors = {m.name: m.image[0, 0].tolist() for m in surfaces.materials}
    assert colors == {"skin": [255, 127, 0, 255], "veil": [255, 255, 255, 128]}


@pytest.mark.parametrize("mode", [5, 6])
def test_reads_strips_and_fans(tmp_path: Path, mode: int) -> None:
    glb = body()
    indices = [0, 1, 4, 5, 8] if mode == 5 else [0, 1, 5, 4]
    primitive(glb).update(mode=mode, indices=glb.accessor(np.array(indices), "u1"))
    expected = [[0, 1, 4], [1, 5, 4], [4, 5, 8]] if mode == 5 else [[1, 5, 0], [5, 4, 0]]
    surfaces = read(glb, tmp_path)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], POINTS[np.array(expected)], atol=FLOAT_BOUND)


def test_reads_quantised_attributes(tmp_path: Path) -> None:
    glb = body()
    steps = 30000 / 1.5
    binds = np.tile(np.eye(4), (3, 1, 1))
    binds[:, :3, :3] *= 1.5 * 32767 / 30000
    binds[:, 1, 3] = -HEIGHTS
    joints, weights = weighted(BONES)
    attributes = {
        "POSITION": glb.accessor(np.pad(np.round(POINTS * steps), ((0, 0), (0, 1))), "i2"),
        "TEXCOORD_0": glb.accessor(np.round(UV * 65535), "u2", normalized=True),
        "JOINTS_0": glb.accessor(joints, "u1"),
        "WEIGHTS_0": glb.accessor(weights * 255, "u1", normalized=True),
    }
    glb.json["accessors"][attributes["POSITION"]] |= {"type": "VEC3", "normalized": True}
    glb.json["bufferViews"][glb.json["accessors"][attributes["POSITION"]]["bufferView"]]["byteStride"] = 8
    glb.json["skins"][0]["inverseBindMatrices"] = glb.accessor(binds.swapaxes(1, 2))
    primitive(glb)["attributes"] = attributes
    glb.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    assert_is_column(read(glb, tmp_path), bound=1 / steps)


def test_quantised_mesh_that_rests_in_another_pose_keeps_its_place(tmp_path: Path) -> None:
    """gltfpack moves and scales positions to whole numbers and folds that into the inverse binds."""
    steps, low = 30000 / 1.5, POINTS.min(axis=0)
    binds = np.tile(np.eye(4), (3, 1, 1))
    binds[:, :3, :3] /= steps
    binds[:, :3, 3] = low - np.stack([np.zeros(3), HEIGHTS, np.zeros(3)], axis=1)
    glb = body()
    glb.json["nodes"][1]["rotation"] = [0.28, 0, 0, 0.96]
    glb.json["nodes"][2]["rotation"] = [0, 0.28, 0, 0.96]
    glb.json["skins"][0]["inverseBindMatrices"] = glb.accessor(binds.swapaxes(1, 2))
    primitive(glb)["attributes"]["POSITION"] = glb.accessor(np.round((POINTS - low) * steps), "u2")
    surfaces = read(glb, tmp_path)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], POINTS[TRIANGLES], atol=1 / steps)


def test_second_set_of_influences_counts(tmp_path: Path) -> None:
    glb = body()
    _, weights = weighted(BONES)
    more = np.zeros((len(BONES), 4))
    more[:, 0] = 1
    primitive(glb)["attributes"] |= {
        "WEIGHTS_0": glb.accessor(weights * 0.25),
        "JOINTS_1": glb.accessor(np.full((len(BONES), 4), 2), "u1"),
        "WEIGHTS_1": glb.accessor(more * 0.75),
    }
    surfaces = read(glb, tmp_path)
    assert (surfaces.skin_indices[:, 0] == 2).all()
    np.testing.assert_allclose(np.unique(surfaces.skin_weights[:, 0]), [0.75, 1])


RAMP = np.linspace(0, 1, len(POINTS) * 4).reshape(-1, 4)


def with_colors(values: Any, dtype: str = "f4", **fields: Any) -> Glb:
    glb = body()
    primitive(glb)["attributes"]["COLOR_0"] = glb.accessor(values, dtype, **fields)
    return glb


def test_vertex_colours_reach_the_corners_of_triangles(tmp_path: Path) -> None:
    surfaces = read(with_colors(RAMP[:, :3]), tmp_path)
    assert surfaces.corner_colors is not None
    np.testing.assert_allclose(surfaces.corner_colors[..., :3], RAMP[TRIANGLES][..., :3], atol=1e-7)
    assert (surfaces.corner_colors[..., 3] == 1).all()


@pytest.mark.parametrize("fields", [{"normalized": True}, {}])
@pytest.mark.parametrize(("dtype", "most"), [("u1", 255), ("u2", 65535)])
def test_vertex_colours_in_whole_numbers_are_brought_to_one(
    tmp_path: Path, dtype: str, most: int, fields: dict[str, Any]
) -> None:
    surfaces = read(with_colors(np.round(RAMP * most), dtype, **fields), tmp_path)
    assert surfaces.corner_colors is not None
    np.testing.assert_allclose(surfaces.corner_colors[..., :3], RAMP[TRIANGLES][..., :3], atol=0.51 / most)


def test_opacity_of_vertices_counts_where_the_material_is_not_opaque(tmp_path: Path) -> None:
    for mode, expected in (("OPAQUE", np.ones_like(RAMP)), ("BLEND", RAMP)):
        glb = with_colors(RAMP)
        glb.json["materials"] = [{"alphaMode": mode}]
        primitive(glb)["material"] = 0
        surfaces = read(glb, tmp_path)
        assert surfaces.corner_colors is not None
        np.testing.assert_allclose(surfaces.corner_colors[..., 3], expected[TRIANGLES][..., 3], atol=1e-7)


def test_white_vertices_leave_no_colours(tmp_path: Path) -> None:
    assert read(with_colors(np.ones((len(POINTS), 3))), tmp_path).corner_colors is None


def test_toon_material_does_not_look_at_vertex_colours(tmp_path: Path) -> None:
    glb = with_colors(RAMP)
    glb.json["materials"] = [{"extensions": {"VRMC_materials_mtoon": {}}}]
    primitive(glb)["material"] = 0
    assert read(glb, tmp_path).corner_colors is None


def test_vertex_colours_end_in_the_atlas(tmp_path: Path) -> None:
    """A ramp of red up the column: half of its light, sRGB 188, is at half of its height."""
    red = np.ones((len(POINTS), 3))
    red[:, 0] = POINTS[:, 1] / 1.5
    with_colors(red).save(tmp_path / "body.glb")
    character = read_character(tmp_path / "body.glb", atlas_size=64)
    mesh = character.mesh
    corners = mesh.uv[mesh.uv_faces].mean(axis=1)
    rows, columns = (np.clip(corners[:, axis] * 64, 0, 63).astype(int) for axis in (1, 0))
    light = (character.base_color[rows, columns, 0] / 255.0) ** 2.2
    height = mesh.vertices[mesh.faces].mean(axis=1)[:, 1] / 1.5
    np.testing.assert_allclose(light, height, atol=0.08)  # a texel of 64 away, and 2.2 for the exact curve
    assert (character.base_color[..., 1] == 255).all()


def morphed(glb: Glb, *, mesh: list[float] | None, node: list[Any] | None) -> Glb:
    """Two targets: one moves all by 1 m along X, one by 1 m along Z."""
    primitive(glb)["targets"] = [{"POSITION": glb.accessor(np.tile(row, (16, 1)))} for row in ([1, 0, 0], [0, 0, 1])]
    glb.json["meshes"][0] |= {} if mesh is None else {"weights": mesh}
    glb.json["nodes"][3] |= {} if node is None else {"weights": node}
    return glb


@pytest.mark.parametrize(
    ("mesh", "node", "moved"),
    [(None, None, [0, 0, 0]), ([0.5, 0], None, [0.5, 0, 0]), ([0.5, 0], [0, 0.25], [0, 0, 0.25])],
)
def test_morph_targets_stand_at_their_weights_at_rest(tmp_path: Path, mesh: Any, node: Any, moved: Any) -> None:
    surfaces = read(morphed(body(), mesh=mesh, node=node), tmp_path)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], (POINTS + moved)[TRIANGLES], atol=FLOAT_BOUND)
    assert not surfaces.notes


def test_broken_morph_targets_are_named(tmp_path: Path) -> None:
    glb = morphed(body(), mesh=[1, 0], node=None)
    primitive(glb)["targets"][0]["POSITION"] = glb.accessor([[0, 0, 0]])
    with pytest.raises(InputError, match=r"targets\[0\]\.POSITION holds 1 elements for 16 vertices"):
        read(glb, tmp_path)
    with pytest.raises(InputError, match=r"nodes\[3\]\.weights\[0\] is a, expected a number"):
        read(morphed(body(), mesh=None, node=["a"]), tmp_path)
