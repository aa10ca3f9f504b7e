"""Skinning against OpenUSD's, activations against scipy, the packed splat against numpy's own half floats."""

from typing import Any

import numpy as np
import pytest
from dispatch import run
from pxr import Gf, UsdSkel, Vt
from scipy.spatial.transform import Rotation
from scipy.special import expit
from skinned_cases import BLEND_BOUND, JOINTS, ULP, random_influences, random_joints

from mua import rotation
from mua.arrays import Array
from mua.gpu import Device
from mua.kernels.dq_skinning import (
    blend_texels,
    blend_vertices,
    covariances,
    skin_splats,
)

COUNTS = [0, 1, 7, 101]
REACH = 2.0  # metres; no point or translation in these tests lies farther out
BLEND_OPERATIONS = 64  # roundings on the way of one coordinate: 8 terms of 3, a norm, two products, two sums


def position_bound(dtype: Any) -> float:
    return float(BLEND_OPERATIONS * np.finfo(dtype).eps * REACH)


FILE = "dq_skinning.compute"
GROUP = 64  # threads
GPU_COUNTS = [0, 1, GROUP - 1, GROUP, GROUP + 1, 4099, 300_007]


def usd_skinned(joints: Array, indices: Array, weights: Array, points: Array) -> Array:
    """Points moved by UsdSkel's dual quaternion skinning."""
    matrices = np.tile(np.eye(4), (len(joints), 1, 1))
    matrices[:, :3, :3] = rotation.to_matrix(joints[:, :4])
    matrices[:, :3, 3] = rotation.dual_translation(joints)
    transforms = Vt.Matrix4dArray([Gf.Matrix4d(*m.T.ravel().tolist()) for m in matrices])  # row vectors
    pairs = np.stack([indices, weights], axis=-1).reshape(-1, 2).astype(np.float32)
    influences = Vt.Vec2fArray.FromNumpy(pairs)
    skinned = Vt.Vec3fArray.FromNumpy(points.astype(np.float32))
    UsdSkel.SkinPoints("dualQuaternion", Gf.Matrix4d(1), transforms, influences, indices.shape[1], skinned)
    return np.array(skinned)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", COUNTS[1:])
def test_vertices_move_as_in_usd(count: int, dtype: Any) -> None:
    rng = np.random.default_rng(count)
    joints = random_joints(rng)
    indices, weights = random_influences(rng, count)
    points = rng.uniform(-1, 1, (count, 3))
    vertex_dq = blend_vertices(joints.astype(dtype), indices, weights)
    moved = rotation.dual_transform(vertex_dq, points.astype(dtype))
    assert vertex_dq.dtype == dtype
    np.testing.assert_allclose(
        moved, usd_skinned(joints, indices, weights, points), rtol=0, atol=2 * position_bound(np.float32)
    )


def test_a_joint_and_its_negative_blend_alike() -> None:
    rng = np.random.default_rng(3)
    joints = random_joints(rng)
    indices, weights = random_influences(rng, 50)
    points = rng.uniform(-1, 1, (50, 3))
    negated = joints * rng.choice([-1.0, 1.0], (JOINTS, 1))
    moved = [rotation.dual_transform(blend_vertices(j, indices, weights), points) for j in (joints, negated)]
    np.testing.assert_allclose(moved[0], moved[1], rtol=0, atol=position_bound(np.float64))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", COUNTS)
def test_texels_blend_their_three_vertices_as_usd_would(count: int, dtype: Any) -> None:
    rng = np.random.default_rng(count)
    vertex_dq = random_joints(rng, 6) * rng.choice([-1.0, 1.0], (6, 1))
    faces = np.array([[0, 1, 2], [2, 3, 4], [5, 3, 1]], np.int32)
    triangles = rng.integers(0, 3, count, dtype=np.int32)
    barycentrics = rng.dirichlet([1, 1, 1], count).reshape(count, 3).astype(np.float32)
    points = rng.uniform(-1, 1, (count, 3))
    texel_dq = blend_texels(vertex_dq.astype(dtype), faces, triangles, barycentrics)
    assert texel_dq.shape == (count, 8)
    assert texel_dq.dtype == dtype
    if count:
        moved = rotation.dual_transform(texel_dq, points.astype(dtype))
        expected = usd_skinned(vertex_dq, faces[triangles], barycentrics, points)
        np.testing.assert_allclose(moved, expected, rtol=0, atol=2 * position_bound(np.float32))


def test_the_largest_barycentric_decides_on_the_signs_of_a_texel() -> None:
    """Corners turned by 0, 100 and 200 degrees: beside the middle one both others lie nearer than half a turn."""
    angles = np.radians([0.0, 100, 200])
    turns = rotation.from_axis_angle(np.array([0.0, 1, 0]), angles)
    vertex_dq = rotation.dual_from_rigid(turns, np.zeros((3, 3)))
    for order in ([0, 1, 2], [1, 0, 2], [0, 2, 1]):
        faces, weights = np.array([order], np.int32), np.array([[0.25, 0.5, 0.25][i] for i in order])
        (found,) = blend_texels(vertex_dq, faces, np.zeros(1, np.int32), weights[None])
        middle = turns[1] if found[0] * turns[1, 0] > 0 else -turns[1]
        np.testing.assert_allclose(found[:4], middle, rtol=0, atol=8 * np.finfo(float).eps)


def test_the_real_part_is_unit() -> None:
    rng = np.random.default_rng(4)
    vertex_dq = blend_vertices(random_joints(rng), *random_influences(rng, 30))
    np.testing.assert_allclose(np.linalg.norm(vertex_dq[:, :4], axis=1), 1, rtol=4 * np.finfo(float).eps)


def test_rotations_that_cancel_stay_finite() -> None:
    opposite = np.array([[1.0, 0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, 0]], np.float32)
    indices, weights = np.ones((1, 8), np.int32), np.full((1, 8), 0.125, np.float32)
    assert np.isfinite(blend_vertices(opposite, indices, weights)).all()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", COUNTS)
def test_splats_are_activated_then_posed(count: int, dtype: Any) -> None:
    rng = np.random.default_rng(count)
    texel_dq = random_joints(rng, count).astype(dtype)
    mesh = rng.uniform(-0.5, 0.5, (4, 3)).astype(dtype)
    faces = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    triangles = rng.integers(0, 2, count, dtype=np.int32)
    barycentrics = rng.dirichlet([1, 1, 1], count).reshape(count, 3).astype(np.float32)
    texture = rng.normal(size=(count, 23)).astype(dtype)
    texture[:, 0:3] *= 0.05
    texture[:, 10] *= 50  # far beyond where exp(-x) of a float32 overflows
    centres, rotations, scales, opacities = skin_splats(texel_dq, mesh, faces, triangles, barycentrics, texture)
    assert {a.dtype for a in (centres, rotations, scales, opacities)} == {np.dtype(dtype)}
    eps = float(np.finfo(dtype).eps)
    np.testing.assert_allclose(scales, np.exp(texture[:, 7:10].astype(float)), rtol=16 * eps)
    np.testing.assert_allclose(opacities, expit(texture[:, 10].astype(float)), rtol=0, atol=4 * eps)
    if count == 0:
        return
    turn = Rotation.from_quat(texel_dq[:, :4].astype(float), scalar_first=True)
    own = Rotation.from_quat(texture[:, 3:7].astype(float), scalar_first=True)
    canonical = np.einsum("nk,nkx->nx", barycentrics, mesh[faces[triangles]].astype(float)) + texture[:, 0:3]
    moved = turn.apply(canonical) + rotation.dual_translation(texel_dq.astype(float))
    np.testing.assert_allclose(centres, moved, rtol=0, atol=position_bound(dtype))
    np.testing.assert_allclose(
        rotation.to_matrix(rotations.astype(float)), (turn * own).as_matrix(), rtol=0, atol=32 * eps
    )


def test_scales_are_held_where_their_exponential_would_be_infinite() -> None:
    texture = np.zeros((1, 23), np.float32)
    texture[:, 3], texture[:, 7:10] = 1, [1000, 10, -1000]
    places = np.zeros((1, 3), np.float32), np.zeros((1, 3), np.int32), np.zeros(1, np.int32)
    still = np.eye(1, 8, dtype=np.float32)
    scales = skin_splats(still, *places, np.full((1, 3), 1 / 3, np.float32), texture)[2]
    np.testing.assert_allclose(scales, [[np.exp(10), np.exp(10), 0]], rtol=4 * ULP)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", COUNTS)
def test_covariance_is_the_squared_axes(count: int, dtype: Any) -> None:
    rng = np.random.default_rng(count)
    rotations = rotation.normalize(rng.normal(size=(count, 4))).astype(dtype)
    scales = np.exp(rng.uniform(-9, -3, (count, 3))).astype(dtype)
    found = covariances(rotations, scales)
    assert found.shape == (count, 6)
    assert found.dtype == dtype
    if count:
        axes = Rotation.from_quat(rotations.astype(float), scalar_first=True).as_matrix()
        expected = np.einsum("nij,nj,nkj->nik", axes, scales.astype(float) ** 2, axes)[:, *np.triu_indices(3)]
        bound = 32 * float(np.finfo(dtype).eps) * scales.max(axis=1, keepdims=True) ** 2
        assert np.all(np.abs(found - expected) <= bound)


def blend_on(device: Device, joints: Array, indices: Array, weights: Array, count: int | None = None) -> Array:
    """[V, 8] from BlendVertices, of the first `count` vertices where it is given; the rest stays NaN."""
    vertices = len(indices)
    buffers = {
        "joints": joints.astype(np.float32),
        "indices": indices.astype(np.uint32),
        "weights": weights,
        "vertex_dq": np.full((vertices, 8), np.nan, np.float32),
    }
    groups = (-(-vertices // GROUP), 1, 1)
    blended = vertices if count is None else count
    return run(device, FILE, "BlendVertices", groups, buffers, vertex_count=blended)["vertex_dq"]


@pytest.mark.parametrize("influences", [1, JOINTS, 8])
@pytest.mark.parametrize("count", GPU_COUNTS)
def test_hlsl_blends_vertices_as_the_reference(device: Device, count: int, influences: int) -> None:
    rng = np.random.default_rng(count)
    joints = (random_joints(rng, 8) * rng.choice([-1.0, 1.0], (8, 1))).astype(np.float32)
    indices, weights = random_influences(rng, count, influences)
    found = blend_on(device, joints, indices, weights)
    expected = blend_vertices(joints.astype(float), indices, weights)
    np.testing.assert_allclose(found, expected, rtol=0, atol=BLEND_BOUND)


def test_hlsl_adds_what_is_turned_half_round_as_it_stands(device: Device) -> None:
    """It lies neither across from the reference nor beside it."""
    joints = np.zeros((2, 8), np.float32)
    joints[0, 0] = joints[1, 1] = 1
    indices, weights = np.zeros((1, 8), np.int32), np.zeros((1, 8), np.float32)
    indices[0, 1], weights[0, :2] = 1, 0.5
    expected = np.array([[1, 1, 0, 0, 0, 0, 0, 0]]) / np.sqrt(2)
    np.testing.assert_allclose(blend_vertices(joints, indices, weights), expected, rtol=0, atol=BLEND_BOUND)
    np.testing.assert_allclose(blend_on(device, joints, indices, weights), expected, rtol=0, atol=BLEND_BOUND)


def test_hlsl_leaves_what_lies_behind_the_last_vertex(device: Device) -> None:
    rng = np.random.default_rng(5)
    indices, weights = random_influences(rng, GROUP)
    found = blend_on(device, random_joints(rng), indices, weights, count=GROUP - 3)
    np.testing.assert_array_equal(np.isnan(found).all(axis=1), np.arange(GROUP) >= GROUP - 3)


def test_hlsl_keeps_rotations_that_cancel_finite(device: Device) -> None:
    joints = np.zeros((2, 8), np.float32)
    joints[:, 4:] = 0.5
    indices, weights = np.zeros((6, 8), np.int32), np.full((6, 8), 0.125, np.float32)
    vertex_dq = blend_on(device, joints, indices, weights)
    assert np.isfinite(vertex_dq).all()


def test_an_influence_after_an_empty_one_counts_on_both(device: Device) -> None:
    """Files are refused where a weight is larger than the one before; the blend itself takes them in any order."""
    rng = np.random.default_rng(8)
    joints = random_joints(rng).astype(np.float32)
    indices = np.tile(np.arange(8) % JOINTS, (3, 1))
    weights = np.zeros((3, 8), np.float32)
    weights[:, [0, 3]] = 0.25, 0.75
    expected = blend_vertices(joints, indices[:, [0, 3] * 4], weights[:, [0, 3, 1, 1, 1, 1, 1, 1]])
    np.testing.assert_array_equal(blend_vertices(joints, indices, weights), expected)
    np.testing.assert_allclose(blend_on(device, joints, indices, weights), expected, rtol=0, atol=BLEND_BOUND)
