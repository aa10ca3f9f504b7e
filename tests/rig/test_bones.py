"""Capsules around bones."""

from dataclasses import replace

import numpy as np
from tube import RADIUS, tube

from mua import rotation
from mua.rig.bones import PERSON, capsule_distance, figure_scale, fit_bones

ROUNDING = 64 * float(np.finfo(np.float64).eps)  # some ten operations on lengths of about 2


def test_a_capsule_runs_from_joint_to_joint_with_the_radius_of_the_skin() -> None:
    character = tube()
    bones = fit_bones(character, np.zeros(len(character.mesh.vertices)))
    assert bones.joints.tolist() == [0, 1, 2]
    np.testing.assert_allclose(bones.ends[:2, :, 1], [[0.05, 0.6], [0.6, 1.2]], atol=ROUNDING)
    np.testing.assert_allclose(bones.radii, RADIUS, atol=ROUNDING)


def test_loose_clothes_do_not_make_a_bone() -> None:
    character = tube()
    assert len(fit_bones(character, np.ones(len(character.mesh.vertices))).joints) == 0


def test_a_figure_of_another_size_has_the_same_bones() -> None:
    character = tube()
    mesh, skeleton = character.mesh, character.skeleton
    small = replace(
        character,
        mesh=replace(mesh, vertices=0.01 * mesh.vertices),
        skeleton=replace(skeleton, bind_translations=0.01 * skeleton.bind_translations),
    )
    still = np.zeros(len(mesh.vertices))
    np.testing.assert_allclose(fit_bones(small, still).ends, 0.01 * fit_bones(character, still).ends, atol=ROUNDING)
    np.testing.assert_allclose(figure_scale(small.mesh.vertices), 0.01 * 1.75 / PERSON, rtol=ROUNDING)


def test_capsules_move_with_their_joints() -> None:
    character = tube()
    bones = fit_bones(character, np.zeros(len(character.mesh.vertices)))
    turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), 1.0)
    joints = np.tile(rotation.dual_from_rigid(turn, np.array([1.0, 2, 3])), (3, 1))
    expected = rotation.rotate(turn, bones.ends) + np.array([1, 2, 3])
    np.testing.assert_allclose(bones.posed(joints), expected, atol=ROUNDING)


def test_distance_to_the_nearest_point_of_a_segment() -> None:
    points = np.array([[0.0, 3, 0], [1, 2, 0], [0.5, 0, 7]])
    np.testing.assert_allclose(capsule_distance(points, np.zeros(3), np.array([1.0, 0, 0])), [3, 2, 7], atol=ROUNDING)
    np.testing.assert_allclose(capsule_distance(points, np.zeros(3), np.zeros(3))[0], 3, atol=ROUNDING)
