"""Far from the training frames, the template deforms as a kernel ridge regression on the pose says."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from scipy.spatial.distance import cdist
from swinging import ENCODING, SETTINGS, surfaces, swinging, trained, tube_rig

from mua.rig.rig import Rig
from mua.teachers.trained import motion_deformation
from mua.teachers.trained.graph_networks import PartFeatures, skin_of_parts
from mua.teachers.trained.motion_deformation import MotionDeformation
from mua.teachers.trained.smooth_deformation import FITTED, NOISE, SmoothDeformation
from mua.teachers.trained.template_training import template_of
from mua.training.kernel_regression import WIDTH
from mua.training.schedule import Schedule

FRAMES = 12
BOUND = 1e-4  # metres: float32 through a decomposition and a solve, on displacements of up to a metre
SHORT = replace(SETTINGS, nodes=Schedule(4, 2, 1e-2), offsets=Schedule(4, 2, 1e-2))


@pytest.fixture(scope="module")
def rig() -> Rig:
    return tube_rig()


def untrained(rig: Rig) -> SmoothDeformation:
    return SmoothDeformation(rig, ENCODING, PartFeatures(rig, ENCODING, features=4, fade=0.5).reach)


def seen(rig: Rig, count: int = FRAMES) -> tuple[torch.Tensor, torch.Tensor]:
    """Descriptors [F, D] and canonical vertices [F, V, 3] of frames in which the tube widens."""
    descriptors = swinging(rig, surfaces(rig)).descriptors[:count]
    wider = torch.linspace(0, 0.3, count)[:, None, None] * torch.tensor([1.0, 0.0, 1.0])
    return descriptors, torch.as_tensor(rig.mesh.vertices).float() * (1 + wider)


def fitted(rig: Rig, descriptors: torch.Tensor, vertices: torch.Tensor) -> SmoothDeformation:
    smooth = untrained(rig)
    for name, tensor in smooth.regress(descriptors, vertices).items():
        setattr(smooth, name, tensor)
    return smooth


def test_frames_keep_the_vertices_that_are_given(rig: Rig) -> None:
    descriptors, vertices = seen(rig)
    given = vertices + 0.1
    torch.testing.assert_close(fitted(rig, descriptors, vertices)(descriptors, given), given, rtol=0, atol=BOUND)


def test_far_from_all_frames_is_their_mean(rig: Rig) -> None:
    descriptors, vertices = seen(rig)
    found = fitted(rig, descriptors, vertices)(descriptors[:1] + 100, vertices[:1] + 0.1)
    torch.testing.assert_close(found[0], vertices.mean(0), rtol=0, atol=BOUND)


def test_another_pose_follows_the_textbooks_regression_part_by_part(rig: Rig) -> None:
    descriptors, vertices = seen(rig)
    new = descriptors[[2, 9]] + torch.tensor([[0.005], [0.1]])
    given = vertices[:2] + 0.1
    found = fitted(rig, descriptors, vertices)(new, given)
    reach = PartFeatures(rig, ENCODING, features=4, fade=0.5).reach.double().numpy()
    poses, asked, targets = (values.double().numpy() for values in (descriptors, new, vertices))
    smooth = np.tile(targets.mean(0), (2, 1, 1))
    for own, share in zip(reach, skin_of_parts(rig, ENCODING).T, strict=True):
        x, at = poses * own, asked * own
        width = WIDTH * 2 * np.square(x - x.mean(0)).sum(1).mean()
        kernel = np.exp(-cdist(x, x, "sqeuclidean") / width) + NOISE * np.eye(len(x))
        weights = np.exp(-cdist(at, x, "sqeuclidean") / width) @ np.linalg.inv(kernel)
        smooth += share[:, None] * np.tensordot(weights, targets - targets.mean(0), 1)
    apart = cdist(poses, poses, "sqeuclidean") + np.diag(np.full(FRAMES, np.inf))
    trust = np.exp(-cdist(asked, poses, "sqeuclidean").min(1) / apart.min(1).mean())
    assert trust[0] > 0.9
    assert trust[1] < 0.1
    assert np.abs(smooth[1] - targets.mean(0)).max() > 10 * BOUND
    expected = smooth + trust[:, None, None] * (given.double().numpy() - smooth)
    np.testing.assert_allclose(found.numpy(), expected, rtol=0, atol=BOUND)


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_frames_are_enough(rig: Rig, count: int) -> None:
    descriptors, vertices = seen(rig, count)
    smooth = fitted(rig, descriptors, vertices)
    torch.testing.assert_close(smooth(descriptors, vertices), vertices, rtol=0, atol=BOUND)
    assert torch.isfinite(smooth(descriptors + 1, vertices)).all()


def test_a_still_person_deforms_as_in_the_mean_frame(rig: Rig) -> None:
    descriptors, vertices = seen(rig)
    smooth = fitted(rig, descriptors[:1].expand(FRAMES, -1), vertices)
    torch.testing.assert_close(smooth(descriptors[:1] + 9, vertices[:1])[0], vertices.mean(0), rtol=0, atol=BOUND)


def test_a_trained_template_deforms_in_distant_poses_as_in_the_mean_frame(rig: Rig, tmp_path: Path) -> None:
    frames = swinging(rig, surfaces(rig))
    template = trained(frames, rig, SHORT, tmp_path)
    known = template.deformation(frames.descriptors)
    assert (known - known.mean(0)).abs().max() > 10 * BOUND
    far = template.deformation(frames.descriptors[:1] + 100)
    torch.testing.assert_close(far[0], known.mean(0), rtol=0, atol=BOUND)


def test_a_long_recording_is_fitted_by_frames_all_along_it(
    rig: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(motion_deformation, "FRAMES", 5)
    frames = swinging(rig, surfaces(rig))
    deformation = trained(frames, rig, SHORT, tmp_path).deformation
    assert isinstance(deformation, MotionDeformation)
    torch.testing.assert_close(deformation.smooth.poses, frames.descriptors[[0, 5, 10, 14, 19]])


def test_a_state_brings_its_frames_along(rig: Rig, tmp_path: Path) -> None:
    frames = swinging(rig, surfaces(rig))
    template = trained(frames, rig, SHORT, tmp_path)
    other = template_of(rig, ENCODING, SHORT)
    other.load_state_dict(template.state_dict())
    asked = frames.descriptors[:3] + 0.2
    assert torch.equal(other.deformation(asked), template.deformation(asked))
    state = template.state_dict()
    del state[f"deformation.smooth.{FITTED[0]}"]
    with pytest.raises(KeyError):
        template_of(rig, ENCODING, SHORT).load_state_dict(state)
