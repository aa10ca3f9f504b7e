"""Invisible variation gets no blendshape, and no weight grows over it."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from silent import Silent
from synthetic_student import random_student
from tube import swing, tube

from mua.arrays import Array
from mua.channels import ATTRIBUTES
from mua.recording import Recording, TeacherWriter
from mua.rig.build import build_rig
from mua.student.distil import distil
from mua.student.export import export_branches
from mua.student.model import Student
from mua.student.negligible import LEVEL_GAINS, drop_negligible
from mua.student.settings import PRESETS
from mua.training.schedule import Schedule

TEXELS = 128
QUICK = replace(
    PRESETS["tiny"],
    texels=TEXELS,
    sweeps=2,
    regression=Schedule(steps=200, batch=64, lr=3e-3),
    finetune=Schedule(steps=40, batch=16, lr=5e-4),
    pictures=2,
)
COLOUR = slice(11, 14)  # the constant term of the spherical harmonics


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """A tube that swings, its geometry constant, its colour brightening and darkening from one side to the other."""
    directory = tmp_path_factory.mktemp("recorded") / "tube"
    character = tube()
    rig, _ = build_rig(character, texels=TEXELS)
    clip = swing(character, frames=60)
    texture, change = constant(rig.texels.texels), (rig.texels.texels % TEXELS)[:, None] / TEXELS * [1.0, 0.5, 0.2]
    with TeacherWriter(directory, rig, rate=clip.rate) as writer:
        writer.start_clip(clip.name)
        for index in range(len(clip)):
            texture[:, COLOUR] = 0.3 * np.sin(4 * index / clip.rate) * change
            writer.add(clip.pose(index), rig.mesh.vertices, texture)
    return Recording(directory)


def constant(texels: Array) -> Array:
    """Splats of 4 mm that hide what is behind, without colour, [N, 23]."""
    texture = np.zeros((len(texels), 23), np.float32)
    texture[:, ATTRIBUTES["rotation"].start] = 1
    texture[:, ATTRIBUTES["scale"]] = np.log(0.004)
    texture[:, ATTRIBUTES["opacity"]] = 4
    return texture


@pytest.fixture(scope="module")
def student(recorded: Recording, tmp_path_factory: pytest.TempPathFactory) -> Student:
    settings = replace(QUICK, frames=recorded.count())
    directory = tmp_path_factory.mktemp("checkpoints")
    return distil(recorded, settings, device=torch.device("cpu"), directory=directory, report=Silent())


def test_low_dimensional_colour_leaves_weights_that_a_file_can_hold(student: Student) -> None:
    """Coefficients vary by one; weights that grow over blendshapes of rounding reached millions."""
    largest = [max(np.abs(layer.weight).max() for layer in branch.mlp) for branch in export_branches(student)]
    assert len(largest) == 2
    assert max(largest) < 10


def test_blendshapes_of_rounding_are_left_out(student: Student) -> None:
    """The change has one dimension, so that each channel keeps one blendshape of LL."""
    shapes = student.appearance.ll_basis.abs().amax((2, 3)) > 0
    assert shapes.sum(1).tolist() == [1, 1, 1, *[0] * 9]
    assert not student.geometry.ll_basis.any()


def test_a_colour_that_changes_keeps_its_blendshapes(recorded: Recording, student: Student) -> None:
    band = torch.as_tensor(recorded.subbands(slice(0, 23), range(recorded.count())).ll[:, COLOUR])
    shapes = student.appearance.ll_basis[:3]
    assert float(shapes.square().sum()) == pytest.approx(float(band.var(0, correction=0).sum()), rel=0.05)


@pytest.mark.parametrize("level", [0, 1, 2])
@pytest.mark.parametrize(("factor", "kept"), [(0.9, False), (1.1, True)])
def test_a_blendshape_is_kept_if_some_texel_of_some_frame_shows_it(level: int, factor: float, kept: bool) -> None:
    branch = random_student().geometry
    frames = torch.zeros(3, branch.channels * branch.ranks.total)
    frames[1] = -2.0
    least = torch.linspace(0.1, 1.0, branch.channels)
    peak = factor * LEVEL_GAINS[level] * least[4] / 2
    basis = branch.ll_basis if level == 0 else (branch.d3, branch.d2)[level - 1].h
    with torch.no_grad():
        if level == 0:
            basis[4, 2] *= peak / basis[4, 2].abs().max()
        else:
            detail = (branch.d3, branch.d2)[level - 1]
            detail.h[:, 4, 2] = peak
            detail.w[:, 4, 2] = torch.nn.functional.one_hot(torch.tensor(1), detail.w.shape[-1]).float()
    drop_negligible(branch, frames, least)
    shape = basis[4, 2] if level == 0 else basis[:, 4, 2]
    assert bool(shape.any()) == kept
    assert bool(branch.split(frames)[level][1, 4, 2] != 0) == kept
