"""One recording in parts: runs of clips that any number of processes record side by side, and that are then joined.

A part is a recording like any other, in a directory beside the final one. All parts store differences from the same
texture, so that joining is no more than listing the shards one after the other and adding up the sums. How a plan is
divided follows from the plan alone: whichever process records the parts, the joined recording has the same bytes.
"""

import os
import shutil
import zlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from mua.arguments import PathLike, as_path
from mua.arrays import Array
from mua.channels import CHANNELS
from mua.errors import InputError
from mua.recording.layout import (
    HEADER,
    INDEX,
    REFERENCE,
    RIG,
    SHARDS,
    SUM,
    Index,
    open_array,
    read_header,
    read_indices,
    shard_name,
    to_json,
)
from mua.recording.record import PlannedClip, played, record
from mua.recording.shard import sync
from mua.recording.writer import TeacherWriter
from mua.teacher import Teacher, TeacherFrame
from mua.training.processes import Processes

MOST_PARTS = 64  # each has a copy of rig and reference until it is joined


def divide(plan: Sequence[PlannedClip]) -> list[list[PlannedClip]]:
    """Split a plan into parts: a clip each, or consecutive clips of about as many frames each where there are many.

    Raises InputError where there is no clip.
    """
    if not plan:
        raise InputError("plan: holds no clip, expected at least one")
    count = min(len(plan), MOST_PARTS)
    lengths = np.array([len(planned.clip) for planned in plan])
    middles = np.cumsum(lengths) - lengths / 2
    owners = (middles * count / max(lengths.sum(), 1)).astype(int).clip(max=count - 1)
    if count == len(plan):
        owners = np.arange(count)
    parts = [[planned for planned, owner in zip(plan, owners, strict=True) if owner == part] for part in range(count)]
    return [part for part in parts if part]


def longest_first(parts: Sequence[Sequence[PlannedClip]]) -> list[int]:
    """The order in which parts are recorded, so that no long one is left to a single process at the end."""
    lengths = [sum(len(planned.clip) for planned in part) for part in parts]
    return sorted(range(len(parts)), key=lambda part: (-lengths[part], part))


def share(parts: Sequence[Sequence[PlannedClip]], rank: int, count: int) -> list[int]:
    """The parts that one of `count` processes records; each part goes to the process with the least work so far."""
    loads = np.zeros(count)
    mine = []
    for part in longest_first(parts):
        owner = int(np.argmin(loads))
        loads[owner] += sum(len(planned.clip) for planned in parts[part])
        if owner == rank:
            mine.append(part)
    return mine


def record_together(
    teacher: Teacher,
    plan: Sequence[PlannedClip],  # equal in all processes
    directory: PathLike,
    *,
    processes: Processes,
    rate: float,
    progress: Callable[[int], None] = lambda done: None,
) -> None:
    """Record a plan by all processes at once, each its share; the first one joins the parts when the last has ended.

    `progress` is called with how many wanted frames of its own share a process has recorded. Raises InputError as
    `TeacherWriter`, `record` and `join_parts` do.
    """
    directory = as_path(directory, "directory")
    meet = processes.barrier()
    record_share(teacher, plan, directory, rank=processes.rank, count=processes.count, rate=rate, progress=progress)
    meet()
    if processes.first:
        join_parts(directory, plan)
    meet()


def record_share(
    teacher: Teacher,
    plan: Sequence[PlannedClip],  # the full plan, equal in all processes
    directory: PathLike,  # directory of the joined recording
    *,
    rank: int,  # this process's number, from 0
    count: int,
    rate: float,
    shard_frames: int = 32,
    progress: Callable[[int], None] = lambda done: None,
) -> None:
    """Record one process's share of a plan; nothing where the parts are joined already."""
    directory = as_path(directory, "directory")
    if is_joined(directory):
        return
    parts, reference = divide(plan), cache(lambda: first_texture(teacher, plan))
    done = 0
    for part in share(parts, rank, count):
        before = done

        def hear(own: int, before: int = before) -> None:
            nonlocal done
            done = before + own
            progress(done)

        target = part_directory(directory, part, len(parts))
        record_part(
            teacher, parts[part], target, reference=reference, rate=rate, shard_frames=shard_frames, progress=hear
        )


def record_part(
    teacher: Teacher,
    clips: Sequence[PlannedClip],  # clips of the part
    directory: Path,  # directory of the part
    *,
    reference: Callable[[], Array],  # the texture that all parts refer to; called when a part begins
    rate: float,
    shard_frames: int = 32,
    durable: bool = True,  # not needed where damage by a loss of power is found before a part is taken up again
    progress: Callable[[int], None] = lambda done: None,
) -> None:
    """Record a part, going on where an earlier run stopped."""
    with TeacherWriter(directory, teacher.rig, rate=rate, shard_frames=shard_frames, durable=durable) as own:
        if not own.has_reference:
            own.refer_to(reference())
        record(teacher, clips, own, progress=progress)


def is_joined(directory: Path) -> bool:
    return (directory / HEADER).exists()


def recorded(clips: Sequence[PlannedClip], directory: Path) -> tuple[int, bool]:
    """How many frames of a part are safely stored, and whether that is all of it."""
    indices = read_indices(directory)
    complete = {name for index in indices for name in index.complete}
    return sum(index.frames for index in indices), all(planned.clip.name in complete for planned in clips)


def first_texture(teacher: Teacher, plan: Sequence[PlannedClip]) -> Array:
    """The texture [N, 23] that a single process would record first and use as the reference of all others."""
    for planned in plan:
        if planned.wanted:
            for frame in played(teacher, planned, frozenset({min(planned.wanted)})):
                if isinstance(frame, TeacherFrame):
                    return frame.texture
    raise InputError("plan: no frame of any clip is wanted, expected at least one")


def part_directory(directory: Path, part: int, parts: int) -> Path:
    """The directory of a part, counted from 0."""
    return directory.with_name(f"{directory.name}.part-{part + 1}-of-{parts}")


def remove_leftovers(directory: Path, parts: int) -> None:
    """Remove half-written shards that ended processes left in their parts; they may fill a disk."""
    for part in range(parts):
        for left in (part_directory(directory, part, parts) / SHARDS).glob(".*.part"):
            shutil.rmtree(left, ignore_errors=True)


def join_parts(directory: PathLike, plan: Sequence[PlannedClip]) -> None:
    """Make one recording of all parts of a plan, its clips in the plan's order, and remove the parts.

    A kill leaves the parts or the whole. Raises InputError where a part is missing, unfinished or of another teacher;
    the parts stay as they are.
    """
    directory = as_path(directory, "directory")
    parts = divide(plan)
    sources = [part_directory(directory, part, len(parts)) for part in range(len(parts))]
    if not is_joined(directory):
        _check(sources, parts)
        hidden = directory.with_name(f".{directory.name}.part")
        shutil.rmtree(hidden, ignore_errors=True)
        try:
            _join(sources, hidden)
            hidden.rename(directory)
        except OSError as error:
            shutil.rmtree(hidden, ignore_errors=True)
            raise InputError(f"{directory}: cannot be written ({error.strerror}); all frames are kept") from error
        sync(directory.parent)
    for source in sources:
        shutil.rmtree(source, ignore_errors=True)


def _join(sources: Sequence[Path], target: Path) -> None:
    (target / SHARDS).mkdir(parents=True)
    for name in (HEADER, RIG, REFERENCE):
        shutil.copyfile(sources[0] / name, target / name)
    _join_shards(sources, target)
    for path in (*target.rglob("*"), target):
        sync(path)


def _check(sources: Sequence[Path], plans: Sequence[Sequence[PlannedClip]]) -> None:
    first = None
    for source, own in zip(sources, plans, strict=True):
        header = read_header(source)
        if not (source / REFERENCE).exists():
            raise InputError(f"{source}: holds no {REFERENCE}; record this part to its end")
        reference = (source / REFERENCE).read_bytes()
        first = first or (header, reference)
        if (header, reference) != first:
            raise InputError(f"{source}: comes from another teacher than {sources[0]}, expected parts of one recording")
        complete = {name for index in read_indices(source) for name in index.complete}
        for planned in own:
            if planned.clip.name not in complete:
                raise InputError(f"{source}: clip {planned.clip.name!r} is unfinished; record this part to its end")


def _join_shards(sources: Sequence[Path], target: Path) -> None:
    header = read_header(target)
    total, frames, number = np.zeros((header.valid_texels, CHANNELS)), 0, 0
    for source in sources:
        indices = read_indices(source)
        for old, index in enumerate(indices):
            before, after = source / SHARDS / shard_name(old), target / SHARDS / shard_name(number)
            after.mkdir()
            for path in before.glob("*.npy"):
                if path.name != SUM:
                    _link(path, after / path.name)
            counted = replace(index, training_frames=frames + index.training_frames)
            (after / INDEX).write_bytes(to_json(counted))
            number += 1
        if indices:
            total += open_array(source / SHARDS / shard_name(len(indices) - 1) / SUM, total.shape, "<f8")
            frames += indices[-1].training_frames
    if number:
        _store_sum(target / SHARDS / shard_name(number - 1), counted, total)


def _store_sum(shard: Path, index: Index, total: Array) -> None:
    """Store the sum over all shards in the last one."""
    np.save(shard / SUM, total, allow_pickle=False)
    crc = {**index.crc32, SUM: zlib.crc32((shard / SUM).read_bytes())}
    (shard / INDEX).write_bytes(to_json(replace(index, crc32=crc)))


def _link(source: Path, target: Path) -> None:
    """Link a file under another name, or copy it where the file system has no links."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)
