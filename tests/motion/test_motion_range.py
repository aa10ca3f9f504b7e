"""The built-in range of motion: what limbs do on rigs of people, and what every joint does on others."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from many_rigs import RIGS, character
from people import LIMBS, angle, bone, person, still, world

from mua import rotation
from mua.arrays import Array
from mua.motion.range import motion_range, standing
from mua.motion.range.angles import INDEX, LIMITS
from mua.motion.range.mixed import mixed, random_poses, within
from mua.motion.range.moves import MOVES
from mua.motion.range.played import played
from mua.pose.clip import RANGE_OF_MOTION, Clip
from mua.pose.skeleton import Skeleton

SIDES = ("Left", "Right")
FRAMES = 100  # recorded, for which all moves are played
WAYS = 12.0  # degrees by which limbs of two rigs may differ: toes roll along with legs that are set apart
BACKWARDS = 6.0  # degrees: knees and elbows at rest are bent so far in one of the rigs


@pytest.fixture(scope="module", params=RIGS)
def rig(request: pytest.FixtureRequest) -> tuple[Skeleton, Clip]:
    """A rig, and all of its range as one clip."""
    skeleton = RIGS[request.param]
    return skeleton, joined(motion_range(character(skeleton), (), frames=FRAMES, seed=0))


def joined(clips: Sequence[Clip]) -> Clip:
    first, *others = clips
    for other in others:
        first = first.then(other)
    return first


def degrees(a: Array, b: Array) -> Array:
    return np.degrees(np.arccos(np.clip(np.sum(a * b, axis=-1), -1, 1)))


def folds(skeleton: Skeleton, clip: Clip, names: tuple[str, str, str], across: Array) -> Array:
    """Degrees [F] by which the second bone of a limb is bent about `across` [3] of the bind pose, and that alone."""
    turned, _ = world(skeleton, clip)
    rest, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    joint = skeleton.names.index(names[0])
    since = rotation.multiply(turned[:, joint], rotation.conjugate(rest[joint]))
    upper, lower = bone(skeleton, clip, *names[:2]), bone(skeleton, clip, *names[1:])
    axis = rotation.rotate(since, across)
    return np.degrees(np.arctan2(np.sum(np.cross(upper, lower) * axis, axis=-1), np.sum(upper * lower, axis=-1)))


def in_the_hips(skeleton: Skeleton, clip: Clip, begin: str, end: str, *, carrier: str = "Hips") -> Array:
    """Directions [F, 3] of a bone as the carrier sees them: left, up, ahead."""
    turned, _ = world(skeleton, clip)
    rest, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    joint = skeleton.names.index(carrier)
    since = rotation.multiply(turned[:, joint], rotation.conjugate(rest[joint]))
    return rotation.rotate(rotation.conjugate(since), bone(skeleton, clip, begin, end))


@pytest.mark.parametrize("side", SIDES)
def test_every_limb_reaches_its_range_on_both_sides(rig: tuple[Skeleton, Clip], side: str) -> None:
    skeleton, clip = rig
    out = 1.0 if side == "Left" else -1.0
    arm = in_the_hips(skeleton, clip, f"{side}Arm", f"{side}ForeArm", carrier="Spine2")
    assert arm[:, 1].max() > 0.95  # over the head
    assert (out * arm[:, 0]).max() > 0.95  # sideways
    assert (out * arm[:, 0]).min() < -0.45  # across the chest
    assert arm[:, 2].max() > 0.95
    assert arm[:, 2].min() < -0.5
    thigh = in_the_hips(skeleton, clip, f"{side}UpLeg", f"{side}Leg")
    assert thigh[:, 1].max() > 0.3  # a high kick
    assert thigh[:, 2].min() < -0.3
    assert (out * thigh[:, 0]).max() > 0.6
    assert (out * thigh[:, 0]).min() < -0.15
    for names in (("Arm", "ForeArm", "Hand"), ("UpLeg", "Leg", "Foot")):
        upper, lower = (bone(skeleton, clip, side + a, side + b) for a, b in pairwise(names))
        assert degrees(upper, lower).max() > 120
    for begin, end in (("ForeArm", "Hand"), ("Leg", "Foot")):
        toes = "HandMiddle1" if end == "Hand" else "ToeBase"
        above, below = (bone(skeleton, clip, side + a, side + b) for a, b in ((begin, end), (end, toes)))
        assert np.ptp(degrees(above, below)) > 50


def test_the_head_goes_in_all_directions(rig: tuple[Skeleton, Clip]) -> None:
    skeleton, clip = rig
    top = in_the_hips(skeleton, clip, "Head", "HeadTop_End", carrier="Spine2")
    assert top[:, 2].max() > 0.6
    assert top[:, 2].min() < -0.6
    assert min(top[:, 0].max(), -top[:, 0].min()) > 0.5
    turned, _ = world(skeleton, clip)
    rest, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    head, chest = (skeleton.names.index(name) for name in ("Head", "Spine2"))
    since = [rotation.multiply(turned[:, joint], rotation.conjugate(rest[joint])) for joint in (head, chest)]
    looks = rotation.rotate(rotation.multiply(rotation.conjugate(since[1]), since[0]), np.array([0, 0, 1.0]))
    assert min(looks[:, 0].max(), -looks[:, 0].min()) > 0.85


@pytest.mark.parametrize("side", SIDES)
def test_knees_and_elbows_bend_forward_alone(rig: tuple[Skeleton, Clip], side: str) -> None:
    skeleton, clip = rig
    knees = folds(skeleton, clip, (f"{side}UpLeg", f"{side}Leg", f"{side}Foot"), np.array([1.0, 0, 0]))
    assert knees.min() > -BACKWARDS
    assert knees.max() > 120
    _, rest = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    names = [skeleton.names.index(f"{side}{part}") for part in ("Arm", "ForeArm")]
    across = np.cross(rest[names[1]] - rest[names[0]], [0, 0, 1.0])
    elbows = folds(skeleton, clip, (f"{side}Arm", f"{side}ForeArm", f"{side}Hand"), across / np.linalg.norm(across))
    assert elbows.min() > -BACKWARDS
    assert elbows.max() > 120


def test_rigs_with_other_rest_poses_move_their_limbs_alike() -> None:
    one, other = (
        (skeleton, joined(motion_range(character(skeleton), (), frames=FRAMES, seed=0))) for skeleton in RIGS.values()
    )
    for begin, end in LIMBS:
        assert np.degrees(angle(bone(*one, begin, end), bone(*other, begin, end))) < WAYS, begin


def test_the_whole_body_is_shown_upside_down_and_lying(rig: tuple[Skeleton, Clip]) -> None:
    up = bone(*rig, "Hips", "Spine")[:, 1]
    assert up.min() < -0.95
    assert np.count_nonzero(abs(up) < 0.2) > 20


def test_whoever_walks_stands_on_the_floor_and_gets_ahead() -> None:
    skeleton = RIGS["T-pose"]
    walk = motion_range(character(skeleton), (), frames=FRAMES, seed=0)[0]
    assert walk.name == f"{RANGE_OF_MOTION}walk"
    feet = [skeleton.names.index(f"{side}{part}") for side in SIDES for part in ("Foot", "ToeBase")]
    _, rest = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    _, at = world(skeleton, walk.cut(slice(45)))  # the first steps, straight on
    heights = (at[:, feet, 1] - rest[feet, 1]).min(axis=1)
    assert abs(heights).max() < 0.06
    assert at[-1, 0, 2] - at[0, 0, 2] > 0.5


def test_whoever_lies_or_stands_on_the_hands_touches_the_floor() -> None:
    skeleton = RIGS["T-pose"]
    clips = {clip.name: clip for clip in motion_range(character(skeleton), (), frames=FRAMES, seed=0)}
    lowest = world(skeleton, clips[f"{RANGE_OF_MOTION}floor"])[1][..., 1].min(axis=1)
    assert -0.1 < lowest.min() <= lowest.max() < 0.2


def test_no_pose_is_beyond_the_limits_of_its_joints() -> None:
    assert all(any(key.angles for key in keys) for keys in MOVES.values())
    assert MOVES
    for name, keys in MOVES.items():
        for number, key in enumerate(keys):
            for angle_name, degree in key.angles.items():
                low, high = LIMITS.get(angle_name, (-360, 360))
                assert low <= degree <= high, (name, number, angle_name)


def test_random_poses_keep_limbs_out_of_the_body() -> None:
    any_pose = within(random_poses(np.random.default_rng(0), tries=1))
    taken = within(random_poses(np.random.default_rng(0)))
    assert any_pose.mean() > 0.02  # metres
    assert taken.mean() < 0.003


def test_random_poses_are_reached_slowly_and_as_fast_as_a_kick() -> None:
    clip = mixed("any", np.random.default_rng(0))
    turns = 2 * np.arccos(np.clip(abs(np.sum(clip.rotations[1:] * clip.rotations[:-1], axis=-1)), 0, 1))
    fastest = np.degrees(turns).max(axis=1)  # the fastest joint's, by frame
    assert np.quantile(fastest, 0.1) < 8
    assert 30 < fastest.max() < 70


def test_random_poses_differ_on_left_and_right() -> None:
    poses = random_poses(np.random.default_rng(0))
    for part in ("lift", "elbow", "thigh", "knee"):
        sides = [poses[:, INDEX[f"{side} {part}"]] for side in ("left", "right")]
        assert abs(np.corrcoef(sides[0], sides[1])[0, 1]) < 0.5, part
        assert all(np.ptp(side) > 0.7 * np.ptp(LIMITS[f"left {part}"]) for side in sides), part


@pytest.mark.parametrize("name", ["reach", "legs", "bend and turn"])
def test_what_one_side_does_in_a_move_the_other_does_too(name: str) -> None:
    angles = [key.angles for key in MOVES[name]]
    parts = {own.removeprefix("left ") for pose in angles for own in pose if own.startswith("left ")}
    assert len(parts) > 5
    for part in parts:
        sides = [[pose[own] for pose in angles if own in pose] for own in (f"left {part}", f"right {part}")]
        assert (min(sides[0]), max(sides[0])) == (min(sides[1]), max(sides[1])), part


def test_the_seed_alone_decides() -> None:
    figure = character(RIGS["T-pose"])
    one, same, other = (motion_range(figure, (), frames=20, seed=seed) for seed in (0, 0, 1))
    assert all(np.array_equal(a.rotations, b.rotations) for a, b in zip(one, same, strict=True))
    assert not np.array_equal(one[-1].rotations, other[-1].rotations)


def test_more_frames_are_of_more_poses() -> None:
    figure = character(RIGS["T-pose"])
    few, some, many = (motion_range(figure, (), frames=frames, seed=0) for frames in (4, 160, 320))
    assert sum(map(len, few)) == sum(map(len, some))
    short = motion_range(figure, (), frames=4, seed=0, short=True)
    assert [clip.name for clip in short] == [clip.name for clip in few]
    assert sum(map(len, short)) < sum(map(len, some)) / 8
    assert len(many) == 2 * len(some)
    assert len({clip.name for clip in many}) == len(many)
    first, second = (next(c for c in many if c.name == f"{RANGE_OF_MOTION}{name}") for name in ("reach", "reach 2"))
    assert not np.array_equal(first.rotations, second.rotations)


def with_jaw() -> tuple[Skeleton, int]:
    """A person with a joint that no body of words has."""
    body = person()
    names, parents = (*body.names, "flap"), np.append(body.parents, body.names.index("Head")).astype(np.int32)
    turns = np.vstack([body.bind_rotations, [1.0, 0, 0, 0]])
    return Skeleton(names, parents, turns, np.vstack([body.bind_translations, [0, 0.05, 0.1]]), 0), len(body.names)


def test_what_the_body_lacks_stays_where_the_users_clips_have_it() -> None:
    skeleton, jaw = with_jaw()
    open_jaw = rotation.from_axis_angle(np.array([1.0, 0, 0]), 0.4)
    clip = still(skeleton, 10)
    clip.rotations[:, jaw] = open_jaw
    held = joined(motion_range(character(skeleton), [clip], frames=20, seed=0))
    np.testing.assert_allclose(abs(held.rotations[:, jaw] @ open_jaw), 1, atol=1e-9)
    clip.rotations[5:, jaw] = rotation.from_axis_angle(np.array([1.0, 0, 0]), 0.6)
    swung = joined(motion_range(character(skeleton), [clip], frames=20, seed=0))
    assert abs(swung.rotations[:, jaw] @ open_jaw).min() < np.cos(np.radians(5))


def test_bones_are_as_long_as_in_the_users_clips() -> None:
    """Otherwise clips made for a longer arm would seem to stretch it, and every joint would count as translated."""
    skeleton = RIGS["A-pose"]
    clip, hand = still(skeleton, 10), skeleton.names.index("LeftHand")
    clip.translations[:, hand] *= 1.3
    made = joined(motion_range(character(skeleton), [clip], frames=20, seed=0))
    np.testing.assert_allclose(made.translations[:, hand], np.tile(clip.translations[0, hand], (len(made), 1)))


def animal() -> Skeleton:
    """The skeleton of a person on all fours, as animals are named."""
    skeleton = person()
    turn = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
    turns = skeleton.bind_rotations.copy()
    turns[0] = rotation.multiply(turn, turns[0])
    return replace(skeleton, bind_rotations=turns)


def test_whoever_stands_at_ease_breathes_with_lowered_arms_and_ends_as_they_began() -> None:
    for skeleton in RIGS.values():
        (clip,) = standing(character(skeleton))
        turned, at = world(skeleton, clip)
        np.testing.assert_allclose(abs(np.sum(turned[0] * turned[-1], axis=-1)), 1, atol=1e-9)
        np.testing.assert_allclose(at[0], at[-1], atol=1e-9)
        for side in SIDES:
            assert bone(skeleton, clip, f"{side}Arm", f"{side}ForeArm")[:, 1].max() < -np.cos(np.radians(25))
            leg = at[:, skeleton.names.index(f"{side}Foot")]
            assert np.ptp(leg, axis=0).max() < 0.02 * np.ptp(at[0, :, 1])
        chest = skeleton.names.index("Spine2")
        assert 2 < np.degrees(2 * np.arccos(abs(np.sum(turned[0, chest] * turned[:, chest], axis=-1)).min())) < 8
    assert standing(character(animal())) == []


def test_each_joint_of_an_animal_moves_alone_and_with_others() -> None:
    skeleton = animal()
    names = ("HeadTop_End", "LeftToe_End", "RightToe_End", "LeftHandMiddle1", "RightHandMiddle1")
    made = motion_range(character(skeleton, without_skin=names), (), frames=FRAMES, seed=0)
    assert [clip.name.removeprefix(RANGE_OF_MOTION) for clip in made] == [
        "joints alone",
        "joints together",
        "joints together 2",
    ]
    away = [2 * np.degrees(np.arccos(np.clip(abs(np.sum(c.rotations * c.rotations[:1], axis=-1)), 0, 1))) for c in made]
    for joint, name in enumerate(skeleton.names):
        if name in names:
            assert max(turns[:, joint].max() for turns in away) == 0
        elif joint != skeleton.root:
            assert all(turns[:, joint].max() > 15 for turns in away), name
    assert np.quantile(np.count_nonzero(away[0] > 1, axis=1), 0.9) <= 2  # one goes back while the next begins
    assert np.median(np.count_nonzero(away[1] > 1, axis=1)) > 10
    assert 20 < max(turns[:, skeleton.root].max() for turns in away[1:]) < 90


def test_angles_that_no_joint_has_are_refused() -> None:
    keys = [replace(MOVES["walk"][0], angles={"left elbwo": 3.0})]
    with pytest.raises(KeyError, match="elbwo"):
        played("walk", keys)
