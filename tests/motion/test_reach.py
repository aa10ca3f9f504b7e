"""Hands and feet that are not where the motion has them are found whichever joints were paired."""

from dataclasses import replace

import pytest
from people import person, retarget, walk

from mua.motion.match import match_joints
from mua.motion.quality import MotionQuality, measure_motion
from mua.motion.reach import WRONG
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton


def sitting(skeleton: Skeleton) -> Clip:
    """A clip with elbows and knees that are bent by a right angle."""
    clip = walk(skeleton)
    rotations = clip.rotations.copy()
    for joint in ("LeftForeArm", "RightForeArm", "LeftLeg", "RightLeg"):
        rotations[:, skeleton.names.index(joint)] = (
            (2**-0.5, 0, 2**-0.5, 0) if "Arm" in joint else (2**-0.5, 2**-0.5, 0, 0)
        )
    return replace(clip, rotations=rotations)


def measured(target: Skeleton, mapping: dict[str, str] | None = None) -> MotionQuality:
    source = SourceMotion(person(), sitting(person()))
    clip, _ = retarget(source, target, mapping=mapping)
    return measure_motion(source, target, clip, match_joints(source.skeleton, target, mapping))


def test_hands_and_feet_of_right_pairs_are_where_the_motion_has_them() -> None:
    found = measured(person(size=1.5, arms_down=40, axes=2))
    assert {limb.limb for limb in found.reach} == {
        f"{side} {end}" for side in ("left", "right") for end in ("hand", "foot")
    }
    assert found.worst_reach == pytest.approx(0, abs=1e-6)
    assert found.flaws == ()


@pytest.mark.parametrize(
    ("mapping", "hand"),
    [
        ({"LeftForeArm": "LeftArm"}, "left hand"),
        ({"LeftArm": "LeftShoulder", "LeftForeArm": "LeftArm", "LeftHand": "LeftForeArm"}, "left hand"),
        ({"RightLeg": "RightUpLeg", "RightFoot": "RightLeg"}, "right foot"),
    ],
)
def test_a_wrong_pair_shows_where_the_limb_ends_and_names_the_joints(mapping: dict[str, str], hand: str) -> None:
    found = measured(person(), mapping)
    wrong = [limb for limb in found.reach if limb.share > WRONG]
    assert [limb.limb for limb in wrong] == [hand]
    assert all(limb.share < 0.05 for limb in found.reach if limb.limb != hand)
    (flaw,) = (flaw for flaw in found.flaws if "A pair of joints may be wrong" in flaw)
    assert f"the {hand} is {wrong[0].metres:.2f} m from where the motion has it" in flaw
    assert " to ".join(wrong[0].character) in flaw


def test_joints_of_one_name_for_the_whole_arm_do_not_hide_that_it_stays_straight() -> None:
    """Pairs alone would not show it: an arm moved as one piece agrees with its upper part."""
    arm = {"LeftArm": "LeftArm", "LeftForeArm": "LeftArm", "LeftHand": "LeftArm"}
    found = measured(person(), arm)
    assert max(limb.share for limb in found.reach if limb.limb == "left hand") > WRONG


def test_measures_limbs_whose_names_say_nothing_from_shoulder_to_fingers() -> None:
    target = person()
    names = tuple(f"joint{i}" for i in range(len(target.names)))
    found = measured(replace(target, names=names))
    hand = next(limb for limb in found.reach if limb.limb == "left hand")
    assert hand.character[0] == names[target.names.index("LeftArm")]
    assert hand.motion == ("LeftArm", "LeftHand")
