"""A glTF file's JSON, buffers and accessors, checked where they enter.

glTF 2.0 (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html). The bytes of every buffer view pass through
`Document.view`, so that compressed views look like plain ones to all that follows.
"""

import base64
import json
import struct
import urllib.parse
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib

from mua.arrays import Array
from mua.characters.gltf.compression import decode_meshopt
from mua.characters.gltf.fields import read_object
from mua.errors import InputError
from mua.files.signature import told_by

COMPONENT_TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")  # which differ in what filters there are
READ_EXTENSIONS = {
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "KHR_texture_basisu",
    *MESHOPT,
    "KHR_draco_mesh_compression",
    "KHR_node_visibility",
    "VRM",
}
# Extensions that change nothing which a base-colour texture or a skeleton could show.
HARMLESS_EXTENSIONS = ("KHR_materials_", "KHR_lights_", "KHR_xmp", "EXT_lights_", "VRMC_", "KHR_animation_pointer")
ADVICE = {
    "EXT_mesh_gpu_instancing": "export it with its instances as nodes of their own",
}


class Document:
    """The parsed JSON of one file and the bytes that it points to; decoded views are kept."""

    def __init__(self, path: Path, gltf: pygltflib.GLTF2, blob: bytes | None) -> None:
        self.path = path
        self.gltf = gltf
        self._blob = blob
        self._buffers: dict[int, bytes] = {}
        self._views: dict[int, bytes] = {}

    def error(self, sentence: str) -> InputError:
        """An InputError whose sentence begins with the file's name."""
        return InputError(f"{self.path}: {sentence}")

    def item(self, name: str, index: object, *, field: str) -> Any:
        """The entry of the top-level array `name` that `field` points to."""
        items = getattr(self.gltf, name) or []
        if type(index) is not int or not 0 <= index < len(items):
            raise self.error(f"{field} is {index}, but {name} holds {len(items)} entries")
        return items[index]

    def view(self, index: Any, *, field: str) -> bytes:
        """The bytes of a buffer view, decompressed."""
        view = self.item("bufferViews", index, field=field)
        if index not in self._views:
            name, compressed = _compressed(view)
            if compressed:
                where = f"bufferViews[{index}].extensions.{name}"
                try:
                    self._views[index] = decode_meshopt(self._slice(compressed, where), compressed)
                except (ValueError, KeyError, TypeError) as broken:
                    raise self.error(f"{where} cannot be decoded: {broken}") from broken
            else:
                self._views[index] = self._slice(vars(view), f"bufferViews[{index}]")
        return self._views[index]

    def accessor(self, index: object, *, field: str, types: tuple[str, ...]) -> Array:
        """An accessor's elements [count, width]; floats and normalised integers as float64, others as stored.

        Raises an InputError where it reaches outside its buffer, has a type not in `types`, or is not finite.
        """
        accessor = self.item("accessors", index, field=field)
        where = f"accessors[{index}]"
        dtype = COMPONENT_TYPES.get(accessor.componentType)
        if dtype is None:
            raise self.error(f"{where}.componentType is {accessor.componentType}, expected one of 5120 to 5126")
        if accessor.type not in types:
            raise self.error(f"{where}.type is {accessor.type}, expected {' or '.join(types)} for {field}")
        if type(accessor.count) is not int or accessor.count < 1:
            raise self.error(f"{where}.count is {accessor.count}, expected at least 1")
        width = WIDTHS[accessor.type]
        if accessor.bufferView is None:
            elements = np.zeros((accessor.count, width), dtype)
        else:
            elements = self._elements(accessor, where, dtype=np.dtype(dtype), count=accessor.count, width=width)
        if accessor.sparse:
            elements = self._with_sparse(elements, accessor, where)
        return self.numbers(elements, where, normalized=bool(accessor.normalized))

    def _elements(self, at: Any, where: str, *, dtype: np.dtype, count: int, width: int) -> Array:
        data = self.view(at.bufferView, field=f"{where}.bufferView")
        view = self.gltf.bufferViews[at.bufferView]
        stride = _compressed(view)[1].get("byteStride") or view.byteStride or dtype.itemsize * width
        offset = at.byteOffset or 0
        end = offset + stride * (count - 1) + dtype.itemsize * width
        if offset < 0 or stride < dtype.itemsize * width or end > len(data):
            raise self.error(
                f"{where} reaches to byte {end} of bufferViews[{at.bufferView}], which holds {len(data)} bytes"
            )
        strides = (stride, dtype.itemsize)
        return np.ndarray((count, width), dtype.newbyteorder("<"), data, offset, strides).astype(dtype)

    def _with_sparse(self, elements: Array, accessor: Any, where: str) -> Array:
        sparse, where = accessor.sparse, f"{where}.sparse"
        index_type = COMPONENT_TYPES.get(sparse.indices.componentType)
        if index_type not in (np.uint8, np.uint16, np.uint32):
            raise self.error(
                f"{where}.indices.componentType is {sparse.indices.componentType}, expected an unsigned one"
            )
        if type(sparse.count) is not int or not 1 <= sparse.count <= len(elements):
            raise self.error(f"{where}.count is {sparse.count}, expected 1 to {len(elements)}")
        count = sparse.count
        rows = self._elements(sparse.indices, f"{where}.indices", dtype=np.dtype(index_type), count=count, width=1)
        if rows.max() >= len(elements):
            raise self.error(f"{where}.indices holds {rows.max()}, but the accessor has {len(elements)} elements")
        values = self._elements(
            sparse.values, f"{where}.values", dtype=elements.dtype, count=count, width=elements.shape[1]
        )
        elements = elements.copy()
        elements[rows[:, 0]] = values
        return elements

    def numbers(self, elements: Array, where: str, *, normalized: bool) -> Array:
        if elements.dtype == np.float32:
            if not np.isfinite(elements).all():
                row = int(np.argmin(np.isfinite(elements).all(axis=1)))
                raise self.error(f"{where} holds {elements[row].tolist()} at element {row}, expected finite numbers")
            return elements.astype(float)
        if normalized:
            return np.maximum(elements / np.iinfo(elements.dtype).max, -1.0)
        return elements

    def _slice(self, view: dict[str, Any], where: str) -> bytes:
        data = self._buffer(view.get("buffer"), f"{where}.buffer")
        offset, length = view.get("byteOffset") or 0, view.get("byteLength")
        if not isinstance(length, int) or offset < 0 or length < 0 or offset + length > len(data):
            raise self.error(f"{where} spans bytes {offset} to {offset} + {length} of a buffer of {len(data)} bytes")
        return data[offset : offset + length]

    def _buffer(self, index: Any, field: str) -> bytes:
        buffer = self.item("buffers", index, field=field)
        if index not in self._buffers:
            where = f"buffers[{index}]"
            if buffer.uri:
                data = self.resource(buffer.uri, field=f"{where}.uri")
            elif self._blob is not None and index == 0:
                data = self._blob
            else:
                raise self.error(f"{where} has no uri and the file has no binary chunk for it")
            if not isinstance(buffer.byteLength, int) or len(data) < buffer.byteLength:
                instead = f", {found}" if (found := told_by(data)) else ""
                raise self.error(f"{where}.byteLength is {buffer.byteLength}, but {len(data)} bytes are there{instead}")
            self._buffers[index] = data
        return self._buffers[index]

    def resource(self, uri: str, *, field: str) -> bytes:
        """The bytes of a data URI or of a file beside this one."""
        if uri.startswith("data:"):
            header, _, payload = uri.partition(",")
            try:
                return base64.b64decode(payload, validate=True) if header.endswith(";base64") else payload.encode()
            except ValueError as broken:
                raise self.error(f"{field} holds a data URI that is not base64: {broken}") from broken
        try:
            return (self.path.parent / urllib.parse.unquote(uri)).read_bytes()
        except FileNotFoundError as missing:
            raise self.error(f"{field} names {uri}, which is not there; put it beside the file") from missing
        except (OSError, ValueError) as missing:
            raise self.error(f"{field} names {uri}, which cannot be read: {missing}") from missing


def _compressed(view: Any) -> tuple[str, dict[str, Any]]:
    """The extension that compresses a buffer view, with its properties; none where the view is plain."""
    extensions = view.extensions or {}
    return next(((name, extensions[name]) for name in MESHOPT if name in extensions), ("", {}))


def load(path: Path) -> Document:
    """Parse `path`, a .gltf or .glb; an InputError names what is broken or which required extension is unknown."""
    content = path.read_bytes()
    text, blob = _glb_chunks(path, content) if content[:4] == b"glTF" else (content, None)
    try:
        raw = _parsed(text)
    except ValueError as broken:
        raise InputError(f"{path}: the glTF JSON cannot be parsed: {broken}") from broken
    if not isinstance(raw, dict) or not isinstance(raw.get("asset"), dict):
        raise InputError(f"{path}: the glTF JSON has no asset object")
    if not str(raw["asset"].get("version")).startswith("2."):
        raise InputError(f"{path}: asset.version is {raw['asset'].get('version')}, expected 2.0")
    try:
        gltf = read_object(raw)
    except ValueError as broken:
        raise InputError(f"{path}: {broken}") from broken
    for name in gltf.extensionsRequired or []:
        if name not in READ_EXTENSIONS and not name.startswith(HARMLESS_EXTENSIONS):
            advice = f"; {ADVICE[name]}" if name in ADVICE else ""
            raise InputError(f"{path}: extensionsRequired names {name}, which is not supported{advice}")
    return Document(path, gltf, blob)


def _parsed(text: bytes) -> Any:
    """The value of a JSON text; halves of surrogate pairs, which no file or console takes, become question marks."""
    raw = json.loads(text)
    if b"\\ud" not in text.lower():
        return raw
    return json.loads(json.dumps(raw, ensure_ascii=False).encode("utf-8", "replace"))


def _glb_chunks(path: Path, content: bytes) -> tuple[bytes, bytes | None]:
    if len(content) < 20:
        raise InputError(f"{path}: the GLB header is cut off after {len(content)} bytes")
    _, version, length = struct.unpack_from("<4sII", content)
    if version != 2:
        raise InputError(f"{path}: the GLB header's version is {version}, expected 2")
    if length > len(content):
        raise InputError(f"{path}: the GLB header says {length} bytes, but the file has {len(content)}")
    chunks: dict[bytes, bytes] = {}
    offset = 12
    while offset + 8 <= length:
        size, kind = struct.unpack_from("<I4s", content, offset)
        if offset + 8 + size > length:
            raise InputError(f"{path}: the GLB chunk at byte {offset} says {size} bytes, past the end of the file")
        chunks.setdefault(kind, content[offset + 8 : offset + 8 + size])
        offset += 8 + size
    if b"JSON" not in chunks:
        raise InputError(f"{path}: the GLB has no JSON chunk")
    return chunks[b"JSON"], chunks.get(b"BIN\x00")
