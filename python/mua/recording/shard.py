"""The shard that a writer gathers, and its atomic write to the disk."""

import io
import os
import shutil
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.errors import InputError
from mua.recording.encode import Dynamic
from mua.recording.layout import INDEX, Header, Index, Segment, shard_name, to_json, whole_name


class Shard:
    """Frames gathered in memory; those kept whole go to the shard's hidden directory at once, being large."""

    def __init__(self, shards: Path, number: int, header: Header, *, durable: bool) -> None:
        self._final = shards / shard_name(number)
        self._part = shards / f".{shard_name(number)}.part"
        self._header, self._durable = header, durable
        self._crc: dict[str, int] = {}
        self.complete: list[str] = []  # clips that end here
        self._segments: list[Segment] = []
        self._rotations: list[Array] = []
        self._translations: list[Array] = []
        self._meshes: list[Array] = []
        self._subbands: list[Dynamic] = []

    @property
    def poses(self) -> int:
        return len(self._rotations)

    @property
    def frames(self) -> int:
        return len(self._meshes)

    @property
    def is_empty(self) -> bool:
        return not self._rotations and not self.complete

    def add_pose(self, clip: str, index: int, *, held_out: bool, rotations: Array, translations: Array) -> None:
        """Append the pose of frame `index` of `clip`."""
        if not self._segments or self._segments[-1].clip != clip:
            self._segments.append(Segment(clip, held_out, index, 0, [], []))
        self._segments[-1].poses += 1
        self._rotations.append(rotations)
        self._translations.append(translations)

    def add_frame(
        self,
        index: int,  # the frame whose pose was added last
        *,
        mesh: Array,  # [V, 3] float32
        subbands: Dynamic,  # float16
        whole: Array | None,  # [N, 23] float16 difference from the reference, if it is kept
    ) -> None:
        """Give the last pose its mesh and subbands."""
        if whole is not None:
            with self._writing():
                self._save(whole_name(self.frames), whole)
            self._segments[-1].whole.append(index)
        self._segments[-1].recorded.append(index)
        self._meshes.append(mesh)
        self._subbands.append(subbands)

    def commit(
        self,
        total: Array,  # [N, 23] float64 running sum
        *,
        training_frames: int,  # frames in the sum
    ) -> None:
        """Write the hidden directory, sync it if it is to be durable, and rename it.

        Raises InputError where the system refuses.
        """
        with self._writing():
            for name, array in {**self._arrays(), "sum": total}.items():
                self._save(name, array)
            index = Index(self._segments, self.complete, training_frames, self._crc, self._header.rig)
            (self._part / INDEX).write_bytes(to_json(index))
            if self._durable:
                for path in (*self._part.iterdir(), self._part):
                    sync(path)
            self._part.rename(self._final)
        if self._durable:
            sync(self._final.parent)

    def _save(self, name: str, array: Array) -> None:
        content = io.BytesIO()  # np.save into a file does not notice where a full disk loses the last bytes
        np.save(content, array, allow_pickle=False)
        path = self._part / f"{name}.npy"
        self._crc[path.name] = zlib.crc32(content.getbuffer())
        try:
            path.write_bytes(content.getbuffer())
        except OSError as error:
            error.filename = str(path)  # failed writes do not name their file
            raise

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Turn failed writes into one sentence, and leave nothing half written in the hidden directory."""
        try:
            self._part.mkdir(exist_ok=True)
            yield
        except OSError as error:
            shutil.rmtree(self._part, ignore_errors=True)
            named = self._final if error.filename is None else error.filename
            raise InputError(f"{named}: cannot be written ({error.strerror}); earlier shards are kept") from error

    def _arrays(self) -> dict[str, Array]:
        columns = {
            "rotations": self._rotations,
            "translations": self._translations,
            "meshes": self._meshes,
            "ll": [subbands.ll for subbands in self._subbands],
            "d3": [subbands.d3 for subbands in self._subbands],
            "d2": [subbands.d2 for subbands in self._subbands],
        }
        return {name: np.stack(columns[name]) for name in self._header.shapes(self.poses, self.frames)}


def sync(path: Path) -> None:
    """Make a file's content, or a directory's names, survive a loss of power."""
    if path.is_dir() and os.name != "posix":  # only POSIX opens directories
        return
    descriptor = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
