"""From a recording to a trained student: descriptors of its training frames, then `mua.student.train`."""

from pathlib import Path
from typing import Protocol

import numpy as np
import torch
from torch import Tensor

from mua.arrays import Array
from mua.errors import InputError
from mua.motion.descriptor import choose_joints, describe, normalization
from mua.motion.encoding import PoseEncoding
from mua.recording import Recording
from mua.rig.rig import Rig
from mua.student.checkpoint import Checkpoints, run_key
from mua.student.model import Bands, Student
from mua.student.optimise import Progress
from mua.student.settings import Settings
from mua.student.train import Samples, train


class Listener(Protocol):
    """Hears how far a distillation is."""

    def stage(self, name: str) -> None: ...

    def step(self, done: int, total: int, *, detail: str = "") -> None: ...


def distil(
    recording: Recording,
    settings: Settings,
    *,
    device: torch.device,
    directory: Path,  # of the checkpoints; a run that was killed goes on from them to the same bytes
    report: Listener,
) -> Student:
    """Train a student on the training frames of `recording`; it comes back on the CPU, without gradients.

    Raises InputError where the recording has another texture size than `settings`, or no training frame.
    """
    student, samples = prepare(recording, settings)
    train(
        student,
        samples,
        settings=settings,
        checkpoints=Checkpoints(directory, run_key((settings, recording.fingerprint()), [student.mean, student.scale])),
        device=device,
        report=_Reporter(report),
    )
    return student.cpu()


def prepare(recording: Recording, settings: Settings) -> tuple[Student, Samples]:
    """A student that is not trained yet, its normalisation set, and what it is to be trained on.

    Raises InputError where the recording has another texture size than `settings`, or no training frame.
    """
    size = recording.rig.texels.size
    if size != settings.texels:
        raise InputError(f"recording {recording.directory}: has {size} texels along a side, expected {settings.texels}")
    training = [clip for clip in recording.clips if not clip.held_out]
    if not recording.count():
        raise InputError(f"recording {recording.directory}: holds no training frame, expected at least one")
    skeleton = recording.rig.skeleton
    encoding = PoseEncoding(choose_joints(skeleton, training, moving_joints(recording.rig)), rate=recording.rate)
    descriptors = describe_frames(recording, encoding)
    student = Student(
        settings,
        encoding=encoding,
        vertices=len(recording.rig.mesh.vertices),
        texels=torch.from_numpy(recording.rig.texels.texels),
        wavelet=recording.wavelet,
    )
    normal = normalization(descriptors)
    student.mean.copy_(torch.from_numpy(normal.mean))
    student.scale.copy_(torch.from_numpy(normal.scale))
    return student, _samples(recording, descriptors)


def describe_frames(recording: Recording, encoding: PoseEncoding, *, held_out: bool = False) -> Array:
    """Descriptors [F, k D] of the recorded frames of a kind, in the order of recording."""
    clips = [clip for clip in recording.clips if clip.held_out == held_out and len(clip)]
    skeleton = recording.rig.skeleton
    described = [describe(skeleton, encoding, clip.rotations, clip.translation)[clip.recorded] for clip in clips]
    return np.concatenate([np.zeros((0, encoding.width)), *described])


def moving_joints(rig: Rig) -> Array:
    """Which joints [J] move the mesh themselves or through a descendant."""
    moving = np.zeros(len(rig.skeleton.names), dtype=bool)
    moving[np.unique(rig.skin_indices[rig.skin_weights > 0])] = True
    for joint in range(len(moving) - 1, -1, -1):  # parents come before children
        if moving[joint] and rig.skeleton.parents[joint] >= 0:
            moving[rig.skeleton.parents[joint]] = True
    return moving


def _samples(recording: Recording, descriptors: Array) -> Samples:
    def subbands(channels: slice, rows: Tensor) -> Bands:
        return Bands(*recording.subbands(channels, rows))

    return Samples(
        descriptors=torch.from_numpy(descriptors).float(),
        meshes=torch.from_numpy(recording.meshes(np.arange(recording.count()))),
        subbands=subbands,
        mean_texture=torch.from_numpy(recording.mean_texture()).float(),
    )


class _Reporter:
    """Tells a listener of the stages and steps of a training."""

    def __init__(self, listener: Listener) -> None:
        self._listener = listener
        self._stage = ""

    def __call__(self, progress: Progress) -> None:
        if progress.stage != self._stage:
            self._stage = progress.stage
            self._listener.stage(progress.stage)
        loss = "" if progress.loss is None else f"loss {progress.loss:.4f}, "
        self._listener.step(progress.step, progress.steps, detail=f"{loss}{progress.rate:.1f} steps/s")
