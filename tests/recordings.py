"""A small recording for tests, of a teacher that is a formula."""

from collections.abc import Callable, Container, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_rig

from mua.arrays import Array
from mua.channels import ATTRIBUTES
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.recording import PlannedClip, TeacherWriter, record
from mua.rig.rig import Rig
from mua.teachers.teacher import TeacherFrame

RATE = 24.0


class FormulaTeacher:
    """A teacher whose every number follows from clip and frame, so that any run yields the same."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.computed: list[tuple[str, int]] = []
        rng = np.random.default_rng(5)
        valid, vertices = len(rig.texels.texels), len(rig.mesh.vertices)
        self._base = rng.standard_normal((valid, 23)).astype(np.float32)
        self._base[:, ATTRIBUTES["offset"]] *= 0.02  # metres
        self._base[:, ATTRIBUTES["scale"]] -= 6
        self._change = 0.1 * rng.standard_normal((valid, 23)).astype(np.float32)
        self._sway = 0.1 * rng.standard_normal((vertices, 3)).astype(np.float32)

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        for index in range(len(clip)):
            yield self.frame(clip, index) if index in wanted else clip.pose(index)

    def frame(self, clip: Clip, index: int) -> TeacherFrame:
        self.computed.append((clip.name, index))
        phase = np.float32(np.sin(index + len(clip.name)))
        texture = self._base + phase * self._change
        if index % 2:
            texture[::3, ATTRIBUTES["rotation"]] *= -1
        mesh = self.rig.mesh.vertices.astype(np.float32) + phase * self._sway
        return TeacherFrame(clip.pose(index), mesh, texture)


def clip(rig: Rig, name: str, frames: int) -> Clip:
    rng = np.random.default_rng(frames)
    rotations = rng.standard_normal((frames, len(rig.skeleton.names), 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    return Clip(name, RATE, rotations, rng.standard_normal((frames, len(rig.skeleton.names), 3)))


def plan(rig: Rig) -> list[PlannedClip]:
    return [
        PlannedClip(clip(rig, "walk", 23), held_out=False, wanted=frozenset(range(0, 23, 2))),
        PlannedClip(clip(rig, "turn", 5), held_out=True, wanted=frozenset({1, 4}), whole=frozenset({4})),
        PlannedClip(clip(rig, "reach", 11), held_out=False, wanted=frozenset(range(11)), whole=frozenset({2, 3})),
    ]


def frames(count: int, *, name: str = "walk") -> list[TeacherFrame]:
    """The first frames of a clip."""
    rig = synthetic_rig()
    teacher, played = FormulaTeacher(rig), clip(rig, name, count)
    return [teacher.frame(played, index) for index in range(count)]


def opened(directory: Path, **options: Any) -> TeacherWriter:
    """A writer of frames of the synthetic rig."""
    return TeacherWriter(directory, synthetic_rig(), **{"rate": RATE, **options})


def add(writer: TeacherWriter, *frames: TeacherFrame, name: str = "walk") -> None:
    """Begin a clip with some frames."""
    writer.start_clip(name)
    for frame in frames:
        writer.add(frame.pose, frame.mesh, frame.texture)


def write(directory: Path, *, whole_every: int = 5) -> FormulaTeacher:
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)
    with TeacherWriter(directory, rig, rate=RATE, shard_frames=4, whole_every=whole_every) as writer:
        record(teacher, plan(rig), writer)
    return teacher


def aligned(texture: Array, reference: Array) -> Array:
    texture = texture.copy()
    for texel in range(len(texture)):
        if texture[texel, 3:7] @ reference[texel, 3:7] < 0:
            texture[texel, 3:7] *= -1
    return texture


def truth(*, held_out: bool) -> list[TeacherFrame]:
    """The recorded frames in order, rotations aligned to the first of all."""
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)
    reference = teacher.frame(plan(rig)[0].clip, 0).texture
    frames = [
        teacher.frame(planned.clip, index)
        for planned in plan(rig)
        for index in sorted(planned.wanted)
        if planned.held_out == held_out
    ]
    return [replace(frame, texture=aligned(frame.texture, reference)) for frame in frames]


def content(directory: Path) -> dict[str, bytes]:
    return {str(p.relative_to(directory)): p.read_bytes() for p in sorted(directory.rglob("*")) if p.is_file()}


class Killed(BaseException):
    """Stands for the death of the process."""


class Dying:
    """Calls that change the disk, of which one is the last: the process dies before it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *places: tuple[object, str]) -> None:
        self.budget = 0  # calls to that one; 0 lives on
        for owner, name in places:
            monkeypatch.setattr(owner, name, self._counted(getattr(owner, name)))

    def _counted(self, call: Callable[..., Any]) -> Callable[..., Any]:
        def step(*args: Any, **kwargs: Any) -> Any:
            self.budget -= 1
            if self.budget == 0:
                raise Killed
            return call(*args, **kwargs)

        return step
