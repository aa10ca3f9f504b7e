"""Skinning against OpenUSD's, activations against scipy, the packed splat against numpy's own half floats."""

from dataclasses import dataclass

import numpy as np
import pytest
from packed_splats import LARGEST_HALF, assert_halves, unpacked
from pxr import Gf, UsdSkel, Vt
from scipy.spatial.transform import Rotation
from scipy.special import expit

from mua import rotation
from mua.arrays import Array
from mua.gpu import Device, run
from mua.kernels.dq_skinning import (
    METRES2_TO_MM2,
    blend_texels,
    blend_vertices,
    covariances,
    pack_splats,
    skin_splats,
)
from mua.kernels.inverse_dwt import pack_channels

COUNTS = [0, 1, 7, 101]
JOINTS = 5
REACH = 2.0  # metres; no point or translation in these tests lies farther out
BLEND_OPERATIONS = 64  # roundings on the way of one coordinate: 8 terms of 3, a norm, two products, two sums


def position_bound(dtype: type) -> float:
    return float(BLEND_OPERATIONS * np.finfo(dtype).eps * REACH)


FILE = "dq_skinning.compute"
GROUP = 64  # threads
GPU_COUNTS = [0, 1, GROUP - 1, GROUP, GROUP + 1, 4099, 300_007]
FACES = np.array([[0, 1, 2], [2, 3, 4], [5, 3, 1]], np.int32)

# Bounds of float32 on a GPU, whose arithmetic is as Vulkan asks: sums and products half a unit in the last place (an
# ulp, eps of the largest term), division 2.5 ulp, square roots 4.5, exp 3 + 2 |x|.
ULP = float(np.finfo(np.float32).eps)
# A blend: a product and a sum for each term, in it and in its norm; the norm's own 4 products, 4 sums and root; a
# division. The rotations lie within pi / 4 of none, so that the sum's norm is at least cos(pi / 8).
NORM_AND_DIVISION = 4 + 4.5 + 2.5
BLEND_BOUND = (2 * 8 + NORM_AND_DIVISION) / np.cos(np.pi / 8) * ULP
TEXEL_BOUND = (2 * 3 + NORM_AND_DIVISION) / np.cos(np.pi / 8) * ULP
# A centre: four components off by TEXEL_BOUND make a quaternion off by twice that. A turn doubles it on a canonical
# point within 1.5 m; a translation 2 d q* takes it from both parts, d at most 0.9. The products and sums of the point
# (6), the turn (12) and the translation (8) are half an ulp each of at most 1.5 + 1.8 m.
CENTRE_BOUND = 2 * 2 * TEXEL_BOUND * (1.5 + 1 + 0.9) + 13 * ULP * (1.5 + 1.8)
# A logistic: the error of exp, at most 3 ulp of 1 at x = 0, counts in numerator and denominator; a sum, a division.
OPACITY_BOUND = (2 * 3 + 0.5 + 2.5) * ULP
# A covariance, relative to the largest variance: exp(-12..0), squared; the rotation's matrix (9 products and sums) is
# quadratic in the product (4 ulp) of the blend and the texel's own quaternion (9 ulp), and counts twice.
COVARIANCE_BOUND = 2 * (3 + 2 * 12 + 1) * ULP + 2 * 4 * (TEXEL_BOUND + 13 * ULP) + 2 * 9 * ULP


def random_joints(rng: np.random.Generator, count: int = JOINTS) -> Array:
    """Rigid transforms [count, 8] within a quarter turn of each other, so that every blend is well-conditioned."""
    axes = rotation.normalize(rng.normal(size=(count, 3)))
    turns = rotation.from_axis_angle(axes, rng.uniform(0, np.pi / 4, count))
    return rotation.dual_from_rigid(turns, rng.uniform(-1, 1, (count, 3)))


def random_influences(rng: np.random.Generator, points: int, joints: int = JOINTS) -> tuple[Array, Array]:
    """Indices and weights [points, 8], largest first, those beyond the number of joints empty."""
    indices, weights = np.zeros((points, 8), np.int32), np.zeros((points, 8), np.float32)
    weights[:, :joints] = -np.sort(-rng.dirichlet(np.ones(joints), points), axis=1)
    indices[:, :joints] = np.argsort(rng.random((points, joints)), axis=1)
    return indices, weights


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
def test_vertices_move_as_in_usd(count: int, dtype: type) -> None:
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
def test_texels_blend_their_three_vertices_as_usd_would(count: int, dtype: type) -> None:
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
def test_splats_are_activated_then_posed(count: int, dtype: type) -> None:
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
    eps = np.finfo(dtype).eps
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


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", COUNTS)
def test_covariance_is_the_squared_axes(count: int, dtype: type) -> None:
    rng = np.random.default_rng(count)
    rotations = rotation.normalize(rng.normal(size=(count, 4))).astype(dtype)
    scales = np.exp(rng.uniform(-9, -3, (count, 3))).astype(dtype)
    found = covariances(rotations, scales)
    assert found.shape == (count, 6)
    assert found.dtype == dtype
    if count:
        axes = Rotation.from_quat(rotations.astype(float), scalar_first=True).as_matrix()
        expected = np.einsum("nij,nj,nkj->nik", axes, scales.astype(float) ** 2, axes)[:, *np.triu_indices(3)]
        bound = 32 * np.finfo(dtype).eps * scales.max(axis=1, keepdims=True) ** 2
        assert np.all(np.abs(found - expected) <= bound)


@pytest.mark.parametrize("count", COUNTS)
def test_packed_splat_holds_floats_and_half_floats_in_64_bytes(count: int) -> None:
    rng = np.random.default_rng(count)
    centres, texel_dq = rng.normal(size=(count, 3)), random_joints(rng, count)
    covariance, sh = 1e-6 * rng.normal(size=(count, 6)), rng.normal(size=(count, 12))
    opacities = rng.random(count)
    packed = pack_splats(centres, covariance, opacities, texel_dq, sh)
    assert packed.dtype == np.uint32
    assert packed.shape == (count, 16)
    fields = unpacked(packed)
    np.testing.assert_array_equal(fields["centre"], centres.astype(np.float32))
    np.testing.assert_array_equal(fields["covariance"], (covariance * METRES2_TO_MM2).astype(np.float16))
    np.testing.assert_array_equal(fields["turn"], texel_dq[:, :4].astype(np.float16))
    np.testing.assert_array_equal(fields["sh"], sh.astype(np.float16))
    np.testing.assert_array_equal(fields["opacity"], opacities.astype(np.float32))


def test_what_half_floats_cannot_hold_is_held_at_the_largest() -> None:
    covariance, sh = np.array([[0.25, -0.25, 0, 1, 0, 1]]), np.full((1, 12), 1e9)
    fields = unpacked(pack_splats(np.zeros((1, 3)), covariance, np.ones(1), np.zeros((1, 8)), sh))
    np.testing.assert_array_equal(fields["covariance"][0], LARGEST_HALF * np.array([1, -1, 0, 1, 0, 1]))
    np.testing.assert_array_equal(fields["sh"], np.full((1, 12), LARGEST_HALF))


@dataclass(frozen=True)
class Texels:
    """Texels over FACES, as buffers hold them: the texture in half floats."""

    triangles: Array  # [N]
    barycentrics: Array  # [N, 3]
    texture: Array  # [N, 23] raw channels


def random_texels(rng: np.random.Generator, count: int) -> Texels:
    """Log scales from -12 to 0, opacity logits to +-100, a texel in eight without a rotation, some on an edge."""
    first = rng.dirichlet([1, 1, 1], count).reshape(count, 3).astype(np.float32)[:, :2]
    first[::5] = 0.5
    third = np.maximum(np.float32(1) - first[:, :1] - first[:, 1:], 0)
    texture = rng.normal(size=(count, 23))
    texture[:, 0:3] *= 0.05
    texture[::8, 3:7] = 0
    texture[:, 7:10] = rng.uniform(-12, 0, (count, 3))
    texture[:, 10] = rng.uniform(-100, 100, count)
    triangles = rng.integers(0, len(FACES), count)
    return Texels(triangles, np.concatenate([first, third], axis=1), texture.astype(np.float16).astype(np.float32))


def blend_on(device: Device, joints: Array, indices: Array, weights: Array) -> Array:
    """[V, 8] from BlendVertices."""
    vertices = len(indices)
    buffers = {
        "joints": joints.astype(np.float32),
        "indices": indices.astype(np.uint32),
        "weights": weights,
        "vertex_dq": np.full((vertices, 8), np.nan, np.float32),
    }
    groups = (-(-vertices // GROUP), 1, 1)
    return run(device, FILE, "BlendVertices", groups, buffers, vertex_count=vertices)["vertex_dq"]


def skin_on(device: Device, vertex_dq: Array, mesh: Array, faces: Array, texels: Texels) -> Array:
    """Fields of PACKED [N] from SkinSplats."""
    count = len(texels.triangles)
    buffers = {
        "vertex_dq": vertex_dq,
        "mesh": mesh,
        "faces": faces.astype(np.uint32),
        "triangles": texels.triangles.astype(np.uint32),
        "barycentrics": texels.barycentrics[:, :2],
        "texel_channels": pack_channels(texels.texture),
        "splats": np.full((count, 16), 0xFFFFFFFF, np.uint32),
    }
    groups = (-(-count // GROUP), 1, 1)
    return unpacked(run(device, FILE, "SkinSplats", groups, buffers, texel_count=count, first_splat=0)["splats"])


@pytest.mark.parametrize("influences", [1, JOINTS, 8])
@pytest.mark.parametrize("count", GPU_COUNTS)
def test_hlsl_blends_vertices_as_the_reference(device: Device, count: int, influences: int) -> None:
    rng = np.random.default_rng(count)
    joints = (random_joints(rng, 8) * rng.choice([-1.0, 1.0], (8, 1))).astype(np.float32)
    indices, weights = random_influences(rng, count, influences)
    found = blend_on(device, joints, indices, weights)
    expected = blend_vertices(joints.astype(float), indices, weights)
    np.testing.assert_allclose(found, expected, rtol=0, atol=BLEND_BOUND)


@pytest.mark.parametrize("count", GPU_COUNTS)
def test_hlsl_skins_splats_as_the_reference(device: Device, count: int) -> None:
    rng = np.random.default_rng(count)
    vertex_dq = (random_joints(rng, 6) * rng.choice([-1.0, 1.0], (6, 1))).astype(np.float32)
    mesh = rng.uniform(-0.5, 0.5, (6, 3)).astype(np.float32)
    texels = random_texels(rng, count)
    found = skin_on(device, vertex_dq, mesh, FACES, texels)

    texture = texels.texture.astype(float)
    texel_dq = blend_texels(vertex_dq.astype(float), FACES, texels.triangles, texels.barycentrics)
    centres, rotations, scales, opacities = skin_splats(
        texel_dq, mesh, FACES, texels.triangles, texels.barycentrics, texture
    )
    np.testing.assert_allclose(found["centre"], centres, rtol=0, atol=CENTRE_BOUND)
    np.testing.assert_allclose(found["opacity"], opacities, rtol=0, atol=OPACITY_BOUND)
    assert_halves(found["turn"], texel_dq[:, :4], TEXEL_BOUND)
    assert_halves(found["sh"], texture[:, 11:], 0)
    largest = METRES2_TO_MM2 * np.square(scales.max(axis=1, keepdims=True))
    assert_halves(found["covariance"], METRES2_TO_MM2 * covariances(rotations, scales), COVARIANCE_BOUND * largest)


def test_hlsl_takes_the_first_of_equal_barycentrics_for_the_sign(device: Device) -> None:
    half_turn = np.array([[1, 0, 0, 0], [-0.6, 0.8, 0, 0], [-0.6, 0, 0.8, 0]], np.float32)
    vertex_dq = np.concatenate([half_turn, np.zeros((3, 4), np.float32)], axis=1)
    barycentrics = np.array([[0.5, 0.5, 0], [0, 0.5, 0.5], [0.25, 0.25, 0.5], [0.375, 0.25, 0.375]], np.float32)
    texels = Texels(np.zeros(4, int), barycentrics, np.zeros((4, 23), np.float32))
    found = skin_on(device, vertex_dq, np.zeros((3, 3), np.float32), FACES[:1], texels)
    expected = blend_texels(vertex_dq.astype(float), FACES[:1], texels.triangles, barycentrics)
    assert_halves(found["turn"], expected[:, :4], TEXEL_BOUND / 0.8)  # the least norm of the four sums


def test_hlsl_keeps_rotations_that_cancel_finite(device: Device) -> None:
    joints = np.zeros((2, 8), np.float32)
    joints[:, 4:] = 0.5
    indices, weights = np.zeros((6, 8), np.int32), np.full((6, 8), 0.125, np.float32)
    vertex_dq = blend_on(device, joints, indices, weights)
    assert np.isfinite(vertex_dq).all()
    vertex_dq[:, 4:] = 0.5
    found = skin_on(device, vertex_dq, np.ones((6, 3), np.float32), FACES, random_texels(np.random.default_rng(5), 65))
    assert all(np.isfinite(found[name]).all() for name in ("centre", "covariance", "turn", "sh", "opacity"))


def test_a_scale_beyond_any_is_held_at_the_largest_by_both(device: Device) -> None:
    rng = np.random.default_rng(7)
    vertex_dq, mesh, texels = random_joints(rng, 6).astype(np.float32), np.zeros((6, 3)), random_texels(rng, 9)
    texels.texture[:, 7:10] = np.resize([10.0, 11.0, 65504.0], (9, 3))
    texel_dq = blend_texels(vertex_dq, FACES, texels.triangles, texels.barycentrics)
    _, _, scales, _ = skin_splats(texel_dq, mesh, FACES, texels.triangles, texels.barycentrics, texels.texture)
    np.testing.assert_array_equal(scales, np.full((9, 3), np.exp(np.float32(10))))
    found = skin_on(device, vertex_dq, mesh.astype(np.float32), FACES, texels)
    assert np.isfinite(found["covariance"]).all()


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


@pytest.mark.parametrize("first", [0, 1, GROUP - 1])
def test_hlsl_leaves_the_splats_of_others_alone(device: Device, first: int) -> None:
    rng = np.random.default_rng(6)
    vertex_dq, texels = random_joints(rng, 6).astype(np.float32), random_texels(rng, GROUP + 1)
    untouched = np.full((2 * GROUP, 16), 0xFFFFFFFF, np.uint32)
    buffers = {
        "vertex_dq": vertex_dq,
        "mesh": np.zeros((6, 3), np.float32),
        "faces": FACES.astype(np.uint32),
        "triangles": texels.triangles.astype(np.uint32),
        "barycentrics": texels.barycentrics[:, :2],
        "texel_channels": pack_channels(texels.texture),
        "splats": untouched,
    }
    constants = {"texel_count": GROUP + 1, "first_splat": first}
    splats = run(device, FILE, "SkinSplats", (2, 1, 1), buffers, **constants)["splats"]
    written = (splats != untouched).any(axis=1)
    np.testing.assert_array_equal(np.flatnonzero(written), first + np.arange(GROUP + 1))
