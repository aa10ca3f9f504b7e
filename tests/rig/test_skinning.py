"""Skinning component by component against the reference of the kernels."""

import numpy as np
import pytest

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.rig.skinning import Skinning, transform

ROUNDING = 64 * float(np.finfo(np.float64).eps)  # some ten products of up to 2 m, added up


def rig(vertices: int, *, seed: int) -> tuple[Array, Array, Array]:
    """Joints of any sign and turn, and weights as characters have them: largest first, padded with zeros."""
    rng = np.random.default_rng(seed)
    joints = rotation.dual_from_rigid(rotation.normalize(rng.normal(size=(7, 4))), rng.normal(size=(7, 3)))
    weights = -np.sort(-rng.uniform(size=(vertices, 8)) * (rng.uniform(size=(vertices, 8)) < 0.4), axis=1)
    weights[:, 0] += 0.1
    weights /= weights.sum(axis=1, keepdims=True)
    return joints, rng.integers(0, 7, (vertices, 8)), weights


@pytest.mark.parametrize("vertices", [1, 97])
def test_blends_as_the_reference_does(vertices: int) -> None:
    joints, indices, weights = rig(vertices, seed=vertices)
    expected = blend_vertices(joints, indices, weights)
    np.testing.assert_allclose(Skinning(indices, weights)(joints), expected, atol=ROUNDING)


def test_blends_anew_for_every_pose() -> None:
    joints, indices, weights = rig(31, seed=3)
    skinning = Skinning(indices, weights)
    skinning(joints)
    joints[::2] *= -1  # the same transforms, the other way round
    np.testing.assert_allclose(skinning(joints), blend_vertices(joints, indices, weights), atol=ROUNDING)


def test_moves_points_as_the_reference_does() -> None:
    joints, indices, weights = rig(97, seed=5)
    dual = Skinning(indices, weights)(joints)
    points = np.random.default_rng(6).normal(size=(97, 3))
    np.testing.assert_allclose(
        transform(dual, points), rotation.dual_transform(dual, points), rtol=1e-12, atol=ROUNDING
    )


def test_the_linear_blend_is_the_weighted_mean_of_what_each_joint_makes() -> None:
    joints, indices, weights = rig(97, seed=7)
    points = np.random.default_rng(8).normal(size=(97, 3))
    expected = sum(
        weight[:, None] * rotation.dual_transform(joints[joint], points)
        for joint, weight in zip(indices.T, weights.T, strict=True)
    )
    skinning = Skinning(indices, weights)
    np.testing.assert_allclose(skinning.linear(joints, points), expected, atol=ROUNDING)
    joints[::2] *= -1  # the same transforms, the other way round
    np.testing.assert_allclose(skinning.linear(joints, points), expected, atol=ROUNDING)


def test_both_blends_agree_where_one_joint_carries_a_vertex() -> None:
    joints, indices, _ = rig(31, seed=9)
    skinning = Skinning(indices, np.eye(8)[np.zeros(31, int)])
    points = np.random.default_rng(10).normal(size=(31, 3))
    np.testing.assert_allclose(
        skinning.linear(joints, points), transform(skinning(joints), points), rtol=1e-12, atol=ROUNDING
    )
