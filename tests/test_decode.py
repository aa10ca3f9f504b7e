"""Decoding of windows and of float32; posing by what a rigid motion must do. tests/oracle holds the numbers."""

import dataclasses

import numpy as np
from synthetic_avatar import empty_avatar, synthetic_avatar, synthetic_rig

from mua import rotation
from mua.arrays import Array
from mua.decode import Splats, decode, decode_clip_frame, pose_splats
from mua.pose.skeleton import Pose

# Sums on the way of one value: four layers of at most 63 terms, 4 basis maps, 4 levels of 2 x 10 taps, 20 in posing.
OPERATIONS = 4 * 63 + 4 + 80 + 20


def test_float32_stays_near_float64() -> None:
    avatar = synthetic_avatar()
    single = decode_clip_frame(avatar, avatar.clips[0], frame=3)
    double = decode_clip_frame(avatar, avatar.clips[0], frame=3, dtype=np.float64)
    for field in dataclasses.fields(Splats):
        found, expected = getattr(single, field.name), getattr(double, field.name)
        assert (found.dtype, expected.dtype) == (np.float32, np.float64)
        bound = OPERATIONS * np.finfo(np.float32).eps * max(np.abs(double.texture).max(), 1)
        np.testing.assert_allclose(found, expected, rtol=0, atol=bound, err_msg=field.name)


def test_a_frame_of_a_clip_is_its_window_newest_first() -> None:
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    for frame, window in ((3, [3, 2, 1]), (1, [1, 0, 0]), (0, [0, 0, 0])):
        expected = decode(avatar, clip.rotations[window], translations=clip.translations[window])
        np.testing.assert_array_equal(decode_clip_frame(avatar, clip, frame=frame).centres, expected.centres)


def test_depth_is_keyed_over_the_files_box_about_the_root() -> None:
    """As players do, who know no box of the splats themselves."""
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    posed = decode_clip_frame(avatar, clip, frame=3, dtype=np.float64)
    root = avatar.rig.skeleton.world(clip.rotations[3], clip.translations[3])[1][avatar.rig.skeleton.root]
    np.testing.assert_array_equal(posed.bounds, avatar.bounds + root)


def test_an_avatar_without_texels_decodes_to_no_splats() -> None:
    empty = empty_avatar()
    posed = decode_clip_frame(empty, empty.clips[0], frame=0)
    assert posed.centres.shape == (0, 3)
    assert posed.texture.shape == (0, 23)


def random_texture(texels: int) -> Array:
    return np.random.default_rng(0).normal(size=(texels, 23)) * 0.1 + np.eye(1, 23, 3)


def test_bind_pose_leaves_splats_on_the_canonical_surface() -> None:
    rig = synthetic_rig()
    texture = random_texture(len(rig.texels.texels))
    posed = pose_splats(rig, rig.mesh.vertices, texture=texture, pose=rig.skeleton.bind_pose)
    corners = rig.mesh.vertices[rig.mesh.faces[rig.texels.triangles]]
    on_surface = np.einsum("nk,nkx->nx", rig.texels.barycentrics, corners)
    bound = OPERATIONS * np.finfo(float).eps
    np.testing.assert_allclose(posed.mesh, rig.mesh.vertices, rtol=0, atol=bound)
    np.testing.assert_allclose(posed.centres, on_surface + texture[:, 0:3], rtol=0, atol=bound)
    np.testing.assert_allclose(posed.rotations, rotation.normalize(texture[:, 3:7]), rtol=0, atol=bound)
    np.testing.assert_array_equal(posed.sh, texture[:, 11:])


def test_moving_the_root_moves_everything_rigidly() -> None:
    rig = synthetic_rig()
    texture = random_texture(len(rig.texels.texels))
    turn = rotation.from_axis_angle(np.array([0.6, 0, 0.8]), 2.0)
    moved = np.array([1.0, 2, 3])
    pose = Pose(np.concatenate([turn[None], rig.skeleton.bind_rotations[1:]]), rig.skeleton.with_root(moved))
    still = pose_splats(rig, rig.mesh.vertices, texture=texture, pose=rig.skeleton.bind_pose)
    posed = pose_splats(rig, rig.mesh.vertices, texture=texture, pose=pose)
    pivot = rig.skeleton.bind_translations[0]
    bound = OPERATIONS * np.finfo(float).eps
    for name in ("mesh", "centres"):
        expected = rotation.rotate(turn, getattr(still, name) - pivot) + moved
        np.testing.assert_allclose(getattr(posed, name), expected, rtol=0, atol=bound)
    np.testing.assert_allclose(posed.rotations, rotation.multiply(turn, still.rotations), rtol=0, atol=bound)
    np.testing.assert_allclose(posed.texel_dq[:, :4], np.broadcast_to(turn, (len(texture), 4)), rtol=0, atol=bound)
    np.testing.assert_array_equal(posed.scales, still.scales)
