"""Posing in torch against the reference kernels and finite differences."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
import torch
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.asset.avatar import Avatar
from mua.avatar.decode import Splats, decode_clip_frame
from mua.kernels import dq_skinning as kernel
from mua.kernels.dq_skinning import LARGEST_LOG_SCALE
from mua.splatting.posing import TorchRig, blend_texels, blend_vertices, pose_splats
from mua.splatting.projection import TorchSplats

FRAME = 3
POSED = [field.name for field in fields(TorchSplats) if field.name != "normals"]  # which only culling asks for


@pytest.fixture(scope="module")
def avatar() -> Avatar:
    return synthetic_avatar()


@pytest.fixture(scope="module")
def decoded(avatar: Avatar) -> Splats:
    return decode_clip_frame(avatar, avatar.clips[0], frame=FRAME, dtype=np.float64)


def joints_of(avatar: Avatar) -> torch.Tensor:
    pose = avatar.clips[0].pose(FRAME)
    return torch.tensor(avatar.rig.skeleton.skinning(pose.rotations, pose.translations))


def test_splats_are_those_of_the_reference(avatar: Avatar, decoded: Splats) -> None:
    joints, canonical, texture = joints_of(avatar), torch.tensor(decoded.canonical), torch.tensor(decoded.texture)
    splats = pose_splats(TorchRig.of(avatar.rig, canonical), joints, canonical, texture)
    wanted: dict[str, Any] = {name: getattr(decoded, name, None) for name in POSED}
    wanted["turns"] = decoded.texel_dq[:, :4]
    assert len(decoded.centres) > 10
    for name, values in wanted.items():
        np.testing.assert_allclose(getattr(splats, name).numpy(), values, rtol=1e-7, atol=1e-9, err_msg=name)


def test_opacity_reaches_from_nothing_to_all(avatar: Avatar, decoded: Splats) -> None:
    joints, canonical, texture = joints_of(avatar), torch.tensor(decoded.canonical), torch.tensor(decoded.texture)
    texture[:3, 10] = torch.tensor([-8.0, 0, 8])
    found = pose_splats(TorchRig.of(avatar.rig, canonical), joints, canonical, texture).opacities[:3]
    np.testing.assert_allclose(found, 1 / (1 + np.exp([8, 0, -8])), rtol=1e-12)


def test_all_joints_that_carry_a_vertex_are_taken(avatar: Avatar) -> None:
    rng = np.random.default_rng(5)
    joints = rotation.normalize(rng.normal(size=(8, 8)))
    count = len(avatar.rig.mesh.vertices)
    indices, weights = np.tile(np.arange(8), (count, 1)), np.full((count, 8), 1 / 8)
    taken = TorchRig.of(replace(avatar.rig, skin_indices=indices, skin_weights=weights), torch.tensor(joints))
    found = blend_vertices(taken.skin_indices, taken.skin_weights, torch.tensor(joints))
    np.testing.assert_allclose(found, kernel.blend_vertices(joints, indices, weights), rtol=1e-9, atol=1e-12)


def test_a_scale_is_held_where_players_hold_it(avatar: Avatar, decoded: Splats) -> None:
    joints, canonical, texture = joints_of(avatar), torch.tensor(decoded.canonical), torch.tensor(decoded.texture)
    texture[0, 7:10] = torch.tensor([LARGEST_LOG_SCALE - 1, LARGEST_LOG_SCALE, LARGEST_LOG_SCALE + 1])
    found = pose_splats(TorchRig.of(avatar.rig, canonical), joints, canonical, texture).scales[0]
    np.testing.assert_allclose(found.log(), [LARGEST_LOG_SCALE - 1, LARGEST_LOG_SCALE, LARGEST_LOG_SCALE], rtol=1e-12)


def test_terms_on_the_other_hemisphere_change_nothing(avatar: Avatar, decoded: Splats) -> None:
    joints, canonical, texture = joints_of(avatar), torch.tensor(decoded.canonical), torch.tensor(decoded.texture)
    rig = TorchRig.of(avatar.rig, canonical)
    straight = pose_splats(rig, joints, canonical, texture)
    joints[::2] *= -1
    turned = pose_splats(rig, joints, canonical, texture)
    torch.testing.assert_close(turned.centres, straight.centres, rtol=0, atol=1e-12)


def test_terms_far_apart_are_blended_about_that_of_the_largest_weight(avatar: Avatar) -> None:
    """With rotations all over, the term that sets the signs of the others decides the result, as in the reference."""
    rng = np.random.default_rng(3)
    rig, mesh = avatar.rig, avatar.rig.mesh
    indices = rng.permuted(np.tile(np.arange(len(rig.skeleton.names)), (len(mesh.vertices), 1)), axis=1)
    weights = -np.sort(-rng.dirichlet(np.ones(indices.shape[1]), len(mesh.vertices)), axis=1)
    joints = rotation.normalize(rng.normal(size=(indices.shape[1], 8)))
    own = replace(
        TorchRig.of(rig, torch.tensor(joints)), skin_indices=torch.tensor(indices), skin_weights=torch.tensor(weights)
    )
    vertices = blend_vertices(own.skin_indices, own.skin_weights, torch.tensor(joints))
    expected = kernel.blend_vertices(joints, indices, weights)
    np.testing.assert_allclose(vertices, expected, rtol=1e-9, atol=1e-12)
    texels = kernel.blend_texels(expected, mesh.faces, rig.texels.triangles, rig.texels.barycentrics)
    np.testing.assert_allclose(blend_texels(own, vertices), texels, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("of", [0, 1, 2], ids=["joints", "mesh", "texture"])
def test_gradients_are_those_of_finite_differences(avatar: Avatar, decoded: Splats, of: int) -> None:
    inputs = [joints_of(avatar), torch.tensor(decoded.canonical), torch.tensor(decoded.texture)]
    rig = TorchRig.of(avatar.rig, inputs[1])
    generator = torch.Generator().manual_seed(0)
    weights: dict[str, torch.Tensor] = {}

    def value(tensors: list[torch.Tensor]) -> torch.Tensor:
        splats = pose_splats(rig, *tensors)
        for name in POSED:
            shape = getattr(splats, name).shape
            weights.setdefault(name, torch.randn(shape, generator=generator, dtype=torch.float64))
        return torch.stack([(weights[name] * getattr(splats, name)).sum() for name in POSED]).sum()

    towards = torch.randn(inputs[of].shape, generator=generator, dtype=torch.float64)
    leaves = [tensor.clone().requires_grad_(index == of) for index, tensor in enumerate(inputs)]
    value(leaves).backward()
    gradient = leaves[of].grad
    assert gradient is not None
    ends = []
    for step in (1e-6, -1e-6):
        moved = list(inputs)
        moved[of] = inputs[of] + step * towards
        ends.append(value(moved))
    torch.testing.assert_close((gradient * towards).sum(), (ends[0] - ends[1]) / 2e-6, rtol=1e-6, atol=1e-6)
