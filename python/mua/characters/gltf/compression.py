"""The two compressions of glTF geometry: meshopt, by its EXT and its KHR extension, and KHR_draco_mesh_compression."""

import ctypes
from typing import Any

import DracoPy
import meshoptimizer
import numpy as np
from meshoptimizer.decoder import lib

from mua.arrays import Array

MAX_MESHOPT_STRIDE = 256  # bytes per vertex that the codec takes


def decode_meshopt(encoded: bytes, properties: dict[str, Any]) -> bytes:
    """Decode the bytes of a buffer view compressed by EXT_meshopt_compression or KHR_meshopt_compression.

    `properties` is the extension's object (count, byteStride, mode, filter). Raises ValueError where bytes and
    properties do not fit together.
    """
    count, stride = properties["count"], properties["byteStride"]
    mode, kind = properties["mode"], properties.get("filter", "NONE")
    if mode == "ATTRIBUTES":
        return _decode_attributes(encoded, count=count, stride=stride, kind=kind)
    if stride not in (2, 4):
        raise ValueError(f"byteStride is {stride}, expected 2 or 4 in mode {mode}")
    if mode == "TRIANGLES":
        if count % 3:
            raise ValueError(f"count is {count}, expected a multiple of 3 in mode TRIANGLES")
        return _decode_indices(lib.meshopt_decodeIndexBuffer, encoded, count=count, stride=stride)
    if mode == "INDICES":
        return _decode_indices(lib.meshopt_decodeIndexSequence, encoded, count=count, stride=stride)
    raise ValueError(f"mode is {mode}, expected ATTRIBUTES, TRIANGLES or INDICES")


def _decode_attributes(encoded: bytes, *, count: int, stride: int, kind: str) -> bytes:
    if stride % 4 or not 0 < stride <= MAX_MESHOPT_STRIDE:
        raise ValueError(f"byteStride is {stride}, expected a multiple of 4 up to {MAX_MESHOPT_STRIDE}")
    try:
        decoded = meshoptimizer.decode_vertex_buffer(count, stride, encoded)
    except RuntimeError as broken:
        raise ValueError(str(broken)) from broken
    filters = {
        "OCTAHEDRAL": meshoptimizer.decode_filter_oct,
        "QUATERNION": meshoptimizer.decode_filter_quat,
        "EXPONENTIAL": meshoptimizer.decode_filter_exp,
    }
    if kind in filters:
        decoded = filters[kind](decoded, count, stride)
    elif kind != "NONE":
        raise ValueError(f"filter is {kind}, expected NONE or one of {', '.join(filters)}")
    return decoded.tobytes()


def _decode_indices(decoder: Any, encoded: bytes, *, count: int, stride: int) -> bytes:
    """Called below the package's wrapper, which holds no 16-bit indices and no index sequences."""
    decoded = np.zeros(count * stride, np.uint8)
    source = np.frombuffer(encoded, np.uint8)
    status = decoder(
        decoded.ctypes.data_as(ctypes.c_void_p),
        ctypes.c_size_t(count),
        ctypes.c_size_t(stride),
        source.ctypes.data_as(ctypes.POINTER(ctypes.c_ubyte)),
        ctypes.c_size_t(len(source)),
    )
    if status:
        raise ValueError(f"the index decoder returns {status}")
    return decoded.tobytes()


def decode_draco(encoded: bytes, attributes: dict[str, int]) -> tuple[Array, dict[str, Array]]:
    """Decode a primitive compressed by KHR_draco_mesh_compression.

    `attributes` maps glTF attribute names to Draco's unique ids. Returns triangles [F, 3] and each attribute [V, n]
    as stored. Raises ValueError where the bytes are no Draco mesh or an id is missing.
    """
    try:
        mesh = DracoPy.decode(encoded)
    except Exception as broken:  # DracoPy's exceptions derive from Exception itself
        raise ValueError(str(broken)) from broken
    faces = getattr(mesh, "faces", None)
    if faces is None:
        raise ValueError("it holds a point cloud, expected triangles")
    stored = {attribute["unique_id"]: attribute["data"] for attribute in mesh.attributes}
    missing = sorted(set(attributes.values()) - set(stored))
    if missing:
        raise ValueError(f"attribute ids {missing} are not in the compressed mesh")
    return np.asarray(faces), {name: np.asarray(stored[unique]) for name, unique in attributes.items()}
