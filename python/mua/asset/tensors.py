"""The Tensor of the file: shape, element type, bytes, and one scale for each row where the type is i8."""

import math
from typing import Any, Literal

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.asset.flatbuffer import MAX_BYTES, FormatError, Tree, refuse
from mua.limits import LARGEST, MAX_RANK, UNIT_BOUND

Element = Literal["f32", "f16", "i8"]
Storage = Literal["f32", "f16", "i8", "packed"]  # of a whole file

DTYPES: dict[str, np.dtype[Any]] = {
    "F32": np.dtype("<f4"),
    "F16": np.dtype("<f2"),
    "I8": np.dtype("i1"),
    "I32": np.dtype("<i4"),
}


def pack(values: Array, element: Element = "f32", *, rows: int = 0) -> Tree:
    """Store `values`, finite and at most LARGEST, as f32, f16 or i8.

    i8 scales each of `rows` equal parts to its largest magnitude.
    """
    if element == "i8":
        return _pack_i8(np.asarray(values, dtype=np.float32), rows)
    return _tensor(element.upper(), np.asarray(values).astype(DTYPES[element.upper()]))


def pack_indices(values: Array) -> Tree:
    """Store integers as i32."""
    return _tensor("I32", np.asarray(values).astype("<i4"))


def _pack_i8(values: Array, rows: int) -> Tree:
    parts = values.reshape(rows, -1)
    scale = np.abs(parts).max(axis=1, initial=0).astype(np.float32) / np.float32(127)
    stored = np.rint(parts / np.where(scale == 0, 1, scale)[:, None]).astype(np.int8)
    return {**_tensor("I8", stored.reshape(values.shape)), "scale": scale}


def _tensor(kind: str, stored: Array) -> Tree:
    data = np.ascontiguousarray(stored).reshape(-1).view(np.uint8)
    return {"shape": np.array(stored.shape, "<u4"), "type": kind, "data": data}


def sides(tensor: Tree, path: str) -> list[int]:
    """The shape of a tensor that a file could hold.

    Errors: FormatError with code `shape`.
    """
    shape = [int(n) for n in tensor["shape"]]
    if not 1 <= len(shape) <= MAX_RANK:
        raise FormatError("shape", f"{path}.shape", f"{len(shape)} dimensions, expected 1 to {MAX_RANK}")
    if math.prod(max(n, 1) for n in shape) > MAX_BYTES:  # an empty tensor's other sides, too
        raise FormatError("shape", f"{path}.shape", f"the sides {shape} multiply to more than a file can hold")
    return shape


def stored(tensor: Tree, path: str) -> Array:
    """The elements of a tensor in their stored type, a view of the file.

    Errors: FormatError with code `shape` where shape, bytes and scales do not agree.
    """
    shape = sides(tensor, path)
    dtype = DTYPES[tensor["type"]]
    if math.prod(shape) * dtype.itemsize != tensor["data"].size:
        raise FormatError("shape", f"{path}.data", f"{tensor['data'].size} bytes do not fill {tensor['type']} {shape}")
    rows = tensor["scale"].size if "scale" in tensor else 0
    if (tensor["type"] == "I8") != (rows > 0) or (rows and math.prod(shape) % rows):
        raise FormatError("shape", f"{path}.scale", f"{rows} scales do not fit {tensor['type']} {shape}")
    return np.asarray(tensor["data"].view(dtype).reshape(shape))


def indices(tensor: Tree, path: str, shape: tuple[int | None, ...], low: int, high: int) -> Array:
    """Integers of `shape` (None: any length) within low <= i < high.

    Errors: FormatError with code `shape`, `type` or `range`.
    """
    values = stored(tensor, path)
    _check_shape(values, path, shape)
    if tensor["type"] != "I32":
        raise FormatError("type", path, f"element type {tensor['type']}, expected I32")
    if values.size and (values.min() < low or values.max() >= high):
        wrong = values[(values < low) | (values >= high)].ravel()[0]
        raise FormatError("range", path, f"index {wrong} lies outside {low} to {high - 1}")
    return values


def reals(tensor: Tree, path: str, shape: tuple[int | None, ...]) -> Array:
    """Finite float32 values of `shape` (None: any length), at most LARGEST in magnitude; f16 and i8 are expanded.

    Errors: FormatError with code `shape`, `type`, `finite` or `value`.
    """
    values = stored(tensor, path)
    _check_shape(values, path, shape)
    if tensor["type"] == "I32":
        raise FormatError("type", path, "element type I32, expected F32, F16 or I8")
    if tensor["type"] == "I8":
        scale = tensor["scale"]
        with np.errstate(invalid="ignore", over="ignore"):  # what is not finite then is reported below
            values = (values.reshape(scale.size, -1).astype(np.float32) * scale[:, None]).reshape(values.shape)
    values = values.astype(np.float32, copy=False)
    if not np.isfinite(values).all() or not np.isfinite(tensor.get("scale", np.zeros(1))).all():
        raise FormatError("finite", path, "a value is not finite")
    if max(values.max(initial=0), -values.min(initial=0)) > LARGEST:
        worst = values.ravel()[np.abs(values).argmax()]
        raise FormatError("value", path, f"{worst:.6g}, expected {-LARGEST:.6g} to {LARGEST:.6g}")
    return values


def _check_shape(values: Array, path: str, shape: tuple[int | None, ...]) -> None:
    if len(values.shape) != len(shape) or any(e not in (None, n) for e, n in zip(shape, values.shape, strict=True)):
        expected = ", ".join("any" if n is None else str(n) for n in shape)
        raise FormatError("shape", f"{path}.shape", f"{list(values.shape)}, expected [{expected}]")


def some_reals(tensor: Tree, path: str, shape: tuple[int | None, ...], *, axis: int) -> Array:
    """Reals of which there is at least one along the axis: components, or a rank."""
    values = reals(tensor, path, shape)
    if not values.shape[axis]:
        raise FormatError("shape", f"{path}.shape", f"side {axis} is 0, expected 1 or more")
    return values


def unit_quaternions(tensor: Tree, path: str, shape: tuple[int | None, ...]) -> Array:
    """Unit quaternions [..., 4], renormalised after storage."""
    q = reals(tensor, path, shape).astype(np.float64)
    lengths = np.linalg.norm(q, axis=-1)
    if np.abs(lengths - 1).max(initial=0) > UNIT_BOUND:
        worst = lengths.ravel()[np.abs(lengths - 1).argmax()]
        refuse(path, f"a quaternion of length {worst:.4g}, expected 1")
    return rotation.normalize(q)
