"""A `.muaavatar` file as nested records: the FlatBuffer by the text of its schema, its tensors as arrays.

What stands in tests/oracle is written from schemas/README.md and muaavatar.fbs alone; it is plain rather than fast.
"""

import re
import zlib
from pathlib import Path
from types import SimpleNamespace as Record
from typing import Any

import numpy as np
from flatbuffers.table import Table

Array = np.ndarray[Any, np.dtype[Any]]
SCHEMA = Path(__file__).resolve().parents[2] / "schemas" / "muaavatar.fbs"
TEXT = re.sub(r"//.*|\(.*?\)", "", SCHEMA.read_text())
ENUMS = dict(re.findall(r"enum (\w+) : (\w+)", TEXT))  # stored as numbers
TABLES = {
    table: re.findall(r"(\w+): (\[?\w+\]?)", body) for table, body in re.findall(r"table (\w+) \{(.*?)\}", TEXT, re.S)
}
NUMBERS = {"bool": "?", "ubyte": "u1", "ushort": "<u2", "uint": "<u4", "float": "<f4", "double": "<f8"}
STEPS = 2  # of Packing
ELEMENTS = ["<f4", "<f2", "i1", "<i4"]  # in the order of ElementType


def load(path: Path) -> Any:
    """The table Avatar of a file."""
    return read_value(path.read_bytes(), 0, "Avatar")


def read_table(data: bytes, at: int, name: str) -> Any:
    """A table; absent numbers are 0, other absent fields None."""
    record = Record()
    for slot, (field, kind) in enumerate(TABLES[name]):
        kind, offset = ENUMS.get(kind, kind), Table(data, at).Offset(4 + 2 * slot)
        absent = 0 if kind in NUMBERS else None
        setattr(record, field, read_value(data, at + offset, kind) if offset else absent)
    return expand(record) if name == "Tensor" else record


def read_value(data: bytes, at: int, kind: str) -> Any:
    """A value of a type of the schema."""
    if kind in NUMBERS:
        return np.frombuffer(data, NUMBERS[kind], 1, at)[0].item()
    start = Table(data, at).Indirect(at)
    if kind in TABLES:
        return read_table(data, start, kind)
    count, start, item = int(np.frombuffer(data, "<u4", 1, start)[0]), start + 4, kind.strip("[]")
    if kind == "string":
        return data[start : start + count].decode()
    if item in NUMBERS:
        return np.frombuffer(data, NUMBERS[item], count, start)
    return [read_value(data, start + 4 * index, item) for index in range(count)]


def expand(tensor: Record) -> Array:
    """1.1, and 1.5 where it is packed: the values, as f64 or 64-bit integers."""
    kind, count, data = np.dtype(ELEMENTS[tensor.type]), int(np.prod(tensor.shape, dtype=np.int64)), tensor.data
    if tensor.packing:
        planes = zlib.decompress(data.tobytes(), wbits=-15) if count else b""
        data = np.frombuffer(planes, np.uint8).reshape(kind.itemsize, count).T.ravel()
    if tensor.packing == STEPS:  # their data are numbers, not yet the halves
        numbers = data.view("<u2").astype(np.int64)
        multiples = np.where(numbers % 2, -(numbers + 1) // 2, numbers // 2).astype(np.float64)
        scales = np.repeat(tensor.scale.astype(np.float64), count // len(tensor.scale))
        data = (multiples * scales).astype("<f2").view(np.uint8)
    values = data.view(kind).astype(np.int64 if kind == "<i4" else np.float64)
    if kind == "i1":
        values = values * np.repeat(tensor.scale.astype(np.float64), count // max(len(tensor.scale), 1))
    return values.reshape(tensor.shape)
