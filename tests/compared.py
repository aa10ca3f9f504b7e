"""A teacher that every compared system can learn, and the training of one."""

from collections.abc import Container, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from synthetic_avatar import synthetic_clip, synthetic_rig

from mua.channels import ATTRIBUTES
from mua.compare.motion import training_frames
from mua.compare.network import Forgetful, NetworkSystem
from mua.compare.system import Budget, TrainingFrames
from mua.compare.systems import SYSTEMS
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.recording import PlannedClip, Recording, TeacherWriter, record
from mua.rig.rig import Rig
from mua.student.optimise import Progress, Run
from mua.student.settings import Ranks, Schedule, Settings
from mua.teachers.teacher import TeacherFrame

SETTINGS = Settings(
    texels=32,
    frames=40,
    geometry=Ranks(4, 3, 3),
    appearance=Ranks(4, 3, 3),
    components=4,
    hidden=24,
    sweeps=3,
    regression=Schedule(steps=120, batch=64, lr=1e-2),
    finetune=Schedule(steps=10, batch=16, lr=1e-4),
)
TRAINING, HELD_OUT = 40, 9
LEARNT = 0.5  # of the variance, at the least, within STEPS
STEPS = 30


class SmoothTeacher:
    """A teacher whose texture follows the bend of two joints, smoothly over the texture."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        row, column = np.divmod(rig.texels.texels, rig.texels.size)
        u, v = (row + 0.5) / rig.texels.size, (column + 0.5) / rig.texels.size
        rng = np.random.default_rng(3)
        waves = np.stack([np.ones_like(u), np.sin(6 * u), np.cos(5 * v), np.sin(4 * u + 7 * v)], axis=1)
        self._shapes = [(waves @ rng.standard_normal((4, 23))).astype(np.float32) for _ in range(3)]

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        for index in range(len(clip)):
            yield self.frame(clip, index) if index in wanted else clip.pose(index)

    def frame(self, clip: Clip, index: int) -> TeacherFrame:
        base, *moving = self._shapes
        bends = clip.rotations[index, 1:3, 1:].sum(axis=-1).astype(np.float32)
        texture = base + sum(0.2 * bend * shape for bend, shape in zip(bends, moving, strict=True))
        texture[:, ATTRIBUTES["offset"]] *= 0.05  # metres
        texture[:, 3] += 8  # all rotations in one hemisphere
        texture[:, ATTRIBUTES["scale"]] -= 6
        mesh = self.rig.mesh.vertices.astype(np.float32) * (1 + 0.05 * bends[0])
        return TeacherFrame(clip.pose(index), mesh, texture)


def smooth_recording(directory: Path) -> Recording:
    rig = synthetic_rig()
    clips = [
        replace(synthetic_clip(rig.skeleton, np.random.default_rng(8), frames=length), name=name)
        for name, length in (("walk", TRAINING), ("turn", HELD_OUT))
    ]
    plan = [PlannedClip(clip, held_out=clip.name == "turn", wanted=frozenset(range(len(clip)))) for clip in clips]
    with TeacherWriter(directory, rig, rate=24.0, shard_frames=16, whole_every=5) as writer:
        record(SmoothTeacher(rig), plan, writer)
    return Recording(directory)


def smooth_frames(recording: Recording) -> TrainingFrames:
    run = Run(torch.Generator().manual_seed(0), Forgetful(Path(), ""), lambda _: None, torch.device("cpu"))
    return training_frames(recording, SETTINGS, run=run)


def trained(name: str, frames: TrainingFrames, budget: Budget, report: list[Progress] | None = None) -> NetworkSystem:
    system = SYSTEMS[name](frames.sizes)
    told = report.append if report is not None else lambda _: None
    system.fit(frames, budget, torch.Generator().manual_seed(1), told)
    assert isinstance(system, NetworkSystem)
    return system


def explained(system: NetworkSystem, frames: TrainingFrames) -> float:
    """Share of the weighted variance of the training textures."""
    truth = frames.deviations(torch.arange(len(frames)))
    found = (system.textures(frames.motion) - frames.mean_texture).transpose(1, 2) * frames.weights[:, None]
    return 1 - float((found - truth).square().sum() / truth.square().sum())


def few(frames: TrainingFrames) -> TrainingFrames:
    """The same frames, regressed for a few steps only."""
    schedule = replace(SETTINGS.regression, steps=3)
    return replace(frames, sizes=replace(frames.sizes, settings=replace(SETTINGS, regression=schedule)))
