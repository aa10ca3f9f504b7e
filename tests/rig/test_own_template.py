"""docs/examples/own_template.py: arrays in other units and orders become the intended rig."""

import numpy as np
import pytest
from examples import load_example
from tube import swing, tube

from mua import rotation
from mua.avatar.decode import pose_splats
from mua.pose.skeleton import Pose
from mua.rig.build import build_rig
from mua.rig.rig import Rig

EXAMPLE = load_example("own_template")
CHARACTER = tube()
RIG, _ = build_rig(CHARACTER, texels=48)
POSE = swing(CHARACTER).pose(13)


def world(pose: Pose) -> np.ndarray:
    """[J, 4, 4] of the joints, millimetres."""
    turned, placed = RIG.skeleton.world(pose.rotations, pose.translations)
    transforms = np.tile(np.eye(4), (len(turned), 1, 1))
    transforms[:, :3, :3], transforms[:, :3, 3] = rotation.to_matrix(turned), 1000 * placed
    return transforms


def test_a_frame_of_bones_in_the_world_becomes_a_pose() -> None:
    found = EXAMPLE.pose_of(RIG.skeleton.parents, world(POSE))
    np.testing.assert_allclose(found.translations, POSE.translations, atol=1e-12)
    sign = np.sign(np.sum(found.rotations * POSE.rotations, axis=1, keepdims=True))
    np.testing.assert_allclose(found.rotations * sign, POSE.rotations, atol=1e-12)


def test_template_skin_and_skeleton_become_a_rig() -> None:
    mesh = RIG.mesh
    up = np.stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]], axis=1)
    found = EXAMPLE.mesh_of(1000 * mesh.vertices, mesh.faces, up, mesh.uv_faces)
    np.testing.assert_allclose(found.vertices, mesh.vertices, atol=1e-12)
    np.testing.assert_allclose(found.uv, mesh.uv, atol=1e-12)
    dense = np.zeros((len(mesh.vertices), len(RIG.skeleton.names)))
    np.add.at(dense, (np.arange(len(dense))[:, None], RIG.skin_indices), RIG.skin_weights)
    joints, weights = EXAMPLE.skin_of(2 * dense)
    again = np.zeros_like(dense)
    np.add.at(again, (np.arange(len(dense))[:, None], joints), weights)
    np.testing.assert_allclose(again, dense, atol=1e-6)
    bind = EXAMPLE.skeleton_of(list(RIG.skeleton.names), RIG.skeleton.parents, world(RIG.skeleton.bind_pose))
    np.testing.assert_allclose(bind.bind_translations, RIG.skeleton.bind_translations, atol=1e-12)


def test_a_map_indexed_by_u_and_v_up_becomes_ours() -> None:
    texels = RIG.texels
    row, column = np.divmod(texels.texels, texels.size)
    face = np.full((texels.size, texels.size), -1)
    barycentrics = np.zeros((texels.size, texels.size, 3))
    face[column, texels.size - 1 - row] = texels.triangles
    barycentrics[column, texels.size - 1 - row] = texels.barycentrics
    numbers = np.zeros_like(face)
    numbers[column, texels.size - 1 - row] = np.arange(len(row))
    found, order = EXAMPLE.texels_of(face, barycentrics)
    assert np.array_equal(found.texels, texels.texels)
    assert np.array_equal(found.triangles, texels.triangles)
    np.testing.assert_allclose(found.barycentrics, texels.barycentrics, atol=1e-6)
    assert np.array_equal(numbers[np.where(face >= 0)][order], np.arange(len(row)))


@pytest.fixture
def texture() -> np.ndarray:
    rng = np.random.default_rng(0)
    return rng.standard_normal((len(RIG.texels.texels), 23))


def test_posed_splats_are_turned_back_to_canonical_space(texture: np.ndarray) -> None:
    rig: Rig = RIG
    mesh = rig.mesh.vertices
    texture[:, 3:7] = rotation.normalize(texture[:, 3:7])
    posed = texture.copy()
    posed[:, 3:7] = pose_splats(rig, mesh, texture=texture, pose=POSE).rotations
    back = EXAMPLE.canonical(rig, mesh, POSE, posed)
    np.testing.assert_allclose(back[:, :11], texture[:, :11], atol=1e-12)
    before, after = (np.square(sh[:, 3:].reshape(-1, 3, 3)).sum(axis=1) for sh in (posed[:, 11:], back[:, 11:]))
    np.testing.assert_allclose(before, after, rtol=1e-9)  # turned, not scaled
