"""Files that nobody wrote: sound ones with bytes, numbers, tensors or whole tables changed, and sealed again."""

import struct
import zlib
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from mua.asset import layout
from mua.asset.flatbuffer import Tree, build, parse
from mua.asset.packing import packed
from mua.asset.tensors import DTYPES

TABLES = 4000  # of the first bytes of a file are mostly tables
BYTES = (0, 1, 4, 0x7F, 0x80, 0xFF)
NUMBERS = (0.0, -0.0, 1e-38, -1e-7, 0.5, 1.0, -1.0, 88.0, 1e4, 65504.0, -65504.0, 65536.0, 1e30, np.inf, np.nan)
INTEGERS = (0, 1, 2, 3, -1, 7, 255, 4096, 2**31 - 1)
ZEROS = zlib.compress(bytes(1 << 24), 9, -15)  # a stream of 16 kB that gives 1,000 times as much
CLAIMS = (0, 1, 2**10, 2**20, 2**24, 2**32 - 1)  # of one side of a packed tensor
SIDES = (0, 1, 2, 3, 4, 7, 2**16, 2**32 - 1)
SLOT = 4 + 2 * [field.name for field in layout.TABLES[layout.ROOT]].index("crc32")  # bytes into what describes the root
UNCHANGED = ("_at", "crc32", "version_major", "version_minor")


def mutant(contents: list[bytes], seed: int) -> bytes:
    """A mutant of one of these sound files: of its bytes, of what stands in it or of how it is arranged."""
    rng, content = np.random.default_rng(seed), contents[seed % len(contents)]
    kind = rng.random()
    if kind < 0.4:
        return _bytes(content, rng)
    return _edited(content, _numbers if kind < 0.8 else _arrangement, rng)


def packed_mutant(contents: list[bytes], seed: int) -> bytes:
    """A mutant of a file for the network, two of three in its streams or in what these claim to give."""
    if seed % 3 == 0:
        return mutant(contents, seed)
    return _edited(contents[seed % len(contents)], _stream, np.random.default_rng(seed))


def _edited(content: bytes, edit: Callable[[Tree, np.random.Generator], None], rng: np.random.Generator) -> bytes:
    tree = _copied(_parsed(content))
    edit(tree, rng)
    return _sealed(build(tree))


@lru_cache
def _parsed(content: bytes) -> Tree:
    tree = parse(content)
    tree.pop("stages", None)  # of a file that ends elsewhere
    return tree


def _copied(tree: Any) -> Any:
    """The same tables and lists, of which one may change without the other; arrays are never changed."""
    if isinstance(tree, dict):
        return {name: _copied(value) for name, value in tree.items()}
    return [_copied(value) for value in tree] if isinstance(tree, list) else tree


def _sealed(content: bytes) -> bytes:
    """With its checksum, where the root's description still says where that stands: parsing all of it takes longer."""
    try:
        [root] = struct.unpack_from("<I", content)
        [back] = struct.unpack_from("<i", content, root)
        [offset] = struct.unpack_from("<H", content, root - back + SLOT)
    except struct.error:
        return content
    at = root + offset
    if not offset or at + 4 > len(content):
        return content
    checksum = zlib.crc32(content[at + 4 :], zlib.crc32(bytes(4), zlib.crc32(content[:at])))
    return content[:at] + struct.pack("<I", checksum) + content[at + 4 :]


def _stream(tree: Tree, rng: np.random.Generator) -> None:
    """One or two streams are changed, cut off, longer, exchanged or others, or claim to give otherwise."""
    tensors = [(part[0][part[1]], part) for part in _parts(tree)]
    streams = [part for tensor, part in tensors if _is_tensor(tensor) and tensor.get("packing") == "Deflate"]
    for table, name in (_one(streams, rng) for _ in range(rng.integers(1, 3))):
        other, its = _one(streams, rng)
        data, shape = table[name]["data"], np.array(table[name]["shape"], "<u4")
        at = int(rng.integers(data.size + 1))
        match rng.integers(7):
            case 0:
                data = _some(data, rng)
            case 1:
                data = data[:at]
            case 2:
                data = np.append(data, rng.integers(0, 256, 9).astype(np.uint8))
            case 3:
                data = np.append(data[:at], other[its]["data"][at:])
            case 4:
                data, other[its] = other[its]["data"], {**other[its], "data": data}
            case 5:
                data = np.frombuffer(ZEROS, np.uint8)
            case 6:
                shape[rng.integers(len(shape))] = rng.choice(CLAIMS)
                data = np.frombuffer(ZEROS, np.uint8) if rng.random() < 0.5 else data
        table[name] = {**table[name], "shape": shape, "data": data}


def _bytes(content: bytes, rng: np.random.Generator) -> bytes:
    mutated = bytearray(content)
    end = TABLES if rng.random() < 0.8 else len(content)
    for at in rng.integers(0, end, rng.integers(1, 4)):
        mutated[at] = rng.choice([*BYTES, rng.integers(256)])
    return _sealed(bytes(mutated))


def _numbers(tree: Tree, rng: np.random.Generator) -> None:
    """Change one to three places: an element, a tensor, its scales or a number of a table."""
    places = list(_places(tree))
    for at in rng.integers(0, len(places), rng.integers(1, 4)):
        table, name = places[at]
        value = table[name]
        if isinstance(value, dict):
            table[name] = _tensor(value, rng)
        elif isinstance(value, np.ndarray):
            table[name] = _some(value, rng)
        elif isinstance(value, bool):
            table[name] = not value
        else:
            table[name] = int(rng.choice(INTEGERS)) % 2**32 if isinstance(value, int) else float(rng.choice(NUMBERS))


def _arrangement(tree: Tree, rng: np.random.Generator) -> None:
    """Leave out or repeat a part, exchange two of a kind, or give a tensor other sides or another type."""
    parts = list(_parts(tree))
    tensors = [part for part in parts if _is_tensor(part[0][part[1]])]
    lists = [part for part in parts if isinstance(part[0][part[1]], list) and part[0][part[1]]]
    table, name = _one(tensors, rng)
    match rng.integers(7):
        case 0:
            table, name = _one(parts, rng)
            del table[name]
        case 1:
            table, name = _one(lists, rng)
            table[name] = table[name] * int(rng.choice([2, 3, 40]))
        case 2:
            other, its = _one(tensors, rng)
            table[name], other[its] = other[its], table[name]
        case 3:
            table[name] = _resized(table[name], rng)
        case 4:
            shape = table[name]["shape"].copy()
            shape[rng.integers(len(shape))] = rng.choice(SIDES)
            table[name] = {**table[name], "shape": shape if rng.random() < 0.7 else shape[::-1].copy()}
        case 5:
            table[name] = {**table[name], "type": str(rng.choice([*DTYPES]))}
        case 6:
            table[name] = {**table[name], "packing": str(rng.choice(layout.ENUMS["Packing"]))}


def _places(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Everything of a file that is a number or holds them."""
    for name, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        if name in UNCHANGED:
            continue
        if _is_tensor(value):
            yield tree, name
        elif isinstance(value, dict | list):
            yield from _places(value)
        elif isinstance(value, int | float | np.ndarray):
            yield tree, name


def _parts(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Every table, list and tensor of a file."""
    for name, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        if name not in UNCHANGED and isinstance(value, dict | list):
            yield tree, name
            if not _is_tensor(value):
                yield from _parts(value)


def _is_tensor(value: Any) -> bool:
    return isinstance(value, dict) and "data" in value


def _one(parts: list[tuple[Any, Any]], rng: np.random.Generator) -> tuple[Any, Any]:
    return parts[rng.integers(len(parts))]


def _resized(tensor: Tree, rng: np.random.Generator) -> Tree:
    """Some rows along one side are left out or repeated; the bytes fill the new shape."""
    tensor = _opened(tensor)
    if tensor.get("packing") == "Deflate":
        return tensor
    values = tensor["data"].view(DTYPES[tensor["type"]]).reshape(tensor["shape"])
    axis = int(rng.integers(values.ndim))
    rows = np.sort(rng.integers(0, max(values.shape[axis], 1), rng.choice([0, 1, values.shape[axis] + 1])))
    if not values.shape[axis]:
        return tensor
    taken = np.ascontiguousarray(np.take(values, rows, axis=axis))
    return {**tensor, "shape": np.array(taken.shape, "<u4"), "data": taken.reshape(-1).view(np.uint8)}


def _tensor(tensor: Tree, rng: np.random.Generator) -> Tree:
    if "scale" in tensor and rng.random() < 0.5:
        return {**tensor, "scale": _some(tensor["scale"], rng)}
    is_packed = tensor.get("packing") == "Deflate"
    tensor = _opened(tensor) if rng.random() < 0.7 else tensor
    kind = np.dtype(np.uint8) if tensor.get("packing") == "Deflate" else DTYPES[tensor["type"]]
    if tensor["data"].size % kind.itemsize:
        return tensor
    changed = {**tensor, "data": _some(tensor["data"].view(kind), rng).view(np.uint8)}
    return packed(changed) if is_packed and tensor.get("packing") != "Deflate" else changed


def _opened(tensor: Tree) -> Tree:
    """A packed tensor as a plain one, where its stream is still sound."""
    if tensor.get("packing") != "Deflate":
        return tensor
    try:
        planes = np.frombuffer(zlib.decompress(tensor["data"].tobytes(), -15), np.uint8)
        data = np.ascontiguousarray(planes.reshape(DTYPES[tensor["type"]].itemsize, -1).T).reshape(-1)
    except (zlib.error, ValueError):
        return tensor
    return {**tensor, "data": data, "packing": "Plain"}


def _some(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """One, a few or all of the numbers are others."""
    changed = values.copy()
    if not changed.size:
        return changed
    at = rng.integers(0, changed.size, rng.choice([1, 1, 3])) if rng.random() < 0.8 else slice(None)
    with np.errstate(all="ignore"):
        known = NUMBERS if changed.dtype.kind == "f" else INTEGERS
        changed[at] = np.asarray(rng.choice(known)).astype(changed.dtype)
        if rng.random() < 0.2 and changed.dtype.kind == "f":
            changed = (values * changed.dtype.type(rng.choice([-1, 1e-4, 30, 1000]))).astype(changed.dtype)
    return changed
