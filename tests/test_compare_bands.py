"""Our own system among the compared ones is the student that the package trains."""

from copy import deepcopy
from types import SimpleNamespace
from typing import Any

import torch
from compared import trained

from mua.asset import count
from mua.channels import APPEARANCE, GEOMETRY
from mua.compare.bands import BandNetwork, scale_branch
from mua.compare.network import NetworkSystem
from mua.compare.system import Budget, TrainingFrames
from mua.student.export import export_branches, export_coarse, export_wavelet
from mua.student.model import Student


def test_ours_equals_the_student_that_the_package_trains(smooth_frames: TrainingFrames) -> None:
    system = trained("ours", smooth_frames, Budget(steps=2))
    student = as_student(system, smooth_frames)
    expected = student.texture(student.predict(smooth_frames.motion.descriptors))
    bound = 100 * torch.finfo(torch.float).eps * float(expected.abs().max())
    torch.testing.assert_close(system.textures(smooth_frames.motion), expected, rtol=0, atol=bound)


def test_ours_costs_what_its_file_says(smooth_frames: TrainingFrames) -> None:
    system = trained("ours", smooth_frames, Budget(steps=1))
    student = as_student(system, smooth_frames)
    geometry, appearance = export_branches(student)
    wavelet = export_wavelet(student)
    avatar: Any = SimpleNamespace(
        coarse=export_coarse(student.coarse), geometry=geometry, appearance=appearance, wavelet=wavelet
    )
    assert system.parameters == sum(count.parameters(avatar).values())
    assert system.flops == sum(count.flops(avatar).values())


def as_student(system: NetworkSystem, frames: TrainingFrames) -> Student:
    """The trained network's bases in raw channels about the training mean, in the student of the package."""
    assert isinstance(system.network, BandNetwork)
    student = deepcopy(frames.student)
    parts = (GEOMETRY, APPEARANCE)
    for branch, learnt, part in zip(student.branches, system.network.branches, parts, strict=True):
        branch.load_state_dict(learnt.state_dict())
        scale_branch(branch, 1 / frames.weights[part])
        mean = frames.mean.of(part)
        branch.ll_mean.copy_(mean.ll[0])
        branch.d3.mean.copy_(mean.d3[0])
        branch.d2.mean.copy_(mean.d2[0])
    student.static.copy_(frames.mean_texture.T - student.mean_lowpass())
    return student.requires_grad_(False)
