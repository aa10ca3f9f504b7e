"""One recording by several processes: each records some of the clips as a part, and the parts are joined.

A part is a recording like any other, in a directory beside the final one. All parts store differences from the same
texture, so that joining is no more than listing the shards one after the other and adding up the sums.
"""

import os
import shutil
import zlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.errors import InputError
from mua.processes import Processes
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
from mua.recording.record import PlannedClip, record
from mua.recording.shard import sync
from mua.recording.writer import TeacherWriter
from mua.teachers.teacher import Teacher, TeacherFrame
from mua.texture.channels import CHANNELS


def divide(plan: Sequence[PlannedClip], parts: int) -> list[list[PlannedClip]]:
    """Split a plan into consecutive runs of clips of about as many frames each; with few clips some are empty."""
    lengths = np.array([len(planned.clip) for planned in plan])
    middles = np.cumsum(lengths) - lengths / 2
    owners = (middles * parts / max(lengths.sum(), 1)).astype(int).clip(max=parts - 1)
    return [[planned for planned, owner in zip(plan, owners, strict=True) if owner == part] for part in range(parts)]


def record_together(
    teacher: Teacher,
    plan: Sequence[PlannedClip],  # the same in all processes
    directory: Path,
    *,
    processes: Processes,
    rate: float,
    progress: Callable[[int], None] = lambda done: None,
) -> None:
    """Record a plan by all processes at once, each its part; the first one joins them when the last has ended.

    `progress` hears how many wanted frames of its own part a process has recorded. Raises InputError as
    `TeacherWriter`, `record` and `join_parts` do.
    """
    meet = processes.meeting()
    record_part(teacher, plan, directory, part=processes.rank, parts=processes.count, rate=rate, progress=progress)
    meet()
    if processes.first:
        join_parts(directory, plan, parts=processes.count)
    meet()


def record_part(
    teacher: Teacher,
    plan: Sequence[PlannedClip],  # the whole of it, the same in all processes
    directory: Path,  # of the joined recording
    *,
    part: int,  # which one this process records, from 0
    parts: int,
    rate: float,
    shard_frames: int = 32,
    progress: Callable[[int], None] = lambda done: None,
) -> None:
    """Record one part of a plan, going on where an earlier run stopped; nothing where the parts are joined already."""
    if (directory / HEADER).exists():
        return
    with TeacherWriter(
        part_directory(directory, part, parts), teacher.rig, rate=rate, shard_frames=shard_frames
    ) as own:
        if not own.has_reference:
            own.refer_to(first_texture(teacher, plan))
        record(teacher, divide(plan, parts)[part], own, progress=progress)


def first_texture(teacher: Teacher, plan: Sequence[PlannedClip]) -> Array:
    """The texture [N, 23] that a single process would record first, hence refer all others to."""
    for planned in plan:
        if planned.wanted:
            for frame in teacher.frames(planned.clip, frozenset({min(planned.wanted)})):
                if isinstance(frame, TeacherFrame):
                    return frame.texture
    raise InputError("plan: no frame of any clip is wanted, expected at least one")


def part_directory(directory: Path, part: int, parts: int) -> Path:
    return directory.with_name(f"{directory.name}.part-{part + 1}-of-{parts}")


def join_parts(directory: Path, plan: Sequence[PlannedClip], *, parts: int) -> None:
    """Make one recording of all parts of a plan, its clips in the plan's order, and remove the parts.

    A kill leaves the parts or the whole. Raises InputError where a part is missing, unfinished or of another teacher;
    the parts stay as they are.
    """
    sources = [part_directory(directory, part, parts) for part in range(parts)]
    if not (directory / HEADER).exists():
        _check(sources, divide(plan, parts))
        hidden = directory.with_name(f".{directory.name}.part")
        shutil.rmtree(hidden, ignore_errors=True)
        (hidden / SHARDS).mkdir(parents=True)
        for name in (HEADER, RIG, REFERENCE):
            shutil.copyfile(sources[0] / name, hidden / name)
        _join_shards(sources, hidden)
        for path in (*hidden.rglob("*"), hidden):
            sync(path)
        hidden.rename(directory)
        sync(directory.parent)
    for source in sources:
        shutil.rmtree(source, ignore_errors=True)


def _check(sources: Sequence[Path], plans: Sequence[Sequence[PlannedClip]]) -> None:
    first = None
    for source, own in zip(sources, plans, strict=True):
        header = read_header(source)
        if not (source / REFERENCE).exists():
            raise InputError(f"{source}: holds no {REFERENCE}; record this part to its end")
        reference = (source / REFERENCE).read_bytes()
        first = first or (header, reference)
        if (header, reference) != first:
            raise InputError(f"{source}: is of another teacher than {sources[0]}, expected parts of one recording")
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
    """The last shard holds the sum over all of them."""
    np.save(shard / SUM, total, allow_pickle=False)
    crc = {**index.crc32, SUM: zlib.crc32((shard / SUM).read_bytes())}
    (shard / INDEX).write_bytes(to_json(replace(index, crc32=crc)))


def _link(source: Path, target: Path) -> None:
    """The same file under another name; a copy where the file system has no links."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)
