"""Section 1 of schemas/README.md: a file as nested dicts, its tensors as arrays; the tables are those of the schema.

What stands in tests/oracle is written from that page and muaavatar.fbs alone, in float64 and plain rather than fast.
"""

import re
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np

SCHEMA = Path(__file__).resolve().parents[2] / "schemas" / "muaavatar.fbs"
WIDTHS = {"bool": "?", "ubyte": "u1", "ushort": "<u2", "uint": "<u4", "float": "<f4", "double": "<f8"}
F32, F16, I8, I32 = range(4)  # enum ElementType
Array = np.ndarray[Any, np.dtype[Any]]
Tree = dict[str, Any]


def _schema() -> dict[str, list[tuple[str, str]]]:
    """Names and kinds of the fields of each table, in the order of their slots."""
    text = re.sub(r"//.*", "", SCHEMA.read_text())
    bodies = re.findall(r"table\s+(\w+)\s*\{([^}]*)\}", text)
    return {table: re.findall(r"(\w+)\s*:\s*(\[?\w+\]?)", re.sub(r"\([^)]*\)", "", body)) for table, body in bodies}


FIELDS = _schema()


def load(path: Path) -> Tree:
    """The root table; absent fields are absent."""
    content = path.read_bytes()
    return _table(content, _word(content, 0), "Avatar")


def _word(content: bytes, at: int) -> int:
    return int(struct.unpack_from("<I", content, at)[0])


def _table(content: bytes, start: int, name: str) -> Any:
    vtable = start - struct.unpack_from("<i", content, start)[0]
    slots = (struct.unpack_from("<H", content, vtable)[0] - 4) // 2
    found: Tree = {}
    for slot, (field, kind) in enumerate(FIELDS[name]):
        [offset] = struct.unpack_from("<H", content, vtable + 4 + 2 * slot) if slot < slots else [0]
        if offset:
            found[field] = _value(content, start + offset, kind)
        elif kind in WIDTHS or not (kind.startswith("[") or kind in FIELDS or kind == "string"):
            found[field] = 0
    return _tensor(found) if name == "Tensor" else found


def _value(content: bytes, at: int, kind: str) -> Any:
    inner = kind.strip("[]")
    if inner == kind and kind != "string" and kind not in FIELDS:
        return np.frombuffer(content, WIDTHS.get(kind, "u1"), 1, at)[0].item()  # an enum is a ubyte
    start = at + _word(content, at)
    if kind in FIELDS:
        return _table(content, start, kind)
    count = _word(content, start)
    if kind == "string":
        return content[start + 4 : start + 4 + count].decode()
    if inner in WIDTHS:
        return np.frombuffer(content, WIDTHS[inner], count, start + 4)
    return [_value(content, start + 4 + 4 * i, inner) for i in range(count)]


def _tensor(fields: Tree) -> Array:
    """1.1, 1.5"""
    kind = {F32: "<f4", F16: "<f2", I8: "i1", I32: "<i4"}[fields["type"]]
    count, width = int(np.prod(fields["shape"], dtype=int)), np.dtype(kind).itemsize
    data = fields["data"].tobytes()
    if fields["packing"] and count:
        planes = np.frombuffer(zlib.decompress(data, -15), np.uint8).reshape(width, count)
        data = planes.T.tobytes()
    elif fields["packing"]:
        data = b""
    values = np.frombuffer(data, kind)
    if fields["type"] == I32:
        return values.reshape(fields["shape"])
    scale = fields["scale"].astype(float) if fields["type"] == I8 else np.ones(1)
    each = np.arange(count) * len(scale) // max(count, 1)
    return np.asarray(values.astype(float) * scale[each]).reshape(fields["shape"])
