"""Files that nobody wrote: sound ones with bytes, numbers or whole tensors changed, and sealed again."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from malformed import malformed, seal_unread

from mua.asset.flatbuffer import Tree
from mua.asset.tensors import DTYPES

TABLES = 4000  # of the first bytes of a file are mostly tables
BYTES = (0, 1, 4, 0x7F, 0x80, 0xFF)
NUMBERS = (0.0, -0.0, 1e-38, -1e-7, 0.5, 1.0, -1.0, 88.0, 1e4, 65504.0, -65504.0, 65536.0, 1e30, np.inf, np.nan)
INTEGERS = (0, 1, 2, 3, -1, 7, 255, 4096, 2**31 - 1)


def mutants(contents: list[bytes], rng: np.random.Generator, count: int) -> Iterator[bytes]:
    """Mutants of sound files, by turns of their bytes and of what stands in them."""
    for k in range(count):
        content = contents[k % len(contents)]
        yield _bytes(content, rng) if rng.random() < 0.5 else malformed(content, lambda tree: _numbers(tree, rng))


def _bytes(content: bytes, rng: np.random.Generator) -> bytes:
    mutated = bytearray(content)
    end = TABLES if rng.random() < 0.8 else len(content)
    for at in rng.integers(0, end, rng.integers(1, 4)):
        mutated[at] = rng.choice([*BYTES, rng.integers(256)])
    return seal_unread(bytes(mutated))


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


def _places(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Everything of a file that is a number or holds them."""
    for name, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        if name in ("_at", "crc32", "version_major", "version_minor"):
            continue
        if isinstance(value, dict) and "data" in value:
            yield tree, name
        elif isinstance(value, dict | list):
            yield from _places(value)
        elif isinstance(value, int | float | np.ndarray):
            yield tree, name


def _tensor(tensor: Tree, rng: np.random.Generator) -> Tree:
    if "scale" in tensor and rng.random() < 0.5:
        return {**tensor, "scale": _some(tensor["scale"], rng)}
    values = tensor["data"].view(DTYPES[tensor["type"]])
    return {**tensor, "data": _some(values, rng).view(np.uint8)}


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
