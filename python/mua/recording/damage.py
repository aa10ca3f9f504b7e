"""Checks that a recording is byte for byte as its writer left it, before a bake goes on from it."""

from collections.abc import Sequence
from pathlib import Path

from mua.errors import InputError
from mua.filters import WAVELET
from mua.pose.clip import is_averaged
from mua.recording.encode import load_reference
from mua.recording.layout import (
    HEADER,
    INDEX,
    REFERENCE,
    SHARDS,
    SUM,
    Header,
    Index,
    Segment,
    check_sum,
    read_indices,
    shard_name,
    whole_name,
)
from mua.recording.reader import RecordedClip, Recording
from mua.recording.record import PlannedClip


def check(
    directory: Path,
    plan: Sequence[PlannedClip],  # plan by which it was recorded
    *,
    rate: float,
    whole: bool,  # whether every clip is complete
) -> None:
    """Raise InputError, a sentence that names the file, where anything differs from what the plan's writer left."""
    recording = Recording(directory)
    if recording.header != Header.of(recording.rig, rate=rate, wavelet=WAVELET):
        raise InputError(f"{directory / HEADER}: differs from the header that was written")
    indices = read_indices(directory)
    if indices:
        load_reference(directory / REFERENCE, recording.header)
    for number, index in enumerate(indices):
        _check_sums(directory / SHARDS / shard_name(number), index, recording.header, last=number == len(indices) - 1)
    _check_indices(directory, indices, plan)
    for planned in plan:
        found = next((clip for clip in recording.clips if clip.name == planned.clip.name), None)
        if not _holds(found, planned, whole=whole):
            raise InputError(f"{directory}: clip {planned.clip.name!r} holds other frames than those recorded")


def _check_sums(shard: Path, index: Index, header: Header, *, last: bool) -> None:
    """Every array has the checksum that was taken when it was written."""
    names = [f"{name}.npy" for name in header.shapes(index.poses, index.frames)]
    names += [f"{whole_name(row)}.npy" for row in index.whole_rows]
    if {SUM, *names} != set(index.crc32):
        raise InputError(f"{shard / INDEX}: lists other files than its frames need")
    for name in [*names, SUM] if last else names:  # only the last shard keeps its sum
        check_sum(shard / name, index)


def _check_indices(directory: Path, indices: Sequence[Index], plan: Sequence[PlannedClip]) -> None:
    """Segments follow upon each other, are those planned, and the training frames among them are counted rightly."""
    planned = {clip.clip.name: clip for clip in plan}
    frames, ends = 0, dict.fromkeys(planned, 0)
    for number, index in enumerate(indices):
        for segment in index.segments:
            own = planned.get(segment.clip)
            if own is None or segment.start != ends[segment.clip] or segment.whole != _kept(own, segment):
                raise InputError(
                    f"{directory / SHARDS / shard_name(number) / INDEX}: differs from the index that was written"
                )
            ends[segment.clip] += segment.poses
            frames += len(segment.recorded) if is_averaged(segment.clip, held_out=own.held_out) else 0
        if index.training_frames != frames:
            raise InputError(
                f"{directory / SHARDS / shard_name(number) / INDEX}: has a frame count that differs from its list"
            )


def _kept(planned: PlannedClip, segment: Segment) -> list[int]:
    """The frames of a segment that the plan keeps whole."""
    return segment.whole if planned.whole is None else sorted(planned.whole & set(segment.recorded))


def _holds(found: RecordedClip | None, planned: PlannedClip, *, whole: bool) -> bool:
    """Whether a clip is recorded as it was planned, as far as it is recorded."""
    if found is None:
        return not whole
    frames = len(found)
    return (
        found.held_out == planned.held_out
        and found.recorded.tolist() == sorted(index for index in planned.wanted if index < frames)
        and (frames == len(planned.clip) if found.complete else not whole and frames <= len(planned.clip))
    )
