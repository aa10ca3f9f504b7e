"""Reading a recording: memory-mapped, so that it may be larger than memory."""

import hashlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mua.arguments import PathLike, amount, as_path
from mua.arrays import Array
from mua.channels import CHANNELS
from mua.errors import InputError
from mua.pose.clip import Clip, is_averaged
from mua.recording.encode import load_reference
from mua.recording.layout import (
    HEADER,
    INDEX,
    REFERENCE,
    RIG,
    SHARDS,
    SUM,
    Header,
    Index,
    check_sum,
    forget,
    open_array,
    read_header,
    read_indices,
    shard_name,
    whole_name,
)
from mua.recording.rig_file import read_rig, rig_hash
from mua.wavelets import Bands

Rows = Sequence[int] | Array | Tensor  # recorded frames of one kind, counted from 0 in the order of recording


@dataclass(frozen=True, eq=False, repr=False)
class RecordedClip(Clip):
    """The poses of all frames of a clip and which of them were recorded with mesh and texture."""

    held_out: bool
    recorded: Array  # [R] int64 frame indices, ascending
    complete: bool


@dataclass(frozen=True, eq=False)
class WholeFrame:
    """A frame that was kept whole."""

    clip: RecordedClip
    index: int  # in the clip
    row: int  # among the recorded frames of its kind
    mesh: Array  # [V, 3] float32 canonical vertices, metres
    texture: Array  # [N, 23] float32, rotations aligned to the reference frame


@dataclass(frozen=True, eq=False)
class _Shard:
    directory: Path
    index: Index
    arrays: dict[str, Array]  # memory maps by name
    sound: set[str] = field(default_factory=set)  # arrays whose checksum was verified

    def read(self, name: str) -> Array:
        """An array; its checksum is verified the first time. Raises InputError where the file is damaged."""
        if name not in self.sound:
            check_sum(self.directory / f"{name}.npy", self.index)
            self.sound.add(name)
        return self.arrays[name]


class Recording:
    """The finished shards of a recording; the files that are read are verified by their checksums.

    Rows of training (`held_out=False`) and of held-out frames are counted apart, each in the order of recording: clip
    after clip as `clips` lists them, within a clip as its `recorded` does. Values are absolute, in the teacher's units.
    """

    def __init__(self, directory: PathLike) -> None:
        """Raise InputError, a sentence that names the file, for anything missing, cut short or of another shape."""
        self.directory = as_path(directory, "directory")
        self.header = read_header(self.directory)
        self.rate, self.wavelet = self.header.rate, self.header.wavelet
        self.rig = read_rig(self.directory / RIG)
        if rig_hash(self.rig) != self.header.rig:
            raise InputError(f"{self.directory / RIG}: is not the rig whose hash {HEADER} holds")
        indices = read_indices(self.directory)
        self._shards = [_open(self.directory, number, index, self.header) for number, index in enumerate(indices)]
        self.clips = _clips(self._shards, self.header)
        self._places = {kind: _places(indices, held_out=kind) for kind in (False, True)}
        self.whole_count = sum(len(index.whole_rows) for index in indices)
        if any(index.frames for index in indices):
            self.reference = load_reference(self.directory / REFERENCE, self.header)
        if indices:
            last = self.directory / SHARDS / shard_name(len(indices) - 1) / SUM
            self._sum = open_array(last, (self.header.valid_texels, CHANNELS), "<f8")
            check_sum(last, indices[-1])
            if not np.isfinite(self._sum).all():
                raise not_finite(last, "the sum of all frames")
            forget(self._sum)

    def __repr__(self) -> str:
        frames = f"{self.count()} training and {self.count(held_out=True)} held-out frames"
        return f"<mua.Recording {str(self.directory)!r}: {frames} of {amount(len(self.clips), 'clip')}>"

    def __reduce__(self) -> tuple[type["Recording"], tuple[Path]]:
        return Recording, (self.directory,)  # another process maps its files

    def count(self, held_out: bool = False) -> int:
        """Number of frames with mesh and subbands."""
        return len(self._places[held_out])

    def subbands(
        self,
        channels: slice,  # among the 23
        rows: Rows,
        *,
        held_out: bool = False,
    ) -> Bands:
        """Absolute subbands of some channels and frames: the stored differences plus the reference's."""
        at = self._at(rows, held_out=held_out)
        reference = self.reference.subbands
        bands = []
        for name, part in (("ll", (channels,)), ("d3", (slice(None), channels)), ("d2", (slice(None), channels))):
            gathered = self._gather(name, at, part)
            gathered += getattr(reference, name)[part]  # in place, because all frames together are large
            bands.append(torch.from_numpy(gathered))
        return Bands(*bands)

    def meshes(self, rows: Rows, *, held_out: bool = False) -> Array:
        """Canonical vertices [F, V, 3] float32, metres."""
        return self._gather("meshes", self._at(rows, held_out=held_out), ())

    def mean_texture(self) -> Array:
        """The mean [N, 23] float64 over all training frames, at full precision and not only over those kept whole."""
        count = self._averaged_frames  # checked first: without frames there is no sum
        mean = self._sum / count
        forget(self._sum)
        mean += self.reference.texture
        return mean

    def mean_mesh(self) -> Array:
        """The mean canonical vertices [V, 3] float64 over all training frames, metres."""
        total = np.zeros((self.header.vertices, 3))
        for number in np.unique(self._places[False][:, 0]):
            rows = self._places[False][self._places[False][:, 0] == number, 1]
            total += self._shards[number].read("meshes")[rows].sum(axis=0, dtype=np.float64)
            forget(self._shards[number].arrays["meshes"])
        return total / self._training_frames

    def whole_frames(self, held_out: bool | None = None) -> Iterator[WholeFrame]:
        """The frames kept whole, of one kind or (None) of both, in the order of recording."""
        by_name = {clip.name: clip for clip in self.clips}
        for number, shard in enumerate(self._shards):
            owners = [(segment, frame) for segment in shard.index.segments for frame in segment.recorded]
            for row in shard.index.whole_rows:
                segment, frame = owners[row]
                if held_out is None or segment.held_out == held_out:
                    texture = self.reference.texture + shard.read(whole_name(row)).astype(np.float32)
                    mesh = np.array(shard.read("meshes")[row])
                    for name in (whole_name(row), "meshes"):
                        forget(shard.arrays[name])
                    if not np.isfinite(texture).all():
                        raise not_finite(
                            shard.directory / f"{whole_name(row)}.npy", f"frame {frame} of {segment.clip!r}"
                        )
                    among = int((self._places[segment.held_out] == (number, row)).all(axis=1).argmax())
                    yield WholeFrame(by_name[segment.clip], frame, among, mesh, texture)

    def fingerprint(self) -> str:
        """A SHA-256 that changes with any recorded frame."""
        digest = hashlib.sha256()
        for name in (HEADER, REFERENCE):
            path = self.directory / name
            digest.update(path.read_bytes() if path.exists() else b"")
        for number in range(len(self._shards)):
            digest.update((self.directory / SHARDS / shard_name(number) / INDEX).read_bytes())
        return digest.hexdigest()

    @cached_property
    def _averaged_frames(self) -> int:
        clips = [clip for clip in self.clips if is_averaged(clip.name, held_out=clip.held_out)]
        count = sum(len(clip.recorded) for clip in clips)
        if not count:
            raise InputError(f"recording {self.directory}: it holds no training frame")
        return count

    @cached_property
    def _training_frames(self) -> int:
        if not self.count():
            raise InputError(f"recording {self.directory}: it holds no training frame")
        return self.count()

    def _at(self, rows: Rows, *, held_out: bool) -> Array:
        """Shard and row in it [F, 2] of recorded frames; raises InputError for a missing row."""
        asked, count = np.asarray(rows, dtype=np.int64), self.count(held_out)
        wrong = asked[(asked < 0) | (asked >= count)]
        if wrong.size:
            kind = "held-out" if held_out else "training"
            raise InputError(f"recording {self.directory}: row {wrong[0]}, but it holds {count} {kind} frames")
        return self._places[held_out][asked]

    def _gather(
        self,
        name: str,
        places: Array,  # [F, 2] shard, row
        part: tuple[slice, ...],  # within each row
    ) -> Array:
        """Gather rows [F, ...] of one array from their shards, as float32."""
        if not len(places):
            shape = self.header.shapes(1, 1)[name][0]
            return np.zeros(shape, np.float32)[(slice(0), *part)]
        picked: Array | None = None
        for number in np.unique(places[:, 0]):
            here = places[:, 0] == number
            rows = self._shards[number].read(name)[(slice(None), *part)][places[here, 1]]
            if picked is None:
                picked = np.empty((len(places), *rows.shape[1:]), np.float32)
            picked[here] = rows
            forget(self._shards[number].arrays[name])
        assert picked is not None
        if not math.isfinite(picked.sum(dtype=np.float64)):  # one cheap pass; the place is found only after a failure
            self._refuse(name, places, picked)
        return picked

    def _refuse(self, name: str, places: Array, picked: Array) -> None:
        """Raise InputError for the first frame of `picked` [F, ...] that holds a value that is not finite."""
        finite = np.isfinite(picked).reshape(len(picked), -1).all(axis=1)
        number, row = places[int(np.argmin(finite))]
        shard = self._shards[number]
        clip, frame = [(s.clip, frame) for s in shard.index.segments for frame in s.recorded][row]
        raise not_finite(shard.directory / f"{name}.npy", f"frame {frame} of {clip!r}")


def not_finite(path: Path, where: str) -> InputError:
    return InputError(f"{path}: {where} holds a value that is no number, expected finite ones")


def _open(directory: Path, number: int, index: Index, header: Header) -> _Shard:
    """Map every array of a shard, which checks its presence, size, shape and type."""
    expected = header.shapes(index.poses, index.frames)
    for row in index.whole_rows:
        expected[whole_name(row)] = ((header.valid_texels, CHANNELS), "<f2")
    shard = directory / SHARDS / shard_name(number)
    if index.rig not in ("", header.rig):
        raise InputError(f"{shard / INDEX}: holds frames of another rig than {RIG} of the recording")
    opened = _Shard(shard, index, {name: open_array(shard / f"{name}.npy", *form) for name, form in expected.items()})
    for name in ("rotations", "translations"):
        if name in expected and not np.isfinite(opened.read(name)).all():
            raise not_finite(shard / f"{name}.npy", "a pose")
    return opened


def _places(indices: Sequence[Index], *, held_out: bool) -> Array:
    """[F, 2] shard and row in it of each recorded frame of a kind."""
    places = []
    for number, index in enumerate(indices):
        kinds = [segment.held_out for segment in index.segments for _ in segment.recorded]
        places += [(number, row) for row, kind in enumerate(kinds) if kind == held_out]
    return np.array(places, dtype=np.int64).reshape(-1, 2)


def _clips(shards: Sequence[_Shard], header: Header) -> tuple[RecordedClip, ...]:
    """Clips in the order of recording, their poses joined over shards."""
    rotations: dict[str, list[Array]] = {}
    translations: dict[str, list[Array]] = {}
    recorded: dict[str, list[int]] = {}
    held_out: dict[str, bool] = {}
    for shard in shards:
        start = 0
        for segment in shard.index.segments:
            own = slice(start, start + segment.poses)
            rotations.setdefault(segment.clip, []).append(shard.arrays["rotations"][own])
            translations.setdefault(segment.clip, []).append(shard.arrays["translations"][own])
            recorded.setdefault(segment.clip, []).extend(segment.recorded)
            held_out[segment.clip] = segment.held_out
            start += segment.poses
    complete = {name for shard in shards for name in shard.index.complete}
    clips = tuple(
        RecordedClip(
            name,
            header.rate,
            np.concatenate(rotations[name]),
            np.concatenate(translations[name]),
            held_out[name],
            np.array(recorded[name], dtype=np.int64),
            name in complete,
        )
        for name in rotations
    )
    for shard in shards:  # what was joined is a copy
        for name in {"rotations", "translations"} & set(shard.arrays):
            forget(shard.arrays[name])
    return clips
