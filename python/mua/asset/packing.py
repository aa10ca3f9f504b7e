"""Tensors packed for the network, their bytes in planes and deflated; and unpacked, never beyond what a file may claim.

In planes, the bytes of equal weight stand together: all first bytes of the elements, then all second ones. Halves whose
rows are multiples of a power of two, as `mua.asset.rounding` makes them, are stored as those multiples: as i8 where
they are small, else as steps, integers of 16 bits whose second bytes are mostly 0.
"""

import math
import zlib
from collections.abc import Iterator

import deflate
import numpy as np

from mua.arrays import Array
from mua.asset.flatbuffer import FormatError, Tree, refuse
from mua.asset.layout import ROOT, TABLES
from mua.asset.tensors import DTYPES, sides
from mua.limits import LARGEST_STEP, LEAST_STEP, UNPACKED_ROOM, UNPACKED_TIMES

RAW = -15  # zlib's word for a deflate stream of the largest window without a header
GAIN = 0.95  # of its bytes, above which a tensor is not worth unpacking
HALF_BITS = 11  # of a half's fraction, with the one that is not stored
MOST_OF_BYTE, MOST_OF_STEPS = 127, 32767
BEST, QUICK = 12, 4  # levels of libdeflate: of what is written, and of what is compared


def packed(tensor: Tree) -> Tree:
    """The tensor as a file for the network holds it, the same numbers; unchanged where that saves nothing."""
    form = min(_forms(tensor), key=lambda form: len(_deflated(form, QUICK)) + form.get("scale", np.zeros(0)).nbytes)
    stream = _deflated(form, BEST)
    if len(stream) > GAIN * tensor["data"].nbytes:
        return tensor
    return {**form, "data": np.frombuffer(stream, np.uint8)}


def _deflated(tensor: Tree, level: int) -> bytes:
    planes = tensor["data"].reshape(-1, DTYPES[tensor["type"]].itemsize).T
    return bytes(deflate.deflate_compress(planes.tobytes(), level))


def _forms(tensor: Tree) -> Iterator[Tree]:
    """The same numbers as elements of each kind that a reader unpacks, before they are deflated."""
    yield {**tensor, "packing": "Deflate"}
    if tensor["type"] != "F16" or not tensor["data"].size:
        return
    values = tensor["data"].view(DTYPES["F16"]).astype(np.float32)
    if not np.isfinite(values).all():
        return
    units = _lowest_bits(values)
    for rows in sorted({math.prod(tensor["shape"][:axis].tolist()) for axis in range(len(tensor["shape"]))}):
        scale = units.reshape(rows, -1).min(axis=1, initial=LARGEST_STEP)
        steps = (values.reshape(rows, -1) / scale[:, None]).reshape(-1)
        most = np.abs(steps).max()
        if most <= MOST_OF_BYTE:
            data = steps.astype(np.int8).view(np.uint8)
            yield {**tensor, "type": "I8", "data": data, "scale": scale, "packing": "Deflate"}
        elif most <= MOST_OF_STEPS:
            yield {**tensor, "data": _folded(steps.astype(np.int32)), "scale": scale, "packing": "Steps"}


def _folded(steps: Array) -> Array:
    """Bytes of 0, -1, 1, -2, 2 and so on as 0, 1, 2, 3, 4."""
    return np.where(steps < 0, -2 * steps - 1, 2 * steps).astype("<u2").view(np.uint8)


def _lowest_bits(values: Array) -> Array:
    """The largest power of two of which each half is a multiple; 1 for 0."""
    fraction, exponent = np.frexp(values)
    whole = (fraction * 2.0**HALF_BITS).astype(np.int32)
    return np.where(values == 0, np.float32(1), np.ldexp((whole & -whole).astype(np.float32), exponent - HALF_BITS))


def unpack(tree: Tree, size: int) -> None:
    """Unpack the packed tensors of a file of `size` bytes in place; each then holds its bytes in the file as `_stored`,
    with those of the scales that it loses.

    What a tensor gives is known from its shape, and what all of them give is refused before any is unpacked. Errors:
    FormatError with code `shape`, `value` or `packed`.
    """
    held = [(path, tensor) for path, tensor in tensors(tree) if tensor["packing"] != "Plain"]
    claimed, most = 0, UNPACKED_TIMES * size + UNPACKED_ROOM
    for path, tensor in held:
        claimed += _claimed(tensor, path)
        if claimed > most:
            sentence = f"the file's packed tensors claim more than {most} bytes, too many for {size} bytes"
            raise FormatError("value", f"{path}.data", sentence)
    for path, tensor in held:
        scale = _steps(tensor, path) if tensor["packing"] == "Steps" else None
        planes = _inflate(tensor["data"].tobytes(), _claimed(tensor, path), path)
        tensor["_stored"] = tensor["data"].nbytes + (0 if scale is None else scale.nbytes)
        tensor["data"] = np.ascontiguousarray(planes.reshape(DTYPES[tensor["type"]].itemsize, -1).T).reshape(-1)
        if scale is not None:
            tensor["data"] = _halves(tensor["data"].view("<u2"), scale)
        tensor["packing"] = "Plain"


def _claimed(tensor: Tree, path: str) -> int:
    """Bytes of the elements, by the shape."""
    return math.prod(sides(tensor, path)) * DTYPES[tensor["type"]].itemsize


def _steps(tensor: Tree, path: str) -> Array:
    """The scales of a tensor in steps, which it loses: the halves that come of it have none."""
    if tensor["type"] != "F16":
        raise FormatError("type", path, f"element type {tensor['type']}, expected F16 of what is packed as steps")
    shape, scale = sides(tensor, path), tensor.pop("scale", np.zeros(0, "<f4"))
    if not scale.size or math.prod(shape) % scale.size:
        raise FormatError("shape", f"{path}.scale", f"{scale.size} scales do not fit F16 {shape}")
    within = (scale >= LEAST_STEP) & (scale <= LARGEST_STEP) & (np.frexp(scale)[0] == 0.5)
    if not within.all():
        refuse(f"{path}.scale", f"{scale[~within][0]:.6g}, expected a power of two from 2^-24 to 1")
    return np.asarray(scale)


def _halves(numbers: Array, scale: Array) -> Array:
    """Bytes of the multiples of their rows' scales; many numbers are looked up, which is faster."""
    rows, count = numbers.reshape(len(scale), -1), int(numbers.max(initial=0)) + 1
    scales, which = np.unique(scale, return_inverse=True)
    if count * len(scales) > numbers.size:
        return (_unfolded(rows) * scale[:, None]).astype(DTYPES["F16"]).reshape(-1).view(np.uint8)
    every = (_unfolded(np.arange(count)) * scales[:, None]).astype(DTYPES["F16"]).reshape(-1)
    return every[rows + np.uint32(count) * which[:, None].astype(np.uint32)].reshape(-1).view(np.uint8)


def _unfolded(numbers: Array) -> Array:
    return np.where(numbers & 1, -(numbers.astype(np.int32) >> 1) - 1, numbers >> 1).astype(np.float32)


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
