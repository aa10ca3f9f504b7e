"""Triangles and skin weights of glTF meshes."""

from pathlib import Path

import numpy as np
import pytest
from gltf_files import (
    BONES,
    FLOAT_BOUND,
    HEIGHTS,
    POINTS,
    TRIANGLES,
    UV,
    assert_is_column,
    body,
    primitive,
    read,
    weighted,
)


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
