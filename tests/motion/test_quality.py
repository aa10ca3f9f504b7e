"""What is measured of a clip on a character is what was done to it: limbs turned, a body turned, feet moved."""

from dataclasses import replace

import numpy as np
import pytest
from people import person, retarget, still, upright, walk, with_fingers, world
from scipy.spatial.transform import Rotation

from mua import rotation
from mua.motion.head_and_hands import head_flaws
from mua.motion.match import match_joints
from mua.motion.quality import MotionQuality, measure_motion
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

ANGLE_BOUND = 1e-4  # degrees: chains of at most 12 joints in double precision


def measured(skeleton: Skeleton, source: Clip, clip: Clip) -> MotionQuality:
    return measure_motion(SourceMotion(skeleton, source), skeleton, clip, match_joints(skeleton, skeleton))


def turned(skeleton: Skeleton, clip: Clip, joint: str, axis: str, degrees: float) -> Clip:
    """The clip with a joint of plain axes turned in its parent's space in every frame."""
    rotations = clip.rotations.copy()
    j = skeleton.names.index(joint)
    rotations[:, j] = rotation.multiply(
        Rotation.from_euler(axis, degrees, degrees=True).as_quat(scalar_first=True), rotations[:, j]
    )
    return replace(clip, rotations=rotations)


def path(clip: Clip) -> np.ndarray:
    """Where the hips, which nothing is above, stand in each frame, [F, 3] metres."""
    return clip.translations[:, 0]


def led(clip: Clip, along: np.ndarray) -> Clip:
    """The clip with its hips at `along` [F, 3] metres."""
    return replace(clip, translations=np.concatenate([along[:, None], clip.translations[:, 1:]], axis=1))


def test_finds_nothing_wrong_where_nothing_was_changed() -> None:
    skeleton = person()
    clip = walk(skeleton)
    found = measured(skeleton, clip, clip)
    assert found.name == clip.name
    assert found.limb_degrees < ANGLE_BOUND
    assert found.facing_degrees == pytest.approx(0, abs=5)
    assert found.feet_height == pytest.approx(0, abs=0.02)
    assert found.slide == pytest.approx(0, abs=0.05)
    assert found.flaws == ()


def test_another_heading_of_the_whole_is_no_fault() -> None:
    source, target = person(), person(size=1.4, axes=2)
    clip, _ = retarget(SourceMotion(source, walk(source)), target)
    turn = Rotation.from_euler("y", 130, degrees=True).as_quat(scalar_first=True)
    rotations = clip.rotations.copy()
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    clip = led(replace(clip, rotations=rotations), rotation.rotate(turn, path(clip)))
    found = measure_motion(SourceMotion(source, walk(source)), target, clip, match_joints(source, target))
    assert found.limb_degrees < ANGLE_BOUND
    assert found.flaws == ()
    ahead, _ = retarget(SourceMotion(source, walk(source)), target)
    straight = measure_motion(SourceMotion(source, walk(source)), target, ahead, match_joints(source, target))
    assert found.facing_degrees == pytest.approx(straight.facing_degrees, abs=ANGLE_BOUND)


def test_measures_a_limb_that_points_elsewhere_and_names_it() -> None:
    skeleton = person()
    clip = walk(skeleton)
    found = measured(skeleton, clip, turned(skeleton, clip, "LeftForeArm", "y", 25))
    assert found.limb_degrees == found.limbs["left forearm"]
    assert found.limb_degrees == pytest.approx(25, abs=5)
    assert found.limbs["right thigh"] < 5
    assert "left forearm" in found.flaws[0]


def test_names_the_limb_that_is_farthest_off_first() -> None:
    skeleton = person()
    clip = walk(skeleton)
    both = turned(skeleton, turned(skeleton, clip, "LeftForeArm", "y", 25), "RightForeArm", "y", 50)
    flaw = measured(skeleton, clip, both).flaws[0]
    assert 0 < flaw.index("right forearm") < flaw.index("left forearm")


@pytest.mark.parametrize("joint", ["Spine", "Hips"])
def test_measures_a_torso_that_is_turned_away_from_the_travel(joint: str) -> None:
    skeleton = person()
    clip = walk(skeleton)
    found = measured(skeleton, clip, turned(skeleton, clip, joint, "y", 90))
    assert found.facing_degrees == pytest.approx(90 if joint == "Hips" else 45, abs=5)
    assert any("faces 90 degrees away" in flaw for flaw in found.flaws)


def test_a_twist_that_the_motion_has_too_is_no_fault() -> None:
    skeleton = person()
    twisted = turned(skeleton, walk(skeleton), "Spine", "y", 60)
    assert measured(skeleton, twisted, twisted).flaws == ()


def test_has_no_facing_for_a_clip_that_goes_nowhere_or_backwards() -> None:
    skeleton = person()
    clip = walk(skeleton)
    standing = led(clip, path(clip) * [0, 1, 0])
    backwards = led(clip, path(clip) * [1, 1, -1])
    assert measured(skeleton, standing, standing).facing_degrees is None
    assert measured(skeleton, backwards, backwards).facing_degrees is None


def test_has_no_facing_for_a_body_upside_down() -> None:
    skeleton = person()
    wheeling = turned(skeleton, walk(skeleton), "Hips", "x", 180)
    assert measured(skeleton, wheeling, wheeling).facing_degrees is None


@pytest.mark.parametrize(("lift", "words"), [(-0.3, "0.30 m below the floor"), (0.5, "0.50 m above the floor")])
def test_measures_feet_off_the_floor(lift: float, words: str) -> None:
    skeleton = person()
    clip = walk(skeleton)
    moved = led(clip, path(clip) + np.array([0, lift, 0]))
    found = measured(skeleton, clip, moved)
    assert found.feet_height == pytest.approx(lift, abs=0.02)
    assert any(words in flaw for flaw in found.flaws)


def test_measures_feet_that_slide_where_the_source_stands() -> None:
    skeleton = person()
    clip = walk(skeleton)
    slower = led(clip, path(clip) * [1, 1, 0.5])
    found = measured(skeleton, clip, slower)
    speed = np.ptp(world(skeleton, clip)[1][:, 0, 2]) / (len(clip) - 1) * clip.rate
    assert found.slide == pytest.approx(speed / 2, rel=0.15)
    assert any("slide" in flaw for flaw in found.flaws)


def test_measures_what_there_is_of_a_body() -> None:
    half = upright(("Hips", "Spine"), (-1, 0), [[0, 1.0, 0], [0, 0.5, 0]])
    clip = still(half)
    found = measured(half, clip, clip)
    assert (found.limb_degrees, found.facing_degrees, found.feet_height, found.slide) == (0, None, None, None)


@pytest.mark.parametrize(("nod", "expected"), [(-40, 40), (40, -40), (0, 0)])
def test_a_head_that_looks_elsewhere_than_in_the_motion_is_measured(nod: float, expected: float) -> None:
    skeleton = person()
    clip = walk(skeleton)
    found = measured(skeleton, clip, turned(skeleton, clip, "Head", "x", nod))
    assert found.head_degrees == pytest.approx(expected, abs=0.1)
    says = [flaw for flaw in found.flaws if "the head looks" in flaw]
    way = "upward" if expected > 0 else "downward"
    assert says == ([] if not nod else [f"walk: the head looks 40 degrees {way}; in the motion 0 degrees downward."])


def test_a_head_that_stares_upward_is_said_where_the_motion_does_not_tell() -> None:
    assert head_flaws("dance", 40.0, None) == ["dance: the head looks 40 degrees upward in half of the frames."]
    assert head_flaws("bows", -50.0, None) == head_flaws("still", 3.0, None) == head_flaws("lies", None, 2.0) == []


def test_a_hand_that_is_turned_otherwise_is_measured_by_its_palm() -> None:
    skeleton = with_fingers(person())
    clip = still(skeleton, 30)
    found = measured(skeleton, clip, turned(skeleton, clip, "LeftHand", "x", 60))
    assert found.hands == pytest.approx({"left hand": 60, "right hand": 0}, abs=ANGLE_BOUND)
    assert "still: hands are turned otherwise than in the motion (degrees: left hand 60)." in found.flaws
    assert found.worst_hand == pytest.approx(60, abs=ANGLE_BOUND)
    assert measured(person(), walk(person()), walk(person())).worst_hand is None
