"""Tensors packed for the network, their bytes in planes and deflated; and unpacked, never beyond what a file may claim.

In planes, the bytes of equal weight stand together: all first bytes of the elements, then all second ones. Halves whose
rows are small multiples of a power of two, as `mua.asset.rounding` makes them, are the same numbers as i8.
"""

import math
import zlib
from collections.abc import Iterator

import numpy as np

from mua.arrays import Array
from mua.asset.flatbuffer import FormatError, Tree
from mua.asset.layout import ROOT, TABLES
from mua.asset.tensors import DTYPES, sides
from mua.limits import UNPACKED_ROOM, UNPACKED_TIMES

RAW = -15  # zlib's word for a deflate stream of the largest window without a header
GAIN = 0.95  # of its bytes, above which a tensor is not worth unpacking
STRATEGIES = (zlib.Z_DEFAULT_STRATEGY, zlib.Z_FILTERED, zlib.Z_HUFFMAN_ONLY)  # none is the best of all
HALF_BITS = 11  # of a half's fraction, with the one that is not stored
MOST_STEPS = 127
LEAST_ROW = 64  # bytes of a row, beside which the four of its scale count little
MEMORY = 9  # the most that zlib may take, for the longest blocks


def packed(tensor: Tree) -> Tree:
    """The tensor as a file for the network holds it, the same numbers; unchanged where that saves nothing."""
    tensor = _in_bytes(tensor)
    planes = tensor["data"].reshape(-1, DTYPES[tensor["type"]].itemsize).T
    last = len(planes) - 1
    stream = b"".join(_smallest(plane.tobytes(), ends=number == last) for number, plane in enumerate(planes))
    if len(stream) > GAIN * planes.size:
        return tensor
    return {**tensor, "data": np.frombuffer(stream, np.uint8), "packing": "Deflate"}


def _smallest(plane: bytes, *, ends: bool) -> bytes:
    """A part of a stream, the last one or not, by the strategy that makes it smallest."""
    parts = []
    for strategy in STRATEGIES:
        deflate = zlib.compressobj(9, zlib.DEFLATED, RAW, MEMORY, strategy)
        parts.append(deflate.compress(plane) + deflate.flush(zlib.Z_FINISH if ends else zlib.Z_SYNC_FLUSH))
    return min(parts, key=len)


def _in_bytes(tensor: Tree) -> Tree:
    """The same numbers as i8, by the fewest rows, where halves are small multiples of a row's power of two."""
    if tensor["type"] != "F16" or not tensor["data"].size:
        return tensor
    values = tensor["data"].view(DTYPES["F16"]).astype(np.float32)
    if not np.isfinite(values).all():
        return tensor
    units = _lowest_bits(values)
    for rows in sorted({math.prod(tensor["shape"][:axis].tolist()) for axis in range(len(tensor["shape"]))}):
        scale = units.reshape(rows, -1).min(axis=1)
        whole = values.reshape(rows, -1) / scale[:, None]
        if rows * LEAST_ROW <= values.size and np.abs(whole).max() <= MOST_STEPS:
            data = whole.astype(np.int8).reshape(-1).view(np.uint8)
            return {**tensor, "type": "I8", "data": data, "scale": scale}
    return tensor


def _lowest_bits(values: Array) -> Array:
    """The largest power of two of which each half is a multiple; 1 for 0."""
    fraction, exponent = np.frexp(values)
    whole = (fraction * 2.0**HALF_BITS).astype(np.int32)
    return np.where(values == 0, np.float32(1), np.ldexp((whole & -whole).astype(np.float32), exponent - HALF_BITS))


def unpack(tree: Tree, size: int) -> None:
    """Unpack the packed tensors of a file of `size` bytes in place; each then holds its bytes in the file as `_stored`.

    What a tensor gives is known from its shape, and what all of them give is refused before any is unpacked. Errors:
    FormatError with code `shape`, `value` or `packed`.
    """
    held = [(path, tensor) for path, tensor in tensors(tree) if tensor["packing"] == "Deflate"]
    claimed, most = 0, UNPACKED_TIMES * size + UNPACKED_ROOM
    for path, tensor in held:
        claimed += _claimed(tensor, path)
        if claimed > most:
            sentence = f"the file's packed tensors claim more than {most} bytes, too many for {size} bytes"
            raise FormatError("value", f"{path}.data", sentence)
    for path, tensor in held:
        planes = _inflate(tensor["data"].tobytes(), _claimed(tensor, path), path)
        tensor["_stored"] = tensor["data"].nbytes
        tensor["data"] = np.ascontiguousarray(planes.reshape(DTYPES[tensor["type"]].itemsize, -1).T).reshape(-1)
        tensor["packing"] = "Plain"


def _claimed(tensor: Tree, path: str) -> int:
    """Bytes of the elements, by the shape."""
    return math.prod(sides(tensor, path)) * DTYPES[tensor["type"]].itemsize


def tensors(tree: Tree, table: str = ROOT, path: str = "") -> Iterator[tuple[str, Tree]]:
    """The paths and tensors of a tree, in the schema's order."""
    for field in TABLES[table]:
        if field.kind not in TABLES or field.name not in tree:
            continue
        name, value = f"{path}.{field.name}".lstrip("."), tree[field.name]
        places = [(f"{name}[{i}]", part) for i, part in enumerate(value)] if field.vector else [(name, value)]
        for place, part in places:
            if field.kind == "Tensor":
                yield place, part
            else:
                yield from tensors(part, field.kind, place)


def _inflate(stream: bytes, count: int, path: str) -> np.ndarray[tuple[int], np.dtype[np.uint8]]:
    """The `count` bytes of a stream; not a byte more is made of it."""
    if not count:  # not every language notices that an empty stream is damaged
        return np.zeros(0, np.uint8)
    inflate = zlib.decompressobj(RAW)
    try:
        found = inflate.decompress(stream, count + 1)
    except zlib.error as error:
        raise FormatError("packed", f"{path}.data", "the bytes are no deflate stream: the file is damaged") from error
    if len(found) != count:
        given = f"more than {count}" if len(found) > count else str(len(found))
        raise FormatError("packed", f"{path}.data", f"the stream gives {given} bytes, expected {count}")
    if not inflate.eof or inflate.unused_data:
        raise FormatError("packed", f"{path}.data", "the stream does not end with its bytes: the file is damaged")
    return np.frombuffer(found, np.uint8)
