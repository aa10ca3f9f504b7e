"""The files of a recording: their names, the content of the JSON files and the shapes of the arrays."""

import json
import mmap
import zlib
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.channels import CHANNELS, COARSE_TEXELS
from mua.errors import InputError
from mua.files.write import write_bytes
from mua.recording.rig_file import rig_hash
from mua.rig.rig import Rig

VERSION = 2
HEADER, RIG, REFERENCE, SHARDS = "recording.json", "rig.npz", "reference.npz", "shards"
INDEX, SUM = "index.json", "sum.npy"
BLOCK = 1 << 20  # bytes of a file at once


@dataclass(frozen=True)
class Header:
    """Properties that all frames of a recording share."""

    version: int
    rig: str  # SHA-256
    rate: float  # frames per second
    wavelet: str
    texels: int  # H = W
    valid_texels: int
    vertices: int
    joints: int

    @classmethod
    def of(cls, rig: Rig, *, rate: float, wavelet: str) -> "Header":
        valid, vertices, joints = len(rig.texels.texels), len(rig.mesh.vertices), len(rig.skeleton.names)
        return cls(VERSION, rig_hash(rig), float(rate), wavelet, rig.texels.size, valid, vertices, joints)

    def shapes(self, poses: int, frames: int) -> dict[str, tuple[tuple[int, ...], str]]:
        """Shape and element type of a shard's arrays that hold a row per pose or per frame; none where no row is."""
        n = self.texels // COARSE_TEXELS
        shapes: dict[str, tuple[tuple[int, ...], str]] = {}
        if poses:
            shapes["rotations"] = ((poses, self.joints, 4), "<f8")
            shapes["translations"] = ((poses, self.joints, 3), "<f8")
        if frames:
            shapes["meshes"] = ((frames, self.vertices, 3), "<f4")
            shapes["ll"] = ((frames, CHANNELS, n, n), "<f2")
            shapes["d3"] = ((frames, 3, CHANNELS, n, n), "<f2")
            shapes["d2"] = ((frames, 3, CHANNELS, 2 * n, 2 * n), "<f2")
        return shapes


@dataclass
class Segment:
    """Consecutive frames of one clip, all of whose poses a shard holds."""

    clip: str
    held_out: bool
    start: int  # index in the clip of the first
    poses: int
    recorded: list[int]  # indices in the clip of the frames with mesh and subbands, ascending
    whole: list[int]  # the ones among them that are kept whole


@dataclass(frozen=True)
class Index:
    """The content of one shard: its frames are those of its segments in order."""

    segments: list[Segment]
    complete: list[str]  # clips that ended in this shard
    training_frames: int  # number of frames in the running sum, from the first shard to this one
    crc32: dict[str, int]  # checksums of the shard's other files
    rig: str = ""  # SHA-256 of the frames' rig; may be missing

    @property
    def poses(self) -> int:
        return sum(segment.poses for segment in self.segments)

    @property
    def frames(self) -> int:
        return sum(len(segment.recorded) for segment in self.segments)

    @property
    def whole_rows(self) -> list[int]:
        """The shard's recorded frames that are kept whole, counted over the shard."""
        kept = [frame in segment.whole for segment in self.segments for frame in segment.recorded]
        return [row for row, whole in enumerate(kept) if whole]


def write_header(directory: Path, header: Header) -> None:
    write_bytes(directory / HEADER, to_json(header))


def read_header(directory: Path) -> Header:
    """Read a header. Raises InputError where `directory` is no recording, or one of a newer version."""
    path = directory / HEADER
    if not path.is_file():
        raise InputError(f"{directory}: not a recording, it holds no {HEADER}")
    stored = _read_json(path)
    if stored.get("version") != VERSION:
        raise InputError(f"{path}: version is {stored.get('version')!r}, this program reads {VERSION}")
    try:
        header = Header(**stored)
    except TypeError as error:
        raise InputError(f"{path}: not the header of a recording: {error}") from error
    for field in fields(Header):
        value = getattr(header, field.name)
        if not isinstance(value, field.type):  # type: ignore[arg-type]
            raise InputError(f"{path}: {field.name} is {value!r}, expected {field.type}")
    if header.texels <= 0 or header.texels % COARSE_TEXELS:
        raise InputError(f"{path}: texels is {header.texels}, expected a multiple of {COARSE_TEXELS}")
    return header


def read_indices(directory: Path) -> list[Index]:
    """The indices of all finished shards; raises InputError where one is missing or damaged."""
    names = sorted(path.name for path in (directory / SHARDS).glob("[0-9]*"))
    for number, name in enumerate(names):
        if name != shard_name(number):
            raise InputError(f"{directory / SHARDS}: shard {shard_name(number)} is missing, {name} is there")
    return [read_index(directory / SHARDS / name) for name in names]


def read_index(shard: Path) -> Index:
    stored = _read_json(shard / INDEX)
    try:
        stored["segments"] = [Segment(**segment) for segment in stored["segments"]]
        return Index(**stored)
    except (KeyError, TypeError) as error:
        raise InputError(f"{shard / INDEX}: not the index of a shard: {error}") from error


def to_json(value: Header | Index) -> bytes:
    return (json.dumps(asdict(value), indent=1, sort_keys=True) + "\n").encode()


def shard_name(number: int) -> str:
    return f"{number:05d}"


def whole_name(row: int) -> str:
    """The name of the array of a shard's recorded frame `row`, kept whole."""
    return f"whole_{row:05d}"


def open_array(path: Path, shape: tuple[int, ...], dtype: str) -> Array:
    """Map a .npy file of known shape and type into memory; raises InputError where it is anything else."""
    try:
        array = np.load(path, mmap_mode="r", allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        problem = "is missing" if not path.exists() else "is damaged or cut short"
        raise InputError(f"{path} {problem}, expected {shape} of {dtype}") from error
    if array.shape != shape or array.dtype != np.dtype(dtype):
        raise InputError(f"{path} holds {array.shape} of {array.dtype.str}, expected {shape} of {dtype}")
    return np.asarray(array)


def check_sum(path: Path, index: Index) -> None:
    """Raise InputError where a shard's file has another checksum than when it was written."""
    found = 0
    with path.open("rb") as file:
        while block := file.read(BLOCK):
            found = zlib.crc32(block, found)
    if found != index.crc32.get(path.name):
        raise InputError(
            f"{path}: is damaged: its checksum differs from that in {INDEX}; copy the file again or record it again"
        )


def forget(array: Array) -> None:
    """Drop a mapped file's pages from this process's memory; they are mapped again when they are next read.

    The system keeps what it read of a file as long as it has room, but counts pages that are mapped as used.
    """
    owner: object = array
    while isinstance(owner, np.ndarray):
        owner = owner.base
    if isinstance(owner, mmap.mmap) and hasattr(owner, "madvise"):  # Windows has none
        owner.madvise(mmap.MADV_DONTNEED)


def _read_json(path: Path) -> dict[str, Any]:
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: {'is missing' if not path.exists() else 'is damaged: not JSON'}") from error
    if not isinstance(stored, dict):
        raise InputError(f"{path}: is damaged, expected a JSON object")
    return stored
