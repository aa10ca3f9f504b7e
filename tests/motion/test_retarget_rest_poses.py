"""Retargeting from rest poses that are not upright: bones along one axis, frames of a motion, turned trunks."""

from dataclasses import replace

import numpy as np
import pytest
from people import (
    ANGLE_BOUND,
    LIMBS,
    POSITION_BOUND,
    angle,
    bone,
    bone_aligned,
    person,
    retarget,
    still,
    walk,
    with_fingers,
    with_offset,
    world,
)
from scipy.spatial.transform import Rotation

from mua import rotation
from mua.motion.match import match_joints
from mua.motion.quality import measure_motion
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

ESTIMATE_BOUND = 8.0  # degrees: how far this person's trunk leans at rest, and what a walk shows of twists


def median_apart(skeleton: Skeleton, clip: Clip, other: Clip) -> float:
    """How far the joint that differs most is turned otherwise in half of all frames, degrees."""
    cosines = np.abs(np.sum(world(skeleton, clip)[0] * world(skeleton, other)[0], axis=-1))
    return float(np.median(np.degrees(2 * np.arccos(np.minimum(cosines, 1))), axis=0).max())


@pytest.mark.parametrize("heading", [0, 130])
def test_bone_aligned_rest_poses_give_what_a_standing_one_gives(heading: float) -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    turn = Rotation.from_euler("y", heading, degrees=True).as_quat(scalar_first=True)
    clip.rotations[:, 0] = rotation.multiply(turn, clip.rotations[:, 0])
    clip.translations[:, 0] = rotation.rotate(turn, clip.translations[:, 0])
    straight, same = bone_aligned(source, clip)
    np.testing.assert_allclose(world(straight, same)[1], world(source, clip)[1], atol=POSITION_BOUND)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, notes = retarget(SourceMotion(straight, same), target)
    assert not any("floor" in note for note in notes)
    for begin, end in LIMBS:
        assert angle(bone(target, found, begin, end), bone(target, expected, begin, end)) < ANGLE_BOUND
    assert median_apart(target, found, expected) < ESTIMATE_BOUND
    quality = measure_motion(SourceMotion(straight, same), target, found, match_joints(straight, target))
    assert quality.flaws == ()
    assert quality.facing_degrees is not None
    assert quality.facing_degrees < ESTIMATE_BOUND


def resting_in(skeleton: Skeleton, clip: Clip, frame: int) -> Skeleton:
    """The skeleton as files without a bind pose hold it: at rest in a frame of the motion."""
    return replace(skeleton, bind_rotations=clip.rotations[frame], bind_translations=clip.translations[frame])


def test_a_rest_pose_that_is_a_frame_of_the_motion_is_not_taken_for_standing() -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, _ = retarget(SourceMotion(resting_in(source, clip, 10), clip), target)
    assert median_apart(target, found, expected) < ESTIMATE_BOUND


def turned_otherwise(skeleton: Skeleton, clip: Clip, joint: str, degrees: float) -> Clip:
    """The clip with all joints where they are, and one of them turned about Y besides, as a solver may leave it."""
    own = Rotation.from_euler("y", degrees, degrees=True).as_quat(scalar_first=True)
    j = skeleton.names.index(joint)
    rotations, translations = clip.rotations.copy(), clip.translations.copy()
    rotations[:, j] = rotation.multiply(rotations[:, j], own)
    for child in np.flatnonzero(skeleton.parents == j):
        rotations[:, child] = rotation.multiply(rotation.conjugate(own), rotations[:, child])
        translations[:, child] = rotation.rotate(rotation.conjugate(own), translations[:, child])
    return replace(clip, rotations=rotations, translations=translations)


@pytest.mark.parametrize("joint", ["Hips", "Spine2"])
def test_a_trunk_that_frames_turn_otherwise_than_the_rest_pose_stands_faces_ahead(joint: str) -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    solved = turned_otherwise(source, clip, joint, 100)
    np.testing.assert_allclose(world(source, solved)[1], world(source, clip)[1], atol=POSITION_BOUND)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, _ = retarget(SourceMotion(source, solved), target)
    assert median_apart(target, found, expected) < ESTIMATE_BOUND


def test_a_figure_that_stands_still_in_a_pose_that_is_not_upright_is_taken_as_it_is() -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    held = replace(clip, rotations=clip.rotations[[10] * 5], translations=clip.translations[[10] * 5])
    found, _ = retarget(SourceMotion(resting_in(source, held, 0), held), target)
    expected, _ = retarget(SourceMotion(source, held), target)
    assert angle(bone(target, found, "Hips", "Spine"), bone(target, expected, "Hips", "Spine")) < np.radians(10)


def test_hips_and_shoulders_of_a_bind_pose_whose_chest_is_turned_each_face_where_the_source_does() -> None:
    source, plain = person(), person(size=1.1)
    clip = walk(source)
    rotations = plain.bind_rotations.copy()
    turn = Rotation.from_euler("y", 30, degrees=True).as_quat(scalar_first=True)
    rotations[plain.names.index("Spine")] = rotation.multiply(turn, rotations[plain.names.index("Spine")])
    target = replace(plain, bind_rotations=rotations)
    found, _ = retarget(SourceMotion(*bone_aligned(source, clip)), target)
    for part in ("UpLeg", "Arm"):
        ends = (f"Right{part}", f"Left{part}")
        assert angle(bone(target, found, *ends), bone(source, clip, *ends)) < np.radians(2 * ESTIMATE_BOUND)


def test_a_head_that_looks_down_while_the_body_is_most_upright_does_not_look_up_in_the_rest() -> None:
    """A dancer who bows the head for a quarter of the clip, in a file whose rest pose says nothing of heads."""
    source, target = person(), person(size=1.1, axes=2)
    joints = [joint for joint, name in enumerate(source.names) if name != "HeadTop_End"]
    clip = walk(source)
    bowed = np.arange(len(clip)) < len(clip) // 4
    for name, degrees in (("Spine", np.where(bowed, 0, 8)), ("Head", np.where(bowed, 45, -8))):
        turns = Rotation.from_euler("x", degrees[:, None], degrees=True).as_quat(scalar_first=True)
        clip.rotations[:, source.names.index(name)] = turns
    plain, aligned = bone_aligned(source, clip)
    parents = np.array([joints.index(parent) if parent >= 0 else -1 for parent in plain.parents[joints]], np.int32)
    names = tuple(plain.names[joint] for joint in joints)
    bare = Skeleton(names, parents, plain.bind_rotations[joints], plain.bind_translations[joints], 0)
    motion = Clip("dance", clip.rate, aligned.rotations[:, joints], aligned.translations[:, joints])
    found, _ = retarget(SourceMotion(bare, motion), target)
    head = target.names.index("Head")
    rest, _ = target.world(target.bind_rotations, target.bind_translations)
    moved = rotation.multiply(world(target, found)[0][:, head], rotation.conjugate(rest[head]))
    looks = np.degrees(np.arcsin(rotation.rotate(moved, np.broadcast_to([0.0, 0, 1], (len(moved), 3)))[:, 1]))
    # The mean over the clip is level, a quarter of it 45 degrees down, so the others are 45 / 4 up.
    assert np.median(looks[~bowed]) == pytest.approx(45 / 4, abs=4)
    assert np.median(looks[bowed]) == pytest.approx(-45 * 3 / 4, abs=4)


@pytest.mark.parametrize(("stands", "swings"), [("Left", "Right"), ("Right", "Left")])
def test_a_sole_is_level_while_its_own_foot_stands(stands: str, swings: str) -> None:
    """The ankles of source and target lie at other heights, so that a foot's bone alone would tilt the sole."""
    source, target = person(), person(size=1.1, axes=2)
    for side in ("Left", "Right"):
        source = with_offset(source, f"{side}ToeBase", (0, -0.02, 0.13))
    pitch = 0.8 * np.sin(2 * np.pi * np.arange(60) / 30)
    clip = still(source, len(pitch))
    clip.rotations[:, source.names.index(f"{swings}UpLeg")] = Rotation.from_rotvec(pitch[:, None] * [1, 0, 0]).as_quat(
        scalar_first=True
    )
    found, _ = retarget(SourceMotion(*bone_aligned(source, clip)), target)
    sole = target.names.index(f"{stands}Foot")
    rest, _ = target.world(target.bind_rotations, target.bind_translations)
    moved = rotation.multiply(world(target, found)[0][:, sole], rotation.conjugate(rest[sole]))
    up = rotation.rotate(moved, np.broadcast_to([0.0, 1, 0], (len(moved), 3)))
    assert np.degrees(np.arccos(up[:, 1])).max() < ESTIMATE_BOUND


def test_rotations_are_copied_between_rigs_of_one_maker_whatever_the_rest_pose() -> None:
    source, target = person(axes=1), person(size=1.1, axes=1)
    plain = walk(person())
    straight = rotation.multiply(
        rotation.conjugate(world(person(), still(person()))[0]),
        world(person(), plain)[0],
    )
    turned = rotation.multiply(straight, source.world(source.bind_rotations, source.bind_translations)[0])
    above = turned[:, np.maximum(source.parents, 0)]
    local = np.where(source.parents[:, None] < 0, turned, rotation.multiply(rotation.conjugate(above), turned))
    clip = Clip("walk", 30.0, local, source.with_root(plain.translations[:, 0]))
    found, _ = retarget(SourceMotion(resting_in(source, clip, 10), clip), target)
    cosines = np.abs(np.sum(world(target, found)[0] * world(source, clip)[0], axis=-1))
    np.testing.assert_allclose(cosines, 1, atol=POSITION_BOUND)


@pytest.mark.parametrize("straight", [False, True], ids=["standing", "along one axis"])
def test_palms_follow_the_motion_whichever_way_a_rest_pose_holds_the_hands(straight: bool) -> None:
    target, source = with_fingers(person()), with_fingers(person(size=1.2))
    clip = walk(source)
    hands = [source.names.index(f"{side}Hand") for side in ("Left", "Right")]
    resting = source.bind_rotations.copy()
    resting[hands] = Rotation.from_euler("x", [[70], [-50]], degrees=True).as_quat(scalar_first=True)
    source = replace(source, bind_rotations=resting)
    if straight:
        source, clip = bone_aligned(source, clip)
    found, _ = retarget(SourceMotion(source, clip), target)
    for side in ("Left", "Right"):
        for begin, end in (("HandPinky1", "HandIndex1"), ("Hand", "HandMiddle1")):
            along = (bone(*side_clip, side + begin, side + end) for side_clip in ((target, found), (source, clip)))
            assert angle(*along) < ANGLE_BOUND
