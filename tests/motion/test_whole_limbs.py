"""Limbs of which names give only some parts, split by the lengths of their bones."""

from dataclasses import replace

import numpy as np
import pytest
from people import ANGLE_BOUND, bone, person, retarget, upright, walk, world

from mua.motion.limb_parts import ARM, LEG, parts_of
from mua.motion.match import match_joints
from mua.motion.source_motion import SourceMotion
from mua.pose.skeleton import Skeleton


def line(*bones: float) -> np.ndarray:
    """Joints in a row, whose bones have these lengths."""
    return np.cumsum([0.0, *bones])[:, None] * [1.0, 0, 0]


@pytest.mark.parametrize(
    ("bones", "expected"),
    [
        ((0.15, 0.28, 0.25, 0.1, 0.09), (1, 2, 3, 4)),  # a long collar bone, as short figures have it
        ((0.28, 0.25, 0.18), (0, 1, 2, 3)),
        ((0.28, 0.25), (0, 1, 2)),
        ((0.13, 0.13, 0.12, 0.12, 0.1), (0, 2, 4, 5)),  # twist joints
    ],
)
def test_finds_the_upper_arm_behind_collar_bones_and_twist_joints(
    bones: tuple[float, ...], expected: tuple[int, ...]
) -> None:
    assert parts_of(line(*bones), tuple(range(len(bones) + 1)), ARM) == expected


def test_a_joint_that_bends_over_the_frames_begins_a_part() -> None:
    """A collar bone from the middle of the chest is longer than the upper arm: only its bend distinguishes them."""
    lengths = (0.09, 0.16, 0.2, 0.24, 0.1)
    bent = [line(*lengths), line(*lengths)]
    bent[1][3:] = bent[1][2] + np.cumsum(lengths[2:])[:, None] * [0.8, 0.6, 0]
    assert parts_of(np.stack(bent[:1] * 2), tuple(range(6)), ARM, end=4) == (1, 3, 4, 5)
    assert parts_of(np.stack(bent), tuple(range(6)), ARM, end=4) == (2, 3, 4, 5)


def test_finds_the_thigh_beside_the_pelvis() -> None:
    assert parts_of(line(0.1, 0.27, 0.27, 0.09, 0.05), tuple(range(6)), LEG) == (1, 2, 3, 4)


def test_finds_no_limb_in_what_has_no_limbs_proportions() -> None:
    assert parts_of(line(0.1, 0.1, 1.0), tuple(range(4)), ARM) is None
    assert parts_of(line(0, 0, 0), tuple(range(4)), ARM) is None


NUMBERED = {
    **{part: f"arm_joint_{i}" for i, part in enumerate(("Arm", "ForeArm", "Hand", "HandMiddle1"))},
    **{part: f"leg_joint_{i}" for i, part in enumerate(("UpLeg", "Leg", "Foot", "ToeBase", "Toe_End"))},
}
WITHOUT_ELBOW = {"Shoulder": "Clav", "Arm": "Shoulder", "ForeArm": "Arm", "Hand": "Wrist"}


def called(skeleton: Skeleton, parts: dict[str, str]) -> Skeleton:
    """The skeleton with other names of parts on both sides, without collar bones' names where these say nothing."""
    names = {f"{side}{part}": f"{name}_{side[0]}" for side in ("Left", "Right") for part, name in parts.items()}
    return replace(skeleton, names=tuple(names.get(name, name) for name in skeleton.names))


@pytest.mark.parametrize("parts", [NUMBERED, WITHOUT_ELBOW])
def test_motion_goes_onto_limbs_whose_names_give_only_some_parts(parts: dict[str, str]) -> None:
    source, target = person(), called(person(size=1.2), parts)
    found, notes = retarget(SourceMotion(source, walk(source)), target)
    expected, _ = retarget(SourceMotion(source, walk(source)), person(size=1.2))
    np.testing.assert_allclose(world(target, found)[1], world(target, expected)[1], atol=1e-9)
    assert any("by the lengths of the bones" in note and "left forearm" in note for note in notes)


def test_arms_with_twist_joints_and_no_hands_bend_at_their_elbows() -> None:
    """As Rigify's deform bones, of a figure whose arms end in stumps."""
    whole = person()
    keep = [i for i, name in enumerate(whole.names) if not name.endswith(("Hand", "HandMiddle1"))]
    names, parents, offsets = list(map(whole.names.__getitem__, keep)), [], []
    for joint in keep:
        parent = int(whole.parents[joint])
        parents.append(keep.index(parent) if parent >= 0 else -1)
        offsets.append(whole.bind_translations[joint])
    for side in ("Left", "Right"):
        for part, end in (("Arm", "ForeArm"), ("ForeArm", "Hand")):
            parents.append(names.index(side + part))
            names.append(f"{side}{part}.001")
            offsets.append(whole.bind_translations[whole.names.index(side + end)] / 2)
        parents[names.index(f"{side}ForeArm")] = names.index(f"{side}Arm.001")
        offsets[names.index(f"{side}ForeArm")] = offsets[names.index(f"{side}Arm.001")]
    stumps = sorted_by_parents(names, parents, offsets)
    found, notes = retarget(SourceMotion(whole, walk(whole)), stumps)
    assert not any("by the lengths" in note for note in notes)
    for side in ("Left", "Right"):
        ends = (f"{side}Arm", f"{side}ForeArm")
        np.testing.assert_allclose(bone(stumps, found, *ends), bone(whole, walk(whole), *ends), atol=ANGLE_BOUND)
        np.testing.assert_allclose(
            bone(stumps, found, f"{side}ForeArm", f"{side}ForeArm.001"),
            bone(whole, walk(whole), f"{side}ForeArm", f"{side}Hand"),
            atol=ANGLE_BOUND,
        )


def sorted_by_parents(names: list[str], parents: list[int], offsets: list[np.ndarray]) -> Skeleton:
    """Parents before children."""
    order: list[int] = []
    while len(order) < len(names):
        order += [i for i, parent in enumerate(parents) if i not in order and (parent < 0 or parent in order)]
    return upright(
        [names[i] for i in order],
        [order.index(parents[i]) if parents[i] >= 0 else -1 for i in order],
        [offsets[i] for i in order],
    )


def test_names_go_before_lengths() -> None:
    assert not match_joints(person(), person()).notes


def test_a_limb_of_one_bone_stays_one() -> None:
    names = ("Hips", "Spine", "Arm_L", "Arm_R", "Hand_L", "Hand_R", "tip_L", "tip_R")
    at = [(0, 1, 0), (0, 0.4, 0), (0.2, 0, 0), (-0.2, 0, 0), (0.5, 0, 0), (-0.5, 0, 0), (0.1, 0, 0), (-0.1, 0, 0)]
    block = upright(names, [-1, 0, 1, 1, 2, 3, 4, 5], at)
    assert "left forearm" not in match_joints(block, block).roles


def test_a_motion_without_names_is_recognised_by_its_frames_where_its_rest_pose_is_no_person() -> None:
    """All bones of the rest pose point one way: only the frames show a body."""
    whole = person()
    clip = walk(whole)
    along = np.linalg.norm(whole.bind_translations, axis=-1)[:, None] * [0.0, 1, 0]
    hidden = replace(whole, names=tuple(f"joint{i}" for i in range(len(whole.names))), bind_translations=along)
    frames = world(whole, clip)[1][::6]
    roles = match_joints(hidden, whole, source_poses=frames)
    assert roles.ends("left forearm") == (whole.names.index("LeftForeArm"),) * 2
    assert roles.ends("right shin") == (whole.names.index("RightLeg"),) * 2


def test_a_hip_beside_the_pelvis_is_no_part_of_the_thigh_though_its_name_says_so() -> None:
    """LHipJoint and LeftHip of CMU's motion: the thigh begins at the second."""
    whole = person()
    hips = [whole.names.index(name) for name in ("LeftUpLeg", "RightUpLeg")]
    names = [*whole.names, "LHipJoint", "RHipJoint"]
    parents, places = [*whole.parents.tolist(), 0, 0], [*whole.bind_translations, (0, 0, 0), (0, 0, 0)]
    for helper, hip in enumerate(hips, start=len(whole.names)):
        names[hip], parents[hip] = f"{names[hip][:-5]}Hip", helper
    order = [0, len(names) - 2, len(names) - 1, *range(1, len(names) - 2)]
    skeleton = upright(
        [names[j] for j in order],
        [order.index(parents[j]) if parents[j] >= 0 else -1 for j in order],
        [places[j] for j in order],
    )
    roles = match_joints(skeleton, skeleton).roles
    assert [skeleton.names[joint] for joint in roles["left thigh"]] == ["LeftHip"]
    assert [skeleton.names[joint] for joint in roles["right thigh"]] == ["RightHip"]


def test_twist_joints_of_a_thick_arm_stay_a_part_of_it() -> None:
    """Upper arms of two bones and short forearms: the lengths alone would begin the arm at the second bone."""
    bones = {"arm": 0.2, "arm_twist": 0.12, "forearm": 0.12, "hand": 0.1}
    names, parents, places = ["hips", "spine"], [-1, 0], [(0.0, 1, 0), (0, 0.5, 0)]
    for side, out in (("left", 1), ("right", -1)):
        for above, (part, length) in enumerate(bones.items()):
            names.append(f"{side}_{part.replace('_twist', '')}{above if 'twist' in part else ''}")
            parents.append(len(names) - 2 if above else 1)
            places.append((out * length, 0, 0))
    skeleton = upright(names, parents, places)
    arm = [skeleton.names[joint] for joint in match_joints(skeleton, skeleton).roles["left upper_arm"]]
    assert arm == ["left_arm", "left_arm1"]
