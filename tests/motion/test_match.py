"""How chains of joints pair up, what is left over, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from people import chain, person, upright, walk

from mua.errors import InputError
from mua.motion.match import joint_pairs, match_joints, require_limbs, unmatched_target
from mua.pose.skeleton import Skeleton


def pairs(source: Skeleton, target: Skeleton, mapping: dict[str, str] | None = None) -> dict[str, tuple[str, str]]:
    found = match_joints(source, target, mapping).chains
    return {target.names[t]: (source.names[a], source.names[b]) for t, (a, b) in found.items()}


def test_composes_several_source_joints_into_one() -> None:
    source = chain("root", "lowerback", "upperback", "thorax", "lowerneck", "upperneck", "head")
    target = chain("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head")
    assert pairs(source, target) == {
        "Hips": ("root", "root"),
        "Spine": ("lowerback", "lowerback"),
        "Spine1": ("upperback", "upperback"),
        "Spine2": ("thorax", "thorax"),
        "Neck": ("lowerneck", "upperneck"),
        "Head": ("head", "head"),
    }


def test_shares_spines_of_other_lengths_in_proportion() -> None:
    four = chain("Hips", "Spine", "Spine1", "Spine2", "Spine3", "Head")
    two = chain("Hips", "Spine", "Chest", "Head")
    assert pairs(four, two)["Spine"] == ("Spine", "Spine1")
    assert pairs(four, two)["Chest"] == ("Spine2", "Spine3")
    assert pairs(two, four)["Spine1"] == ("Spine", "Spine")
    assert pairs(two, four)["Spine3"] == ("Chest", "Chest")


def test_matches_unknown_names_that_are_equal() -> None:
    assert pairs(chain("Hips", "b_Tail_01"), chain("Hips", "rig:b_tail_01"))["rig:b_tail_01"] == ("b_Tail_01",) * 2


def test_a_thumb_without_fingers_moves_nothing() -> None:
    target = chain("LeftHand", "LeftHandThumb1", "LeftHandThumb2")
    assert pairs(chain("lwrist", "lthumb"), target) == {"LeftHand": ("lwrist", "lwrist")}
    beside_fingers = pairs(chain("lwrist", "lthumb", "lindex"), target)
    assert beside_fingers["LeftHandThumb1"] == ("lthumb", "lthumb")


def test_prefers_the_mapping() -> None:
    source, target = chain("Hips", "Bone", "LeftArm"), chain("Hips", "LeftArm")
    assert pairs(source, target, {"LeftArm": "Bone"})["LeftArm"] == ("Bone", "Bone")


def test_says_so_where_no_name_matches() -> None:
    source, target = chain("Bone0", "Bone1"), chain("Hips", "LeftArm")
    with pytest.raises(InputError, match=r"no joint name of it matches .* mapping file") as refused:
        require_limbs(source, target, match_joints(source, target))
    assert refused.value.details == "joints of the motion: Bone0, Bone1\njoints of the character: Hips, LeftArm"


def test_rejects_a_mapping_of_unknown_joints() -> None:
    source, target = chain("Hips", "Bone"), chain("Hips", "LeftArm")
    with pytest.raises(InputError, match="target joint 'Nose'"):
        match_joints(source, target, {"Nose": "Bone"})
    with pytest.raises(InputError, match="source joint 'Nose'"):
        match_joints(source, target, {"LeftArm": "Nose"})


def test_lists_pairs_and_what_is_left_over() -> None:
    source, target = chain("root", "lowerback", "thorax", "Prop", "Prop_end"), chain("Hips", "Spine", "Tail")
    matches = match_joints(source, target)
    listed = [(pair.target, pair.source, pair.role) for pair in joint_pairs(source, target, matches)]
    assert listed == [("Hips", "root", "hips"), ("Spine", "lowerback", "spine")]
    assert unmatched_target(target, matches, [0, 2]) == ("Tail",)
    assert unmatched_target(target, matches, [0, 1]) == ()


def renamed(skeleton: Skeleton, **names: str) -> Skeleton:
    """The skeleton with parts of its joint names replaced."""
    given = tuple(skeleton.names)
    for old, new in names.items():
        given = tuple(name.replace(old, new) for name in given)
    return replace(skeleton, names=given)


def in_one_place(skeleton: Skeleton) -> Skeleton:
    """The skeleton without lengths or places by which its joints could be recognised."""
    return replace(skeleton, bind_translations=np.zeros_like(skeleton.bind_translations))


def other_habit(skeleton: Skeleton) -> Skeleton:
    """The skeleton with joint names none of which equals its own."""
    return replace(skeleton, names=tuple(f"mixamorig_{name}" for name in skeleton.names))


@pytest.mark.parametrize(
    ("hidden", "words"),
    [
        ({"LeftUpLeg": "a", "RightUpLeg": "b"}, "left leg and right leg"),
        ({"RightForeArm": "c"}, "the right arm of"),
        ({"Spine": "d", "LeftShoulder": "e", "LeftArm": "f", "LeftForeArm": "g"}, "the left arm and spine of"),
    ],
)
def test_refuses_where_a_limb_or_the_spine_is_missing_and_points_at_the_mapping(
    hidden: dict[str, str], words: str
) -> None:
    whole, hiding = (in_one_place(skeleton) for skeleton in (other_habit(person()), renamed(person(), **hidden)))
    for source, target in ((hiding, whole), (whole, hiding)):
        with pytest.raises(InputError, match=rf"{words}.*--mapping"):
            require_limbs(source, target, match_joints(source, target))


def test_asks_no_limbs_of_rigs_of_one_kind_and_of_whole_people() -> None:
    fox = chain("b_Root", "b_Hip", "b_Leg01", "b_Tail01", "b_Tail02")
    require_limbs(fox, fox, match_joints(fox, fox))
    require_limbs(person(), other_habit(person()), match_joints(person(), other_habit(person())))


def block_figure(*more: tuple[str, str]) -> Skeleton:
    """Arms and legs of one bone each, and `more` joints with their parents."""
    joints = [
        *(("Root", ""), ("Hips", "Root"), ("Spine", "Hips"), ("Head", "Spine")),
        *((f"{part}_{side}", above) for side in "LR" for part, above in (("Arm", "Spine"), ("Leg", "Hips"))),
        *more,
    ]
    names = tuple(name for name, _ in joints)
    parents = [names.index(above) if above else -1 for _, above in joints]
    return upright(names, parents, np.ones((len(names), 3)), root=1)


@pytest.mark.parametrize("end", ["", "_end", "_end_07"])  # none, Blender's, and Sketchfab's with a number after it
def test_limbs_of_one_bone_follow_the_upper_one(end: str) -> None:
    limbs = ("Arm_L", "Arm_R", "Leg_L", "Leg_R") if end else ()
    block = block_figure(*((f"{limb}{end}", limb) for limb in limbs))
    matches = match_joints(person(), block)
    require_limbs(person(), block, matches)
    moved = {block.names[joint]: person().names[first] for joint, (first, _) in matches.chains.items()}
    assert {moved[name] for name in ("Arm_L", "Arm_R")} == {"LeftArm", "RightArm"}
    assert {moved[name] for name in ("Leg_L", "Leg_R")} == {"LeftUpLeg", "RightUpLeg"}


def test_a_limb_that_goes_on_in_an_unknown_joint_is_still_asked_for() -> None:
    block = block_figure(("Leg_L_end", "Leg_L"), ("Tube_R", "Leg_R"))
    with pytest.raises(InputError, match="move the right leg of"):
        require_limbs(person(), block, match_joints(person(), block))


def test_a_mapped_joint_takes_the_role_of_what_moves_it() -> None:
    source, target = person(), renamed(other_habit(person()), LeftForeArm="Tube")
    matches = match_joints(source, target, {"mixamorig_Tube": "LeftForeArm"})
    assert matches.ends("left forearm") == (target.names.index("mixamorig_Tube"), source.names.index("LeftForeArm"))
    require_limbs(source, target, matches)


def test_roles_of_the_file_match_joints_whose_names_say_nothing() -> None:
    source, target = person(), renamed(other_habit(person()), LeftForeArm="Tube")
    matches = match_joints(source, target, target_stated={"mixamorig_Tube": "left forearm"})
    assert matches.ends("left forearm") == (target.names.index("mixamorig_Tube"), source.names.index("LeftForeArm"))


def test_what_a_file_says_of_its_joints_goes_before_their_names() -> None:
    named = chain("Hips", "Spine", "Neck", "Head")
    odd = chain("bone1", "bone2", "bone3", "bone4")
    said = {"bone1": "hips", "bone2": "spine", "bone3": "neck", "bone4": "head"}
    alike = dict(enumerate(zip(range(4), range(4), strict=True)))
    assert match_joints(named, odd, target_stated=said).chains == alike
    assert match_joints(odd, named, source_stated=said).chains == alike
    crossed = match_joints(named, named, target_stated={"Neck": "head", "Head": "neck"})
    assert crossed.chains == alike | {2: (3, 3), 3: (2, 2)}
    assert crossed.roles["spine"] == (1,)


def test_a_walk_whose_names_are_swapped_moves_the_side_that_its_body_has() -> None:
    source = person()
    other = {"Left": "Right", "Right": "Left"}
    names = tuple(
        next((other[side] + name.removeprefix(side) for side in other if name.startswith(side)), name)
        for name in source.names
    )
    clip = walk(source)
    _, poses = source.world(clip.rotations, clip.translations)
    found = match_joints(replace(source, names=names), person(), source_poses=poses)
    thigh = person().names.index("LeftUpLeg")
    assert names[found.chains[thigh][0]] == "RightUpLeg"
    assert any("left and right are exchanged" in note for note in found.notes)
    assert match_joints(source, person(), source_poses=poses).notes == ()
