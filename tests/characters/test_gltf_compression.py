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
    Glb,
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


BITS = 16  # to which Draco rounds positions


def by_draco(glb: Glb, **further: np.ndarray) -> None:
    """Compress the mesh of `body()`, with `further` attributes as stored."""
    joints, weights = weighted(BONES)
    generic = {"JOINTS_0": joints.astype(np.uint8), "WEIGHTS_0": weights.astype(np.float32), **further}
    ids = {name: 5 + k for k, name in enumerate(generic)}
    encoded = DracoPy.encode(
        POINTS.astype(np.float32),
        TRIANGLES.astype(np.uint32),
        quantization_bits=BITS,
        preserve_order=True,
        tex_coord=UV,
        generic_attributes={ids[name]: values for name, values in generic.items()},
    )
    own = {a["attribute_type"]: a["unique_id"] for a in DracoPy.decode(encoded).attributes if a["attribute_type"] != 4}
    extension = {"bufferView": glb.view(encoded), "attributes": {"POSITION": own[0], "TEXCOORD_0": own[3], **ids}}
    primitive(glb)["extensions"] = {"KHR_draco_mesh_compression": extension}
    for accessor in (*primitive(glb)["attributes"].values(), primitive(glb)["indices"]):
        del glb.json["accessors"][accessor]["bufferView"]
    glb.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]


def test_reads_draco_compression(tmp_path: Path) -> None:
    glb = body()
    by_draco(glb)
    assert_is_column(read(glb, tmp_path), bound=1.5 / 2**BITS)


def test_draco_may_hold_wider_numbers_than_the_accessor_says(tmp_path: Path) -> None:
    """Blender's exporter stores colours of 16 bits in 32."""
    colors = np.full((len(POINTS), 4), 0.5 * 65535)
    glb = body()
    primitive(glb)["attributes"]["COLOR_0"] = glb.accessor(colors, "u2", normalized=True)
    by_draco(glb, COLOR_0=colors.astype(np.uint32))
    corners = read(glb, tmp_path).corner_colors
    assert corners is not None
    np.testing.assert_allclose(corners[..., :3], 0.5, atol=1 / 65535)


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
