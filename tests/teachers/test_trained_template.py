"""The drivable template poses as the reference kernels do, with gradients to what moves it."""

import numpy as np
import pytest
import torch
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.asset.avatar import Avatar
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.descriptor import describe
from mua.teachers.trained.drivable_template import DrivableTemplate

# Two blends and a transform of some 30 operations each on lengths of up to 3 metres.
BOUND = {torch.float32: 90 * 3 * float(np.finfo(np.float32).eps), torch.float64: 90 * 3 * np.finfo(np.float64).eps}


@pytest.fixture(scope="module")
def avatar() -> Avatar:
    return synthetic_avatar()


def inputs(avatar: Avatar) -> tuple[torch.Tensor, torch.Tensor]:
    """Descriptors [F, D] and joints [F, J, 8] float64 of a clip."""
    clip, skeleton = avatar.clips[0], avatar.rig.skeleton
    descriptors = describe(skeleton, avatar.encoding, clip.rotations, clip.translations)
    return torch.tensor(descriptors), torch.tensor(skeleton.skinning(clip.rotations, clip.translations))


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_without_a_deformation_it_is_the_skinned_rig(avatar: Avatar, dtype: torch.dtype) -> None:
    descriptors, joints = inputs(avatar)
    rig = avatar.rig
    found = DrivableTemplate(rig)(descriptors.to(dtype), joints.to(dtype))
    assert found.canonical.shape == found.posed.shape == (len(descriptors), len(rig.mesh.vertices), 3)
    for frame, own in enumerate(joints.numpy()):
        duals = blend_vertices(own, rig.skin_indices, rig.skin_weights)
        posed = rotation.dual_transform(duals, rig.mesh.vertices)
        np.testing.assert_allclose(found.vertex_dq[frame], duals, rtol=0, atol=BOUND[dtype])
        np.testing.assert_allclose(found.posed[frame], posed, rtol=0, atol=BOUND[dtype])
    np.testing.assert_allclose(found.canonical[0], rig.mesh.vertices, rtol=0, atol=BOUND[dtype])


def test_a_deformation_moves_the_canonical_vertices(avatar: Avatar) -> None:
    descriptors, joints = inputs(avatar)
    shift = torch.tensor([0.01, -0.02, 0.03], dtype=torch.float64)
    rest = torch.tensor(avatar.rig.mesh.vertices)

    class Shift(torch.nn.Module):
        def forward(self, descriptors: torch.Tensor) -> torch.Tensor:
            return (rest + shift).expand(len(descriptors), -1, -1)

    plain, moved = (DrivableTemplate(avatar.rig, own)(descriptors, joints) for own in (None, Shift()))
    assert torch.allclose(moved.canonical - plain.canonical, shift.expand_as(plain.canonical), atol=1e-12)
    apart = (moved.posed - plain.posed).norm(dim=-1)
    assert torch.allclose(apart, shift.norm().to(apart).expand_as(apart), atol=1e-12)


def test_gradients_reach_the_joints(avatar: Avatar) -> None:
    descriptors, joints = inputs(avatar)
    template = DrivableTemplate(avatar.rig).double()
    generator = torch.Generator().manual_seed(3)
    weights, towards = (
        torch.randn(shape, generator=generator, dtype=torch.float64)
        for shape in ((2, len(avatar.rig.mesh.vertices), 3), (2, *joints.shape[1:]))
    )

    def value(of: torch.Tensor) -> torch.Tensor:
        return (weights * template(descriptors[:2], of).posed).sum()

    leaf = joints[:2].clone().requires_grad_()
    value(leaf).backward()
    assert leaf.grad is not None
    difference = (value(joints[:2] + 1e-6 * towards) - value(joints[:2] - 1e-6 * towards)) / 2e-6
    torch.testing.assert_close((leaf.grad * towards).sum(), difference, rtol=1e-6, atol=1e-6)
