"""Distils a recording into a student: descriptors of its training frames, then `mua.student.stages`."""

import math
import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from threading import Lock
from typing import Protocol

import numpy as np
import torch
from torch import Tensor

from mua.arrays import Array
from mua.errors import InputError
from mua.pose.clip import is_range, is_rest
from mua.pose.components import principal_components
from mua.pose.descriptor import choose_joints, choose_translated, describe, groups_of, normalization, turns_of, units_of
from mua.pose.encoding import PoseEncoding
from mua.recording import Recording
from mua.rig.bones import figure_scale
from mua.rig.skinning import moving_joints
from mua.student.finetune import HUE
from mua.student.local import body_parts
from mua.student.model import Student
from mua.student.sensitivity import measure_sensitivities
from mua.student.settings import Settings, StageName
from mua.student.shapes import Body
from mua.student.stages import Samples, stages, train
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress
from mua.training.processes import ALONE, Processes

RANGE_WEIGHT = 0.03  # weight of a frame of the built-in range of motion: bases are primarily for the user's motion
REST_WEIGHT = 0.3  # of the pose in which the file stands: one frame, but the one in which a character is first seen
GPU_SECONDS = 1.0  # seconds between queries of the GPU


class StageListener(Protocol):
    """Progress callbacks of a distillation."""

    def stage(self, name: str) -> None:
        """A stage begins, or continues: two may take turns."""

    def step(self, done: int, total: int, *, detail: str = "") -> None: ...


def distil(
    recording: Recording,
    settings: Settings,
    *,
    device: torch.device,
    directory: Path,  # directory of the checkpoints; a killed run goes on from them to the same bytes
    report: StageListener,
    processes: Processes = ALONE,  # the processes that share the work
    only: StageName | None = None,  # run this stage up to its checkpoints; the student is then unfinished
) -> Student:
    """Distil the training frames of `recording` into a student, returned on the CPU without gradients.

    Raises InputError where the recording has another texture size than `settings`, or no training frame, and where a
    stage alone starts from checkpoints that are not in `directory`.
    """
    student, samples = prepare(recording, settings)
    counted = () if samples.weights is None else (samples.weights,)
    rules = (settings, recording.fingerprint(), len(student.components), HUE)
    key = run_key(rules, [student.mean, student.scale, *counted])
    checkpoints = Checkpoints(directory, key)
    if processes.first:
        checkpoints.remove_leftovers(name for names in stages(settings).values() for name in names)
    train(
        student,
        samples,
        settings=settings,
        checkpoints=checkpoints,
        device=device,
        report=_Reporter(report, device),
        only=only,
        processes=processes,
    )
    return student.cpu()


def prepare(recording: Recording, settings: Settings) -> tuple[Student, Samples]:
    """An untrained student with its components set, and the samples to distil.

    Raises InputError where the recording has another texture size than `settings`, or no training frame.
    """
    size = recording.rig.texels.size
    if size != settings.texels:
        raise InputError(f"recording {recording.directory}: has {size} texels along a side, expected {settings.texels}")
    if not recording.count():
        raise InputError(f"recording {recording.directory}: holds no training frame, expected at least one")
    encoding = encoding_of(recording, settings)
    descriptors = describe_frames(recording, encoding)
    units = units_of(encoding, figure_scale(recording.rig.mesh.vertices))
    scaled = normalization(descriptors, units, turns_of(encoding))
    components = principal_components(descriptors, scaled, units, groups_of(encoding))
    student = Student(
        settings,
        encoding=encoding,
        inputs=len(components.margins),
        vertices=len(recording.rig.mesh.vertices),
        texels=torch.from_numpy(recording.rig.texels.texels),
        wavelet=recording.wavelet,
    )
    student.set_components(components)
    parts = body_parts(recording.rig, encoding) if settings.generalisation.fade < 1 else None
    measure = partial(measure_sensitivities, recording, settings.pictures) if settings.pictures else None
    return student, replace(_samples(recording, descriptors), parts=parts, sensitivities=measure)


def encoding_of(recording: Recording, settings: Settings) -> PoseEncoding:
    """The form of the descriptor, which follows from the joints that training frames move."""
    training = [clip for clip in recording.clips if not clip.held_out]
    skeleton, used = recording.rig.skeleton, moving_joints(recording.rig)
    return PoseEncoding(
        choose_joints(skeleton, training, used),
        rate=recording.rate,
        remove_heading=settings.generalisation.remove_heading,
        translated=choose_translated(skeleton, training, used),
    )


def body_of(recording: Recording, settings: Settings) -> Body:
    """What the cost of a student of `recording` follows from, with as many components of the pose as there can be."""
    width, rig = encoding_of(recording, settings).width, recording.rig
    return Body(width, width, len(rig.mesh.vertices), len(rig.texels.texels), recording.wavelet)


def describe_frames(recording: Recording, encoding: PoseEncoding, *, held_out: bool = False) -> Array:
    """Descriptors [F, D] of the recorded frames of a kind, in the order of recording."""
    clips = [clip for clip in recording.clips if clip.held_out == held_out and len(clip)]
    skeleton = recording.rig.skeleton
    described = [describe(skeleton, encoding, clip.rotations, clip.translations)[clip.recorded] for clip in clips]
    return np.concatenate([np.zeros((0, encoding.width)), *described])


def _samples(recording: Recording, descriptors: Array) -> Samples:
    return Samples(
        descriptors=torch.from_numpy(descriptors).float(),
        meshes=lambda rows: torch.from_numpy(recording.meshes(rows)),
        subbands=recording.subbands,
        mean_texture=torch.from_numpy(recording.mean_texture()).float(),
        weights=_weights(recording),
    )


def _weights(recording: Recording) -> Tensor | None:
    """The weight of each training frame, lower for the built-in range of motion; None where there is none."""
    clips = [clip for clip in recording.clips if not clip.held_out]
    counts = np.concatenate([np.full(len(clip.recorded), _weight(clip.name)) for clip in clips])
    return torch.from_numpy(counts).float() if (counts == 1).any() and (counts < 1).any() else None


def _weight(name: str) -> float:
    if is_rest(name):
        return REST_WEIGHT
    return RANGE_WEIGHT if is_range(name) else 1.0


class _Reporter:
    """Reports to a listener the stages and steps of trainings, also side by side, and how busy the GPU is."""

    def __init__(self, listener: StageListener, device: torch.device) -> None:
        self._listener, self._device = listener, device
        self._stage, self._one = "", Lock()
        self._use, self._asked = "", -math.inf

    def __call__(self, progress: Progress) -> None:
        loss = "" if progress.loss is None else f"loss {progress.loss:.4f}, "
        with self._one:
            if progress.stage != self._stage:
                self._stage = progress.stage
                self._listener.stage(progress.stage)
            self._listener.step(progress.step, progress.steps, detail=f"{loss}{progress.rate:.1f} steps/s{self._gpu()}")

    def _gpu(self) -> str:
        """How busy the GPU was at the last query; a query takes longer than a step."""
        if time.monotonic() - self._asked >= GPU_SECONDS:
            self._use, self._asked = gpu_use(self._device), time.monotonic()
        return self._use


def gpu_use(device: torch.device) -> str:
    """The driver's figures of the GPU in use, to append to other figures; empty on a CPU."""
    if device.type != "cuda":
        return ""
    taken = f"{torch.cuda.memory_allocated(device) / 1e9:.1f} GB"
    try:
        return f", GPU {torch.cuda.utilization(device)} %, {taken}"
    except (ImportError, RuntimeError):  # without nvidia-ml-py, or where the driver does not report it
        return f", GPU {taken}"
