"""Frames of the user's motion shape a student more than those of the built-in range of motion do."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch
from synthetic_student import FRAMES, SETTINGS, bands_of_frames, quick, samples, train_in, valid_texels

from mua.channels import APPEARANCE, GEOMETRY
from mua.student.distil import RANGE_WEIGHT
from mua.student.model import lowpass_texels
from mua.student.settings import Generalisation
from mua.student.stages import Samples
from mua.training.schedule import Schedule
from mua.wavelets import Bands

OWN = torch.arange(FRAMES) < 40  # the frames of the user's motion
UNTUNED = replace(SETTINGS, finetune=Schedule(steps=1, batch=1, lr=1e-12))
TUNED = replace(SETTINGS, finetune=Schedule(steps=40, batch=16, lr=3e-3))
STATIC = 0.25  # of all channels
FLOAT32 = torch.finfo(torch.float32).eps


def by_frame(values: torch.Tensor, frames: torch.Tensor) -> torch.Tensor:
    return values.view(-1, *[1] * (frames.ndim - 1)) * frames


def conflicting() -> tuple[torch.Tensor, Bands, torch.Tensor]:
    """Descriptors, subbands and meshes; beyond the user's motion all is the opposite of what it would be in it."""
    descriptors, bands = bands_of_frames()
    meshes, sign = samples().meshes(torch.arange(FRAMES)), torch.where(OWN, 1.0, -1.0)
    mean = meshes.mean(0)
    return descriptors, Bands(*(by_frame(sign, band) for band in bands)), mean + by_frame(sign, meshes - mean)


def data(weight: float | None = None) -> Samples:
    """Samples in which frames that are not the user's have a weight; None: all are taken for the user's."""
    _, bands, meshes = conflicting()
    mean = Bands(*(band[OWN].mean(0, keepdim=True) for band in bands))
    return replace(
        samples(),
        subbands=lambda channels, rows: Bands(*(band[rows] for band in bands.of(channels))),
        meshes=lambda rows: meshes[rows],
        mean_texture=lowpass_texels(mean, "bior4.4", valid_texels())[0].T + STATIC,
        weights=None if weight is None else torch.where(OWN, 1.0, weight),
    )


Missed = dict[str, float]


@pytest.fixture(scope="module")
def missed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Missed]:
    """The share of the user's frames that students miss: of geometry, appearance and mesh."""
    descriptors, bands, meshes = conflicting()
    range_alone = replace(UNTUNED, generalisation=Generalisation(own=False))
    trained = {
        "weighted": (UNTUNED, 1e-6),
        "tuned": (TUNED, 1e-6),
        "alike": (UNTUNED, None),
        "none": (range_alone, None),
    }
    found: dict[str, Missed] = {}
    for name, (settings, weight) in trained.items():
        student = train_in(tmp_path_factory.mktemp(name), settings, data=data(weight))
        predicted = student.predict(descriptors[OWN])
        parts = {"geometry": GEOMETRY, "appearance": APPEARANCE}
        found[name] = {part: _missed(predicted.of(own).ll, bands.of(own).ll[OWN]) for part, own in parts.items()}
        found[name]["mesh"] = _missed(student.mesh(descriptors[OWN]), meshes[OWN])
    return found


def _missed(found: torch.Tensor, truth: torch.Tensor) -> float:
    return float((found - truth).square().sum() / (truth - truth.mean(0)).square().sum())


@pytest.mark.parametrize("part", ["geometry", "appearance", "mesh"])
def test_the_users_frames_are_followed_where_others_count_little(missed: dict[str, Missed], part: str) -> None:
    assert missed["weighted"][part] < 0.5 * missed["alike"][part]


@pytest.mark.parametrize("part", ["geometry", "appearance"])
def test_fine_tuning_draws_the_users_frames(missed: dict[str, Missed], part: str) -> None:
    assert missed["tuned"][part] < 0.7 * missed["weighted"][part]


def test_shape_follows_the_range_of_motion_roughly_where_that_is_all_there_is(missed: dict[str, Missed]) -> None:
    """It swings more than any motion of the user's; light follows from the pose."""
    assert missed["none"]["geometry"] > 1.5 * missed["alike"]["geometry"]
    assert missed["none"]["mesh"] > 3 * missed["alike"]["mesh"]
    assert missed["none"]["appearance"] < 1.2 * missed["alike"]["appearance"]


def test_means_are_of_all_frames_by_their_weight_and_the_static_texture_completes_the_users(tmp_path: Path) -> None:
    student, (_, bands, meshes) = train_in(tmp_path, quick(), data=data(RANGE_WEIGHT)), conflicting()
    shares = torch.where(OWN, 1.0, RANGE_WEIGHT) / (OWN.sum() + RANGE_WEIGHT * (~OWN).sum())
    means = torch.cat([branch.ll_mean for branch in student.branches])
    torch.testing.assert_close(means, torch.einsum("f,fcij->cij", shares, bands.ll), rtol=0, atol=100 * FLOAT32)
    torch.testing.assert_close(
        student.coarse.mean, torch.einsum("f,fva->va", shares, meshes), rtol=0, atol=100 * FLOAT32
    )
    torch.testing.assert_close(student.static, torch.full_like(student.static, STATIC), rtol=0, atol=100 * FLOAT32)
