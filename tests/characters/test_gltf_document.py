"""Buffers, accessors and JSON of glTF files."""

import base64
import json
from pathlib import Path

import numpy as np
import pytest
from gltf_files import POINTS, assert_is_column, body, primitive, read

from mua.characters.read import read_surfaces
from mua.errors import InputError


def test_reads_json_with_buffer_beside_it(tmp_path: Path) -> None:
    glb = body()
    glb.json["buffers"] = [{"byteLength": len(glb.blob), "uri": "the%20buffer.bin"}]
    (tmp_path / "the buffer.bin").write_bytes(glb.blob)
    (tmp_path / "body.gltf").write_text(json.dumps(glb.json))
    assert_is_column(read_surfaces(tmp_path / "body.gltf"))


def test_a_buffer_that_was_not_fetched_is_named(tmp_path: Path) -> None:
    glb = body()
    glb.json["buffers"] = [{"byteLength": len(glb.blob), "uri": "body.bin"}]
    (tmp_path / "body.bin").write_bytes(b"version https://git-lfs.github.com/spec/v1\n")
    (tmp_path / "body.gltf").write_text(json.dumps(glb.json))
    with pytest.raises(InputError, match="but 43 bytes are there, a Git LFS pointer; fetch the file"):
        read_surfaces(tmp_path / "body.gltf")


def test_reads_buffer_in_a_data_uri(tmp_path: Path) -> None:
    glb = body()
    uri = "data:application/octet-stream;base64," + base64.b64encode(glb.blob).decode()
    glb.json["buffers"] = [{"byteLength": len(glb.blob), "uri": uri}]
    (tmp_path / "body.gltf").write_text(json.dumps(glb.json))
    assert_is_column(read_surfaces(tmp_path / "body.gltf"))


def test_reads_sparse_accessors(tmp_path: Path) -> None:
    glb = body()
    moved = np.array([3, 7])
    base = POINTS.copy()
    base[moved] = 0
    position = glb.accessor(base)
    glb.json["accessors"][position]["sparse"] = {
        "count": 2,
        "indices": {"bufferView": glb.view(moved.astype("<u2").tobytes()), "componentType": 5123},
        "values": {"bufferView": glb.view(POINTS[moved].astype("<f4").tobytes())},
    }
    primitive(glb)["attributes"]["POSITION"] = position
    assert_is_column(read(glb, tmp_path))


def test_truncation_anywhere_is_refused(tmp_path: Path) -> None:
    content = body().content()
    path = tmp_path / "body.glb"
    assert len(content) > 1000
    for length in range(len(content)):
        path.write_bytes(content[:length])
        with pytest.raises(InputError, match=r"body\.glb"):
            read_surfaces(path)


def test_bad_json_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "body.gltf"
    for text in (b"", b"{", b"[]", b"7", b'{"asset": 3}', b"\xff\xfe", b'{"asset": {"version": "2.0"}, "meshes": [3]}'):
        path.write_bytes(text)
        with pytest.raises(InputError, match=r"body\.gltf"):
            read_surfaces(path)
