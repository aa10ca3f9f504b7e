"""Recording a teacher of this package: the loop between `Teacher` and `TeacherWriter`."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.recording.writer import TeacherWriter
from mua.teacher import Teacher, TeacherFrame


@dataclass(frozen=True)
class PlannedClip:
    """The frames to record of one clip."""

    clip: Clip
    held_out: bool
    wanted: frozenset[int]  # frames with mesh and texture; of all others the pose alone is recorded
    whole: frozenset[int] | None = None  # frames of `wanted` kept whole; None: every n-th, by the writer's setting
    run_up: Clip | None = None  # poses before it, played but not recorded, so that cloth is in motion when it begins


def record(
    teacher: Teacher,
    plan: Sequence[PlannedClip],
    writer: TeacherWriter,
    *,
    progress: Callable[[int], None] = lambda done: None,
) -> None:
    """Record the planned frames of all clips, going on where an earlier run of the same plan stopped.

    A teacher depends on its history, so a half recorded clip is played again from its start and only what is not yet
    stored is added. `progress` is called with how many of all wanted frames are recorded, earlier runs included.
    Raises InputError for a clip at another rate, or one that was recorded by another plan.
    """
    for planned in plan:
        _check(planned, writer)
    done = sum(len(writer.recorded(planned.clip.name)) for planned in plan)
    progress(done)
    for planned in plan:
        name = planned.clip.name
        if writer.is_complete(name):
            continue
        writer.start_clip(name, held_out=planned.held_out)
        stored = writer.next_frame(name)
        wanted = frozenset(index for index in planned.wanted if index >= stored)
        for index, frame in enumerate(played(teacher, planned, wanted)):
            if index < stored:
                continue
            if isinstance(frame, TeacherFrame):
                whole = None if planned.whole is None else index in planned.whole
                writer.add(frame.pose, frame.mesh, frame.texture, whole=whole)
                done += 1
                progress(done)
            else:
                writer.add(frame)
    writer.finish()


def played(teacher: Teacher, planned: PlannedClip, wanted: frozenset[int]) -> Iterator[TeacherFrame | Pose]:
    """All frames of a clip; the teacher plays it no further than to the last that is `wanted`, after its run-up."""
    clip, run_up = planned.clip, planned.run_up
    until = max(wanted, default=-1) + 1
    if until:
        part, before = clip.cut(slice(until)), 0 if run_up is None else len(run_up)
        with_run_up = part if run_up is None else replace(run_up, name=clip.name).then(part)
        frames = teacher.frames(with_run_up, frozenset(index + before for index in wanted))
        yield from islice(frames, before, None)
    yield from (clip.pose(index) for index in range(until, len(clip)))


def _check(planned: PlannedClip, writer: TeacherWriter) -> None:
    clip = planned.clip
    if clip.rate != writer.rate:
        raise InputError(f"clip {clip.name!r}: rate is {clip.rate} frames per second, expected {writer.rate}")
    stored = writer.next_frame(clip.name)
    if set(writer.recorded(clip.name)) != {index for index in planned.wanted if index < stored}:
        raise InputError(f"recording {writer.directory}: clip {clip.name!r} holds other frames than are wanted now")
