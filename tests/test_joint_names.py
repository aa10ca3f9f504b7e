"""Body parts behind joint names of many habits, and how chains of different length pair up."""

from pathlib import Path

import numpy as np
import pytest

from mua.errors import InputError
from mua.motion.joint_names import match_joints, read_mapping, roles
from mua.rig.skeleton import Skeleton

LEG = ("left thigh", "left shin", "left foot", "left toe")
ARM = ("left shoulder", "left upper_arm", "left forearm", "left hand")


def chain(*names: str) -> Skeleton:
    parents = np.arange(-1, len(names) - 1, dtype=np.int32)
    return Skeleton(names, parents, np.tile([1.0, 0, 0, 0], (len(names), 1)), np.ones((len(names), 3)), root=0)


def pairs(source: Skeleton, target: Skeleton, mapping: dict[str, str] | None = None) -> dict[str, tuple[str, str]]:
    found = match_joints(source, target, mapping)
    return {target.names[t]: (source.names[a], source.names[b]) for t, (a, b) in found.items()}


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot", "mixamorig:LeftToeBase"), LEG),
        (("mixamorig:LeftShoulder", "mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand"), ARM),
        (("lfemur", "ltibia", "lfoot", "ltoes"), LEG),
        (("lclavicle", "lhumerus", "lradius", "lhand"), ARM),
        (("left_hip", "left_knee", "left_ankle", "left_foot"), LEG),
        (("left_collar", "left_shoulder", "left_elbow", "left_wrist"), ARM),
        (("thigh_l", "calf_l", "foot_l", "ball_l"), LEG),
        (("clavicle_l", "upperarm_l", "lowerarm_l", "hand_l"), ARM),
        (("thigh.L", "shin.L", "foot.L", "toe.L"), LEG),
        (("shoulder.L", "upper_arm.L", "forearm.L", "hand.L"), ARM),
        (("DEF-thigh.L_023", "DEF-shin.L_025", "DEF-foot.L_027", "DEF-toe.L_028"), LEG),
        (("LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes"), LEG),
        (("LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand"), ARM),
        (("J_Bip_L_Shoulder", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand"), ARM),
        (("Bip01 L Clavicle", "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand"), ARM),
        (("Armature|leftshoulder", "leftarm", "leftforearm", "lefthand"), ARM),
    ],
)
def test_knows_limbs_by_many_names(names: tuple[str, ...], expected: tuple[str, ...]) -> None:
    found = roles(chain("Hips", *names))
    assert [found[role] for role in expected] == [(1,), (2,), (3,), (4,)]
    mirrored = tuple(
        name.replace("left", "right").replace("Left", "Right").replace("_l", "_r").replace(".L", ".R") for name in names
    )
    if mirrored != names and "Bip" not in names[0]:
        assert {role.replace("left", "right") for role in expected} <= set(roles(chain("Hips", *mirrored)))


@pytest.mark.parametrize(
    "name", ["MCH-thigh.L", "upperarm_twist_l", "LeftToeEnd", "lhipjoint", "IK_foot.L", "L_R_arm", ""]
)
def test_does_not_guess(name: str) -> None:
    assert set(roles(chain("Hips", name))) == {"hips"}


def test_takes_the_root_for_hips_without_a_name() -> None:
    assert roles(chain("root", "thing"))["hips"] == (0,)
    assert roles(chain("root", "pelvis"))["hips"] == (1,)


def test_knows_fingers() -> None:
    for names in (
        ("LeftHandThumb1", "LeftHandThumb2", "LeftHandThumb3"),
        ("thumb_01_l", "thumb_02_l", "thumb_03_l"),
        ("left_thumb1", "left_thumb2", "left_thumb3"),
        ("LeftThumbProximal", "LeftThumbIntermediate", "LeftThumbDistal"),
    ):
        assert roles(chain("Hips", "LeftHand", *names))["left thumb"] == (2, 3, 4)


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


def test_prefers_the_mapping() -> None:
    source, target = chain("Hips", "Bone", "LeftArm"), chain("Hips", "LeftArm")
    assert pairs(source, target, {"LeftArm": "Bone"})["LeftArm"] == ("Bone", "Bone")


def test_says_so_where_no_name_matches() -> None:
    with pytest.raises(InputError, match=r"Bone1.*LeftArm.*mapping file"):
        match_joints(chain("Bone0", "Bone1"), chain("Hips", "LeftArm"))


def test_rejects_a_mapping_of_unknown_joints() -> None:
    source, target = chain("Hips", "Bone"), chain("Hips", "LeftArm")
    with pytest.raises(InputError, match="target joint 'Nose'"):
        match_joints(source, target, {"Nose": "Bone"})
    with pytest.raises(InputError, match="source joint 'Nose'"):
        match_joints(source, target, {"LeftArm": "Nose"})


def test_reads_a_mapping_from_json_and_toml(tmp_path: Path) -> None:
    (tmp_path / "map.json").write_text('{"LeftArm": "Bone 1"}')
    (tmp_path / "map.toml").write_text('LeftArm = "Bone 1"\n')
    for name in ("map.json", "map.toml"):
        assert read_mapping(tmp_path / name) == {"LeftArm": "Bone 1"}


@pytest.mark.parametrize("text", ["{", "[1]", '{"LeftArm": 3}', '"LeftArm"'])
def test_rejects_a_mapping_file_that_is_no_table_of_names(tmp_path: Path, text: str) -> None:
    (tmp_path / "map.json").write_text(text)
    with pytest.raises(InputError, match=r"map\.json"):
        read_mapping(tmp_path / "map.json")


def test_rejects_an_absent_mapping_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"absent\.toml"):
        read_mapping(tmp_path / "absent.toml")
