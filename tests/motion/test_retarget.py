"""Retargeting: what limbs do in the world, checked on a T-pose person built here."""

from dataclasses import replace

import numpy as np
import pytest
from people import (
    ANGLE_BOUND,
    LIMBS,
    POSITION_BOUND,
    angle,
    animal,
    assert_turned_as_at_rest,
    bone,
    bone_aligned,
    person,
    random_clip,
    retarget,
    still,
    walk,
    with_offset,
    world,
)
from scipy.spatial.transform import Rotation

from mua import rotation
from mua.errors import InputError
from mua.motion.source_motion import SourceMotion
from mua.pose.skeleton import Skeleton


def below_a_turned_joint(skeleton: Skeleton) -> Skeleton:
    """The skeleton in its place, under a node that is turned and moved."""
    turn, shift = Rotation.random(random_state=3).as_quat(scalar_first=True), np.array([0.3, 0.1, -0.2])
    rotations = np.concatenate([turn[None], skeleton.bind_rotations])
    rotations[1] = rotation.multiply(rotation.conjugate(turn), rotations[1])
    offsets = np.concatenate([shift[None], skeleton.bind_translations])
    offsets[1] = rotation.rotate(rotation.conjugate(turn), offsets[1] - shift)
    parents = np.concatenate([[-1], skeleton.parents + 1]).astype(np.int32)
    return Skeleton(("Armature", *skeleton.names), parents, rotations, offsets, root=1)


@pytest.mark.parametrize(
    "skeleton",
    [person(), person(axes=1), person(arms_down=50, legs_apart=15, axes=2), below_a_turned_joint(person(axes=4))],
    ids=["plain axes", "random axes", "A-pose", "below a turned joint"],
)
def test_onto_itself_is_the_identity(skeleton: Skeleton) -> None:
    clip = random_clip(skeleton)
    clip.rotations[:, : skeleton.root] = skeleton.bind_rotations[: skeleton.root]
    found, _ = retarget(SourceMotion(skeleton, clip), skeleton)
    for a, b in zip(world(skeleton, found), world(skeleton, clip), strict=True):
        sign = np.sign(np.sum(a * b, axis=-1, keepdims=True)) if a.shape[-1] == 4 else 1
        np.testing.assert_allclose(sign * a, b, atol=POSITION_BOUND)


@pytest.mark.parametrize("arms_down", [0, 50])
@pytest.mark.parametrize("legs_apart", [0, 20])
def test_limbs_point_where_the_source_points(arms_down: float, legs_apart: float) -> None:
    source, target = person(arms_down=arms_down, legs_apart=legs_apart, axes=1), person(size=1.3, axes=2)
    clip = random_clip(source)
    found, _ = retarget(SourceMotion(source, clip), target)
    for begin, end in LIMBS:
        assert angle(bone(target, found, begin, end), bone(source, clip, begin, end)) < ANGLE_BOUND


def lopsided(skeleton: Skeleton, other: Skeleton) -> Skeleton:
    """The first person with the right arm and leg of the other; both have plain axes."""
    right = np.array([name.startswith("Right") for name in skeleton.names])[:, None]
    return replace(skeleton, bind_translations=np.where(right, other.bind_translations, skeleton.bind_translations))


@pytest.mark.parametrize("right_is_splayed", [False, True])
def test_limbs_point_where_the_source_points_where_left_and_right_rest_otherwise(right_is_splayed: bool) -> None:
    straight, splayed = person(), person(arms_down=50, legs_apart=20)
    target = lopsided(straight, splayed) if right_is_splayed else lopsided(splayed, straight)
    source = person(axes=1)
    clip = random_clip(source)
    found, _ = retarget(SourceMotion(source, clip), target)
    for begin, end in LIMBS:
        assert angle(bone(target, found, begin, end), bone(source, clip, begin, end)) < ANGLE_BOUND, begin


def test_each_sole_is_levelled_by_its_own_foot() -> None:
    """Feet that roll with a splayed leg stand beside one that is straight."""
    source, target = lopsided(person(), person(legs_apart=20)), person(axes=2)
    rotations = source.bind_rotations[None].copy()
    rotations[0, source.names.index("RightUpLeg")] = Rotation.from_euler("z", 20, degrees=True).as_quat(
        scalar_first=True
    )
    closed = replace(still(source), rotations=rotations)
    turned, _ = world(target, retarget(SourceMotion(source, closed), target)[0])
    assert_turned_as_at_rest(target, turned[0], "LeftFoot", "RightFoot", "RightToeBase")


def test_the_rest_pose_of_another_person_gives_ones_own_torso() -> None:
    source, target = person(arms_down=50, legs_apart=20, axes=1), person(axes=2)
    rest = still(source)
    turned, _ = world(target, retarget(SourceMotion(source, rest), target)[0])
    assert_turned_as_at_rest(target, turned[0], "Hips", "Spine", "Spine2", "Neck", "Head", "LeftShoulder")


def test_soles_are_level_when_splayed_legs_close() -> None:
    """Where the source's feet roll with its legs (ASF zero pose), legs straight down mean level feet."""
    source, target = person(legs_apart=20), person(axes=2)
    rotations = source.bind_rotations[None].copy()
    for side, sign in (("Left", -1), ("Right", 1)):
        turn = Rotation.from_euler("z", sign * 20, degrees=True).as_quat(scalar_first=True)
        rotations[0, source.names.index(f"{side}UpLeg")] = turn
    closed = replace(still(source), rotations=rotations)
    turned, _ = world(target, retarget(SourceMotion(source, closed), target)[0])
    assert_turned_as_at_rest(target, turned[0], "LeftFoot", "RightFoot", "LeftToeBase")


def test_soles_stay_level_where_only_the_targets_legs_are_apart() -> None:
    """A bind pose with legs apart and level soles: the feet of a source that stands level stay level."""
    source, apart = person(), person(legs_apart=20)
    _, level = source.world(source.bind_rotations, source.bind_translations)
    offsets = apart.bind_translations.copy()  # plain axes: local offsets are differences in the world
    for side in ("Left", "Right"):
        for name in (f"{side}ToeBase", f"{side}Toe_End"):
            j = apart.names.index(name)
            offsets[j] = level[j] - level[apart.parents[j]]
    target = replace(apart, bind_translations=offsets)
    rest = still(source)
    found, _ = retarget(SourceMotion(source, rest), target)
    turned, _ = world(target, found)
    np.testing.assert_allclose(np.abs(turned[0, target.names.index("LeftFoot"), 0]), 1, atol=POSITION_BOUND)
    assert angle(bone(target, found, "LeftUpLeg", "LeftLeg"), bone(source, rest, "LeftUpLeg", "LeftLeg")) < ANGLE_BOUND


@pytest.mark.parametrize("yaw", [90, 180, -37])
def test_faces_the_targets_way_whatever_way_the_source_rests(yaw: float) -> None:
    source, target = person(axes=1), person(size=1.1, axes=2)
    clip = random_clip(source)
    turn = Rotation.from_euler("y", yaw, degrees=True).as_quat(scalar_first=True)
    rest, rotations = source.bind_rotations.copy(), clip.rotations.copy()
    rest[0], rotations[:, 0] = rotation.multiply(turn, rest[0]), rotation.multiply(turn, rotations[:, 0])
    moved = with_offset(source, "Hips", rotation.rotate(turn, source.bind_translations[0]))
    turned_source = replace(moved, bind_rotations=rest)
    translations = clip.translations.copy()
    translations[:, 0] = rotation.rotate(turn, translations[:, 0])
    turned_clip = replace(clip, rotations=rotations, translations=translations)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, _ = retarget(SourceMotion(turned_source, turned_clip), target)
    np.testing.assert_allclose(world(target, found)[1], world(target, expected)[1], atol=POSITION_BOUND)


def test_path_and_size_scale_with_the_legs() -> None:
    small, large = person(axes=1), person(size=2, axes=1)
    clip = random_clip(small)
    found, _ = retarget(SourceMotion(small, clip), large)
    np.testing.assert_allclose(world(large, found)[1], 2 * world(small, clip)[1], atol=POSITION_BOUND)


def test_joints_without_a_match_keep_their_bind_rotation() -> None:
    source, target = person(axes=1), person(axes=2)
    names = tuple("Wing" if name == "LeftShoulder" else name for name in target.names)
    winged = replace(target, names=names)
    found, notes = retarget(SourceMotion(source, random_clip(source)), winged)
    j = names.index("Wing")
    np.testing.assert_array_equal(found.rotations[:, j], np.tile(target.bind_rotations[j], (9, 1)))
    assert notes[0].startswith(f"1 of {len(names)} joints")


def test_mapping_reaches_joints_that_neither_names_nor_places_give_away() -> None:
    (plain, clip), target = bone_aligned(person(), walk(person())), person(axes=2)
    names = tuple(f"Bone.{i:03}" for i in range(len(plain.names)))
    source = replace(plain, names=names)
    with pytest.raises(InputError, match="mapping file"):
        retarget(SourceMotion(source, clip), target)
    mapping = dict(zip(target.names, names, strict=True))
    found, _ = retarget(SourceMotion(source, clip), target, mapping=mapping)
    expected, _ = retarget(SourceMotion(plain, clip), target)
    np.testing.assert_array_equal(found.rotations, expected.rotations)


@pytest.mark.parametrize("flat", [{0}, {1}, {2}, {0, 1}, {1, 2}, {0, 1, 2}])
def test_skeletons_without_some_extent_still_give_rotations(flat: set[int]) -> None:
    """Rest poses as broken exporters write them: all joints in one plane, on one line, in one point."""
    whole = person()
    offsets = whole.bind_translations.copy()
    offsets[:, sorted(flat)] = 0
    thin = replace(whole, bind_translations=offsets)
    for source, target in ((thin, person(axes=2)), (person(axes=2), thin)):
        found, _ = retarget(SourceMotion(source, random_clip(source)), target)
        np.testing.assert_allclose(np.linalg.norm(found.rotations, axis=-1), 1, atol=POSITION_BOUND)
        assert np.isfinite(found.translations).all()


def test_brings_the_clip_to_the_rate_asked_for() -> None:
    skeleton = person(axes=1)
    found, _ = retarget(SourceMotion(skeleton, random_clip(skeleton)), skeleton, rate=24.0)
    assert (len(found), found.rate) == (7, 24.0)


def test_an_animal_stands_as_the_animal_of_the_motion_stands() -> None:
    source, target = animal(ahead=0, size=3, knee=0.03), animal(ahead=2, size=1, knee=0.08)
    clip, _ = retarget(SourceMotion(source, still(source, 10)), target)
    _, at = world(target, clip)
    _, rest = target.world(target.bind_rotations, target.bind_translations)
    trunk = [target.names.index(name) for name in ("Hips", "Spine", "Chest", "Neck", "Head", "LeftUpperArm")]
    np.testing.assert_allclose(at[:, trunk] - at[:, :1], np.tile(rest[trunk] - rest[0], (10, 1, 1)), atol=1e-9)
    feet = [target.names.index(f"{side}{end}") for side in ("Left", "Right") for end in ("Hand", "Foot")]
    assert abs(at[:, feet, 1] - rest[feet, 1]).max() < 0.05
