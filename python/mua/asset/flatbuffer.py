"""FlatBuffers by the generated layout: `build` writes a tree of dicts, `parse` reads one and trusts no byte.

A table is a dict, a string a str, a vector of scalars a numpy array that shares memory with the file.
https://flatbuffers.dev/internals/ describes the bytes.
"""

import re
import struct
from collections.abc import Sequence
from typing import Any, NoReturn

import flatbuffers
import numpy as np

from mua.arrays import Array
from mua.asset.layout import ENUMS, IDENTIFIER, ROOT, TABLES, Field
from mua.errors import InputError
from mua.limits import MAJOR, MINOR

Tree = dict[str, Any]

SCALARS = {
    "bool": np.dtype("?"),
    "ubyte": np.dtype("u1"),
    "ushort": np.dtype("<u2"),
    "uint": np.dtype("<u4"),
    "float": np.dtype("<f4"),
    "double": np.dtype("<f8"),
    **{name: np.dtype("u1") for name in ENUMS},
}
VERSION = (MAJOR, MINOR)
CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")  # what a terminal would obey
CONTROL_IN_NOTES = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")  # but tabs and line feeds
DATA_ALIGN = 16  # bytes, of a tensor's data
AGAIN = "download or copy it again"
MAX_BYTES = 2**31 - 1  # FlatBuffers' offsets are 32 bits, and its builders stop at half of them


class FormatError(InputError):
    """A file that is not a sound `.muaavatar`; `code` is the same in every reader, `field` says where."""

    def __init__(self, code: str, field: str, sentence: str, *, file: str = "") -> None:
        super().__init__(": ".join(part for part in (file, field, sentence) if part))
        self.code, self.field, self.sentence = code, field, sentence

    def inside(self, file: str) -> "FormatError":
        """The same error with the name of its file."""
        return FormatError(self.code, self.field, self.sentence, file=file)


def refuse(field: str, sentence: str) -> NoReturn:
    """Raise the error of a value that no file may have."""
    raise FormatError("value", field, sentence)


class _Builder(flatbuffers.Builder):
    """Also knows the vectors that are placed already."""

    def __init__(self) -> None:
        super().__init__(1 << 16)
        self.ForceDefaults(True)
        self.placed: dict[int, int] = {}  # by the identity of what they hold


def build(tree: Tree, stages: Sequence[Sequence[Array]] = ()) -> bytes:
    """The bytes of a file whose root table is `tree`; the same tree gives the same bytes.

    The data [bytes] of the tensors in `stages` stands last, stage by stage; the field `stages` says where each ends.
    """
    if not stages:
        return _build(tree, ())[0]
    _, ends = _build({**tree, "stages": np.zeros(len(stages))}, stages)
    return _build({**tree, "stages": ends}, stages)[0]


def _build(tree: Tree, stages: Sequence[Sequence[Array]]) -> tuple[bytes, list[int]]:
    """The file, and the byte after each stage's last; a FlatBuffer grows towards its start."""
    builder, behind = _Builder(), []
    for stage in reversed(stages):
        behind.append(builder.Offset())
        for values in reversed(stage):
            builder.placed[id(values)] = _build_scalars(builder, values, DATA_ALIGN)
    builder.Finish(_build_table(builder, ROOT, tree), file_identifier=IDENTIFIER)
    content = bytes(builder.Output())
    return content, [len(content) - offset for offset in reversed(behind)]


def _build_table(builder: _Builder, table: str, tree: Tree) -> int:
    fields = TABLES[table]
    offsets = {f.name: _build_child(builder, f, tree[f.name]) for f in fields if _by_offset(f) and f.name in tree}
    builder.StartObject(len(fields))
    for slot, field in enumerate(fields):
        if field.name in offsets:
            builder.PrependUOffsetTRelativeSlot(slot, offsets[field.name], 0)
        elif not _by_offset(field) and field.name in tree:
            _prepend_scalar(builder, slot, field, tree[field.name])
    return int(builder.EndObject())


def _by_offset(field: Field) -> bool:
    return field.vector or field.kind not in SCALARS


def _prepend_scalar(builder: flatbuffers.Builder, slot: int, field: Field, value: Any) -> None:
    if field.kind in ENUMS:
        value = ENUMS[field.kind].index(value)
    name = {"bool": "Bool", "ushort": "Uint16", "uint": "Uint32", "float": "Float32"}.get(field.kind, "Uint8")
    getattr(builder, f"Prepend{name}Slot")(slot, value, 0)


def _build_child(builder: _Builder, field: Field, value: Any) -> int:
    if id(value) in builder.placed:
        return builder.placed[id(value)]
    if field.vector and field.kind in SCALARS:
        return _build_scalars(builder, np.ascontiguousarray(value, dtype=SCALARS[field.kind]), field.align)
    if field.vector:
        items = [_build_one(builder, field.kind, item) for item in value]
        builder.StartVector(4, len(items), 4)
        for item in reversed(items):
            builder.PrependUOffsetTRelative(item)
        return int(builder.EndVector())
    return _build_one(builder, field.kind, value)


def _build_one(builder: _Builder, kind: str, value: Any) -> int:
    return int(builder.CreateString(value)) if kind == "string" else _build_table(builder, kind, value)


def _build_scalars(builder: flatbuffers.Builder, values: Array, align: int) -> int:
    content = values.tobytes()
    if builder.Offset() + len(content) > MAX_BYTES - (1 << 20):
        raise InputError(f"the avatar needs more than {MAX_BYTES} bytes, which a .muaavatar cannot hold: use f16 or i8")
    builder.StartVector(values.itemsize, values.size, max(align, values.itemsize))
    builder.head -= len(content)
    builder.Bytes[builder.head : builder.head + len(content)] = content
    return int(builder.EndVector())


def parse(content: bytes) -> Tree:
    """The root table of a file, every offset, length, alignment and string checked.

    Each table's dict also holds under `_at` the byte positions of its fields.
    Errors: FormatError with code `truncated`, `identifier`, `version`, `offset`, `missing`, `enum` or `text`.
    """
    if len(content) < 8:
        raise _cut(len(content), 8)
    if content[4:8] != IDENTIFIER:
        raise FormatError("identifier", "", f"the file is no .muaavatar: bytes 4 to 7 are not {IDENTIFIER.decode()}")
    version = _Parser(content).scalar(ROOT, "version_major")
    if version != VERSION[0]:
        sentence = f"format version {version}, expected {VERSION[0]}: update mua where the file is newer"
        raise FormatError("version", "version_major", sentence)
    return _Parser(content).table(ROOT, 0, "")


def _cut(size: int, needed: int) -> FormatError:
    sentence = f"the file has {size} bytes and needs at least {needed}: it is cut short or damaged; {AGAIN}"
    return FormatError("truncated", "", sentence)


class _Parser:
    """Walks a buffer; every position is checked before it is used.

    Tables and vectors may not overlap: else a small file could name one part a million times.
    """

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.left = len(content)  # bytes that no table or vector has claimed yet
        self.stated = 0  # bytes that the file says it has; 0 where it does not

    def scalar(self, table: str, name: str) -> int:
        """One scalar of the root table, read before the rest is trusted."""
        at = self._positions(table, self._follow(0, ""), "").get(name)
        field = next(field for field in TABLES[table] if field.name == name)
        return int(self._value(field, at, name)) if at else 0

    def table(self, table: str, at: int, path: str) -> Tree:
        """The table that the offset at byte `at` points to, as a dict."""
        positions = self._positions(table, self._follow(at, path), path)
        if table == ROOT and "stages" in positions:
            self.stated = self._last_word(positions["stages"])
        tree: Tree = {"_at": positions}
        for field in TABLES[table]:
            name = f"{path}.{field.name}".lstrip(".")
            if field.name in positions:
                tree[field.name] = self._value(field, positions[field.name], name)
            elif field.required:
                raise FormatError("missing", name, "the field is required and absent")
            elif not _by_offset(field):
                tree[field.name] = ENUMS[field.kind][0] if field.kind in ENUMS else SCALARS[field.kind].type(0).item()
        return tree

    def _positions(self, table: str, start: int, path: str) -> dict[str, int]:
        """Byte positions of the fields that the table at `start` holds."""
        vtable = start - self._unpack("<i", start, path)
        size, inline = self._unpack("<H", vtable, path), self._unpack("<H", vtable + 2, path)
        if size < 4 or size % 2 or vtable % 2 or inline < 4:
            raise FormatError("offset", path, f"the table's description at byte {vtable} is malformed")
        self._within(vtable, size, path)
        self._within(start, inline, path)
        self._claim(inline, path)
        positions = {}
        for field, entry in zip(TABLES[table], range(4, size, 2), strict=False):
            offset = self._unpack("<H", vtable + entry, path)
            width = 4 if _by_offset(field) else SCALARS[field.kind].itemsize
            if offset and (offset < 4 or offset + width > inline or (start + offset) % width):
                name = f"{path}.{field.name}".lstrip(".")
                raise FormatError("offset", name, f"offset {offset} lies outside its table of {inline} bytes")
            if offset:
                positions[field.name] = start + offset
        return positions

    def _value(self, field: Field, at: int, path: str) -> Any:
        if not _by_offset(field):
            return self._scalar(field, at, path)
        if not field.vector:
            return self._one(field.kind, at, path)
        start, count = self._vector(at, path, SCALARS[field.kind].itemsize if field.kind in SCALARS else 4)
        if field.kind in SCALARS:
            if start % max(field.align, SCALARS[field.kind].itemsize):
                raise FormatError("offset", path, f"the data at byte {start} is not aligned")
            return np.frombuffer(self.content, SCALARS[field.kind], count, start)
        return [self._one(field.kind, start + 4 * i, f"{path}[{i}]") for i in range(count)]

    def _scalar(self, field: Field, at: int, path: str) -> Any:
        value = np.frombuffer(self.content, SCALARS[field.kind], 1, at)[0].item()
        if field.kind in ENUMS:
            if value >= len(ENUMS[field.kind]):
                known = ", ".join(ENUMS[field.kind])
                raise FormatError("enum", path, f"value {value} is unknown, expected one of {known}")
            return ENUMS[field.kind][value]
        return value

    def _one(self, kind: str, at: int, path: str) -> Any:
        if kind != "string":
            return self.table(kind, at, path)
        start, count = self._vector(at, path, 1)
        try:
            text = self.content[start : start + count].decode()
        except UnicodeDecodeError as error:
            raise FormatError("text", path, "the text is not UTF-8") from error
        control = (CONTROL_IN_NOTES if path == "notes" else CONTROL).search(text)
        if control:
            raise FormatError("text", path, f"the text holds the control character U+{ord(control[0]):04X}")
        return text

    def _vector(self, at: int, path: str, width: int) -> tuple[int, int]:
        start = self._follow(at, path)
        count = self._unpack("<I", start, path)
        self._within(start + 4, count * width, path)
        self._claim(4 + count * width, path)
        return start + 4, count

    def _claim(self, size: int, path: str) -> None:
        self.left -= size
        if self.left < 0:
            raise FormatError("offset", path, "parts of the file overlap")

    def _follow(self, at: int, path: str) -> int:
        start = at + int(self._unpack("<I", at, path))
        if start % 4:
            raise FormatError("offset", path, f"the offset at byte {at} points to unaligned byte {start}")
        self._within(start, 4, path)
        return start

    def _unpack(self, form: str, at: int, path: str) -> int:
        self._within(at, struct.calcsize(form), path)
        return int(struct.unpack_from(form, self.content, at)[0])

    def _last_word(self, at: int) -> int:
        """The last number of the vector that the offset at byte `at` points to; 0 where the file does not hold it."""
        start = at + self._peek(at)
        return self._peek(start + 4 * self._peek(start))

    def _peek(self, at: int) -> int:
        return int(struct.unpack_from("<I", self.content, at)[0]) if at + 4 <= len(self.content) else 0

    def _within(self, at: int, size: int, path: str) -> None:
        if at < 0:
            raise FormatError("truncated", path, "an offset leads before the first byte of the file")
        if at + size > len(self.content):
            raise _cut(len(self.content), max(at + size, self.stated))
