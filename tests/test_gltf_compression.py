"""Compressed glTF meshes."""

from pathlib import Path

import DracoPy
import meshoptimizer
import numpy as np
import pytest
from gltf_files import (
    BONES,
    POINTS,
    TRIANGLES,
    UV,
    accessor_of,
    assert_is_column,
    body,
    meshopt_view,
    primitive,
    read,
    weighted,
)

from mua.errors import InputError


@pytest.mark.parametrize("name", ["EXT_meshopt_compression", "KHR_meshopt_compression"])
@pytest.mark.parametrize("index", ["u2", "u4"])
def test_reads_meshopt_compression(tmp_path: Path, index: str, name: str) -> None:
    glb = body()
    floats = POINTS.astype("<f4")
    encoded = meshoptimizer.encode_vertex_buffer(floats, len(floats), 12)
    position = glb.accessor(POINTS)
    glb.json["accessors"][position]["bufferView"] = meshopt_view(
        glb, bytes(encoded), count=len(POINTS), stride=12, mode="ATTRIBUTES", name=name
    )
    corners = TRIANGLES.reshape(-1).astype(np.uint32)
    encoded = meshoptimizer.encode_index_buffer(corners, len(corners), len(POINTS))
    indices = glb.accessor(corners, index)
    glb.json["accessors"][indices]["bufferView"] = meshopt_view(
        glb, bytes(encoded), count=len(corners), stride=int(index[1]), mode="TRIANGLES", name=name
    )
    primitive(glb)["attributes"]["POSITION"] = position
    primitive(glb)["indices"] = indices
    glb.json["extensionsRequired"] = [name]
    surfaces = read(glb, tmp_path)
    corner_sets = {frozenset(map(tuple, np.round(t, 5))) for t in surfaces.vertices[surfaces.faces]}
    assert corner_sets == {frozenset(map(tuple, np.round(t, 5))) for t in POINTS[TRIANGLES]}


def test_reads_draco_compression(tmp_path: Path) -> None:
    bits = 16
    glb = body()
    joints, weights = weighted(BONES)
    encoded = DracoPy.encode(
        POINTS.astype(np.float32),
        TRIANGLES.astype(np.uint32),
        quantization_bits=bits,
        preserve_order=True,
        tex_coord=UV,
        generic_attributes={5: joints.astype(np.uint8), 6: weights.astype(np.float32)},
    )
    ids = {a["attribute_type"]: a["unique_id"] for a in DracoPy.decode(encoded).attributes if a["attribute_type"] != 4}
    attributes = {"POSITION": ids[0], "TEXCOORD_0": ids[3], "JOINTS_0": 5, "WEIGHTS_0": 6}
    extension = {"bufferView": glb.view(encoded), "attributes": attributes}
    primitive(glb)["extensions"] = {"KHR_draco_mesh_compression": extension}
    for accessor in (*primitive(glb)["attributes"].values(), primitive(glb)["indices"]):
        del glb.json["accessors"][accessor]["bufferView"]
    glb.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    assert_is_column(read(glb, tmp_path), bound=1.5 / 2**bits)


def test_broken_compression_is_named(tmp_path: Path) -> None:
    glb = body()
    primitive(glb)["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    with pytest.raises(InputError, match="KHR_draco_mesh_compression cannot be decoded"):
        read(glb, tmp_path)
    glb = body()
    view = meshopt_view(glb, b"\xa0garbage", count=16, stride=12, mode="ATTRIBUTES")
    accessor_of(glb, "POSITION")["bufferView"] = view
    with pytest.raises(InputError, match="EXT_meshopt_compression cannot be decoded"):
        read(glb, tmp_path)
