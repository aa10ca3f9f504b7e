"""Our own system among the compared ones is the student that the package trains."""

from copy import deepcopy
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch
from compared_systems import trained

from mua.asset import count
from mua.channels import APPEARANCE, GEOMETRY
from mua.student.export import export_branches, export_coarse
from mua.student.model import Student
from mua.student.shapes import wavelet_of
from mua_research.bands import BandNetwork, Convolutions, Lines, scale_branch, start_convolutions, texture_encoding
from mua_research.network import NetworkSystem
from mua_research.system import Budget, TrainingFrames


def test_ours_equals_the_student_that_the_package_trains(smooth_frames: TrainingFrames) -> None:
    system = trained("ours", smooth_frames, Budget(steps=2))
    student = as_student(system, smooth_frames)
    geometry, appearance = (branch.split(branch.mlp(smooth_frames.motion.inputs)) for branch in student.branches)
    expected = student.texture(student.synthesize((geometry, appearance)))
    bound = 100 * torch.finfo(torch.float).eps * float(expected.abs().max())
    torch.testing.assert_close(system.textures(smooth_frames.motion), expected, rtol=0, atol=bound)


def test_ours_costs_what_its_file_says(smooth_frames: TrainingFrames) -> None:
    system = trained("ours", smooth_frames, Budget(steps=1))
    student = as_student(system, smooth_frames)
    geometry, appearance = export_branches(student)
    wavelet = wavelet_of(student.wavelet)
    avatar: Any = SimpleNamespace(
        components=SimpleNamespace(directions=np.zeros((0, 0)), margins=()),  # all systems read the same
        coarse=export_coarse(student.coarse),
        geometry=geometry,
        appearance=appearance,
        wavelet=wavelet,
    )
    assert system.parameters == sum(count.parameters(avatar).values())
    assert system.flops == sum(count.flops(avatar).values())


def test_texture_coordinates_are_told_by_waves_of_the_texels_middles() -> None:
    middles = (np.arange(4) + 0.5) / 4
    angles = np.pi * 2.0 ** np.arange(6)[:, None] * middles
    waves = np.concatenate([np.sin(angles), np.cos(angles)])
    found = texture_encoding(4).numpy()
    np.testing.assert_allclose(found[:12], np.repeat(waves[:, :, None], 4, axis=2), atol=1e-4)
    np.testing.assert_allclose(found[12:], np.repeat(waves[:, None], 4, axis=1), atol=1e-4)


def test_what_does_not_vary_along_an_axis_is_pooled_to_itself(smooth_frames: TrainingFrames) -> None:
    torch.manual_seed(0)
    lines = Lines(8, smooth_frames.sizes)
    lines.encoding.zero_()
    with torch.no_grad():
        for axis, along in ((0, (1, 1, 8, 1)), (1, (1, 1, 1, 8))):
            lines.pool.zero_()
            maps = torch.randn(along).expand(1, 6, 8, 8)
            even = lines(maps)
            lines.pool[axis].normal_()
            torch.testing.assert_close(lines(maps), even)


def test_convolutions_start_from_he_and_their_decoders_from_nothing(smooth_frames: TrainingFrames) -> None:
    network = Convolutions(5, smooth_frames.sizes)
    start_convolutions(network, torch.Generator().manual_seed(0))
    for layer in network.features[::2]:  # type: ignore[attr-defined]
        assert isinstance(layer, torch.nn.Conv2d)
        drawn = layer.weight.detach()
        assert float(drawn.std()) == pytest.approx((2 / drawn[0].numel()) ** 0.5, rel=0.1)
    assert not any(tensor.any() for tensor in network.decode.state_dict().values())


def as_student(system: NetworkSystem, frames: TrainingFrames) -> Student:
    """The trained network's bases in raw channels about the training mean, in the student of the package."""
    assert isinstance(system.network, BandNetwork)
    student = deepcopy(frames.student)
    parts = (GEOMETRY, APPEARANCE)
    for branch, trained_branch, part in zip(student.branches, system.network.branches, parts, strict=True):
        branch.load_state_dict(trained_branch.state_dict())
        scale_branch(branch, 1 / frames.weights[part])
        mean = frames.mean.of(part)
        branch.ll_mean.copy_(mean.ll[0])
        branch.d3.mean.copy_(mean.d3[0])
        branch.d2.mean.copy_(mean.d2[0])
    student.static.copy_(frames.mean_texture.T - student.mean_lowpass())
    return student.requires_grad_(False)
