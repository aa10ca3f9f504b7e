"""Writing a recording, frame by frame, from any program that has a teacher."""

import shutil
import warnings
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

import numpy as np

from mua.arguments import PathLike, as_path, describe, whole_number
from mua.arrays import Array
from mua.channels import CHANNELS, COARSE_TEXELS
from mua.errors import InputError
from mua.files.lock import DirectoryLock
from mua.filters import WAVELET, filters
from mua.limits import LARGEST_RATE, LEAST_RATE
from mua.pose.clip import is_averaged
from mua.pose.skeleton import Pose
from mua.recording.encode import (
    Dynamic,
    Reference,
    align_rotations,
    filled_subbands,
    load_reference,
    save_reference,
)
from mua.recording.frame_checks import HALF_MAX, check_order, check_range, checked_array, checked_pose, valid_texture
from mua.recording.layout import (
    HEADER,
    REFERENCE,
    RIG,
    SHARDS,
    SUM,
    Header,
    open_array,
    read_header,
    read_indices,
    shard_name,
    write_header,
)
from mua.recording.plausible import Finding, LikelyMistake, Plausible, rig_findings
from mua.recording.rig_file import write_rig
from mua.recording.shard import Shard
from mua.rig.rig import Rig
from mua.texture.fill import fill_of

POSES_PER_SHARD = 4096  # a shard ends here at the latest, however few of its frames are recorded


@dataclass
class _ClipState:
    """The progress of one clip."""

    held_out: bool
    frames: int = 0
    recorded: list[int] = field(default_factory=list)
    complete: bool = False


@dataclass(frozen=True, eq=False)
class _Encoded:
    """A frame as it is stored."""

    mesh: Array  # [V, 3] float32
    difference: Array  # [N, 23] float32 from the reference texture
    subbands: Dynamic  # float16 subbands of the difference


class TeacherWriter:
    """Appends a teacher's frames to a recording; use it as a context manager. See docs/recording.md."""

    def __init__(
        self,
        directory: PathLike,
        rig: Rig,
        *,
        rate: float,  # frames per second of every clip
        wavelet: str = WAVELET,
        whole_every: int = 50,  # one of this many recorded frames of a clip is kept whole
        shard_frames: int = 32,  # recorded frames of a shard, the most that a kill loses
        durable: bool = True,  # whether a finished shard survives a loss of power; syncing waits for the disk
    ) -> None:
        """Open `directory` to go on with its recording, or to begin one.

        Raises InputError where it holds a recording of another rig, rate or wavelet, where it is damaged, where another
        writer is at work in it, where the texture size cannot be halved four times, or where the rig is a mistake.
        """
        self.directory = directory = as_path(directory, "directory")
        if not isinstance(rig, Rig):
            raise InputError(f"rig is {describe(rig)}; expected a mua.rig.rig.Rig")
        for name, count in (("whole_every", whole_every), ("shard_frames", shard_frames)):
            if whole_number(count, name) < 1:
                raise InputError(f"recording {directory}: {name} is {count}, expected at least 1")
        filters(wavelet)
        if rig.texels.size % COARSE_TEXELS:
            raise InputError(
                f"recording {directory}: texture size {rig.texels.size}, expected a multiple of {COARSE_TEXELS}"
            )
        if not isinstance(rate, int | float | np.number) or not LEAST_RATE <= rate <= LARGEST_RATE:
            expected = f"{LEAST_RATE:g} to {LARGEST_RATE:g} frames per second"
            raise InputError(f"recording {directory}: rate is {rate}, expected {expected}")
        self._warned: set[str] = set()  # mistakes already warned of
        try:
            self._judge(rig_findings(rig), "rig")
        except InputError as error:
            raise InputError(f"recording {directory}: rig: {error}") from None
        self._plausible = Plausible(rig)
        self.rate = float(rate)
        self._header = Header.of(rig, rate=rate, wavelet=wavelet)
        self._texels = rig.texels
        self._whole_every, self._shard_frames, self._durable = whole_every, shard_frames, durable
        self._fill = fill_of(rig.texels)
        self._reference: Reference | None = None
        self._clips: dict[str, _ClipState] = {}
        self._clip = ""
        self._lock = DirectoryLock(self.directory, name=f"recording {self.directory}")
        try:
            self._take_up(rig)
        except BaseException:
            self._lock.release()
            raise

    @property
    def has_reference(self) -> bool:
        """Whether the recording has its reference texture."""
        return self._reference is not None

    def refer_to(self, texture: Array) -> None:
        """Store all frames as differences from `texture` instead of the first one; comes before the first frame.

        Raises InputError where there is another reference already.
        """
        values = valid_texture(texture, self._header, self._texels.texels)
        if self._reference is None:
            self._reference = self._keep_reference(values)
        elif not np.array_equal(self._reference.texture, values):
            raise InputError(f"{self.directory / REFERENCE}: is another texture than the one to refer to")

    def start_clip(self, name: str, *, held_out: bool = False) -> None:
        """Start the clip of the next frames, which completes the one before it.

        A clip that an earlier run left half recorded goes on at `next_frame(name)`. `held_out` frames are kept for
        evaluation and stay out of the mean. Raises InputError for a complete clip or another `held_out` than before.
        """
        if not isinstance(name, str) or not name:
            raise InputError(f"recording {self.directory}: the clip's name is {describe(name)}; expected a text")
        if name == self._clip:
            return
        state = self._clips.get(name, _ClipState(held_out))
        if state.complete:
            raise InputError(f"recording {self.directory}: clip {name!r} is complete, expected another name")
        if state.held_out != held_out:
            raise InputError(f"recording {self.directory}: clip {name!r} began with held_out={state.held_out}")
        for other, before in self._clips.items():
            if other != name and not before.complete:  # the current clip, or one left by a killed run
                self._complete(other)
        self._clips[name], self._clip = state, name

    def add(
        self,
        pose: Pose,
        mesh: Array | None = None,  # [V, 3] canonical template vertices, metres
        texture: Array | None = None,  # [N, 23] at the valid texels, or [H, W, 23]; raw channels (mua.channels)
        *,
        frame: int | None = None,  # index in the clip, from 0; where given, frames out of order are refused
        whole: bool | None = None,  # also keep the texture itself, for evaluation; None: every `whole_every`-th time
    ) -> None:
        """Append the clip's next frame; without mesh and texture its pose alone, as history of later frames.

        Rotations are brought to the hemisphere of the first texture ever added, texel by texel.
        Raises InputError that names clip, frame and field for a wrong shape, a value that is not finite, or numbers
        that a mistake in units or conventions explains; warns with LikelyMistake of those that may be one.
        """
        if not self._clip:
            raise InputError(f"recording {self.directory}: start_clip comes before the first frame")
        state = self._clips[self._clip]
        where = f"clip {self._clip!r}, frame {state.frames}"
        try:
            if frame is not None:
                check_order(frame, state.frames)
            rotations, translations = checked_pose(pose, self._header.joints)
            self._judge(self._plausible.pose(Pose(rotations, translations)), where)
            encoded = self._encode(Pose(rotations, translations), mesh, texture, where)
        except InputError as error:
            raise InputError(f"recording {self.directory}: {where}: {error}") from None
        self._shard.add_pose(
            self._clip, state.frames, held_out=state.held_out, rotations=rotations, translations=translations
        )
        if encoded is not None:
            self._keep(state, encoded, whole=len(state.recorded) % self._whole_every == 0 if whole is None else whole)
        state.frames += 1
        if self._shard.frames >= self._shard_frames or self._shard.poses >= POSES_PER_SHARD:
            self._flush()

    def next_frame(self, clip: str) -> int:
        """The index of the frame of `clip` that is to be added next; after reopening, how many are safely stored."""
        return self._clips[clip].frames if clip in self._clips else 0

    def recorded(self, clip: str) -> tuple[int, ...]:
        """The indices of the frames of `clip` that were added with mesh and texture."""
        return tuple(self._clips[clip].recorded) if clip in self._clips else ()

    def is_complete(self, clip: str) -> bool:
        """Whether another clip was started after `clip`, or `finish` called."""
        return clip in self._clips and self._clips[clip].complete

    def finish(self) -> None:
        """Mark the last clip complete and store what is pending; the writer can go on with another clip."""
        if self._clip:
            self._complete(self._clip)
            self._clip = ""
        self._flush()

    def __enter__(self) -> "TeacherWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Finish and release the recording; after an error nothing more is stored, as after a kill."""
        try:
            if kind is None:
                self.finish()
        finally:
            self._lock.release()

    def _take_up(self, rig: Rig) -> None:
        """Begin the recording, or read how far it got."""
        _begin(self.directory, self._header, rig)
        _remove_leftovers(self.directory)
        if (self.directory / REFERENCE).exists():
            self._reference = load_reference(self.directory / REFERENCE, self._header)
        self._read_shards()

    def _read_shards(self) -> None:
        """Restore the state from the finished shards."""
        indices = read_indices(self.directory)
        for index in indices:
            for segment in index.segments:
                state = self._clips.setdefault(segment.clip, _ClipState(segment.held_out))
                state.frames += segment.poses
                state.recorded += segment.recorded
            for name in index.complete:
                self._clips.setdefault(name, _ClipState(held_out=False)).complete = True
        self._training_frames = indices[-1].training_frames if indices else 0
        self._sum = np.zeros((CHANNELS, self._header.valid_texels)).T
        if indices:
            self._sum += open_array(
                self.directory / SHARDS / shard_name(len(indices) - 1) / SUM, self._sum.shape, "<f8"
            )
        self._begin_shard(len(indices))

    def _complete(self, clip: str) -> None:
        self._clips[clip].complete = True
        self._shard.complete.append(clip)

    def _judge(self, findings: Iterable[Finding], where: str) -> None:
        """Refuse certain mistakes; warn once of each possible one."""
        for finding in findings:
            if finding.certain:
                raise InputError(finding.sentence)
            cause = finding.sentence.rpartition(": ")[2]
            if cause not in self._warned:
                self._warned.add(cause)
                warnings.warn(f"recording {self.directory}: {where}: {finding.sentence}", LikelyMistake, stacklevel=4)

    def _encode(self, pose: Pose, mesh: Array | None, texture: Array | None, where: str) -> _Encoded | None:
        """Check a frame and transform it relative to the reference, which the first texture becomes."""
        if mesh is None and texture is None:
            return None
        if mesh is None or texture is None:
            raise InputError(f"{'mesh' if mesh is None else 'texture'} is missing, expected both or neither")
        vertices = checked_array("mesh", mesh, (self._header.vertices, 3), np.float32)
        values = valid_texture(texture, self._header, self._texels.texels)
        check_range(values, self._texels.texels, self._texels.size)
        image = np.asarray(texture) if np.ndim(texture) > 2 else None
        self._judge(self._plausible.frame(pose, vertices, values, image), where)
        if self._reference is None:
            self._reference = self._keep_reference(values)
        difference = align_rotations(values, self._reference.texture)
        difference -= self._reference.texture
        check_range(difference, self._texels.texels, self._texels.size)
        subbands = filled_subbands(difference, self._fill, wavelet=self._header.wavelet)
        if subbands.peak > HALF_MAX:
            raise InputError(f"texture: a subband differs by {subbands.peak:.3g} from the reference frame's")
        return _Encoded(vertices, difference, subbands.half())

    def _keep(self, state: _ClipState, frame: _Encoded, *, whole: bool) -> None:
        kept = frame.difference.astype(np.float16, order="C") if whole else None
        self._shard.add_frame(state.frames, mesh=frame.mesh, subbands=frame.subbands, whole=kept)
        state.recorded.append(state.frames)
        if is_averaged(self._clip, held_out=state.held_out):
            self._sum += frame.difference
            self._training_frames += 1

    def _keep_reference(self, texture: Array) -> Reference:
        check_range(texture, self._texels.texels, self._texels.size)
        texture = texture.copy(order="K")  # the caller may fill the same buffer with the next frame
        reference = Reference(texture, filled_subbands(texture, self._fill, wavelet=self._header.wavelet))
        if reference.subbands.peak > HALF_MAX:
            raise InputError(f"texture: a subband is {reference.subbands.peak:.3g}, expected at most {HALF_MAX:.0f}")
        save_reference(self.directory / REFERENCE, reference)
        return reference

    def _flush(self) -> None:
        """Store the gathered shard, if anything is in it."""
        if self._shard.is_empty:
            return
        self._shard.commit(np.ascontiguousarray(self._sum), training_frames=self._training_frames)
        self._begin_shard(self._number + 1)

    def _begin_shard(self, number: int) -> None:
        self._number = number
        self._shard = Shard(self.directory / SHARDS, number, self._header, durable=self._durable)
        if number > 1:  # only the last shard's running sum is used; a kill may have left the one before it
            (self.directory / SHARDS / shard_name(number - 2) / SUM).unlink(missing_ok=True)


def _begin(directory: Path, header: Header, rig: Rig) -> None:
    """Write header and rig of a new recording, or compare them with those of an existing one."""
    if not (directory / HEADER).exists():
        (directory / SHARDS).mkdir(parents=True, exist_ok=True)
        write_rig(directory / RIG, rig)
        write_header(directory, header)
        return
    stored = read_header(directory)
    for name, mine in vars(header).items():
        theirs = getattr(stored, name)
        if theirs != mine:
            raise InputError(
                f"{directory / HEADER}: {name} is {theirs!r}, expected {mine!r}; record into another directory"
            )


def _remove_leftovers(directory: Path) -> None:
    for path in directory.glob(".*.part*"):
        path.unlink()
    for path in (directory / SHARDS).glob(".*.part"):
        shutil.rmtree(path)
