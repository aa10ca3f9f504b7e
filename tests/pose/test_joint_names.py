"""Body parts of joint names in many naming conventions."""

import functools
import re
from dataclasses import replace

import numpy as np
import pytest
from people import chain, upright

from mua.pose.joint_names import roles
from mua.pose.skeleton import Skeleton

LEG = ("left thigh", "left shin", "left foot", "left toe")
ARM = ("left shoulder", "left upper_arm", "left forearm", "left hand")


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot", "mixamorig:LeftToeBase"), LEG),
        (("mixamorig:LeftShoulder", "mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand"), ARM),
        (("lfemur", "ltibia", "lfoot", "ltoes"), LEG),
        (("lclavicle", "lhumerus", "lradius", "lhand"), ARM),
        (("BackLegUpper_L", "BackLegLower_L", "BackLegAnkle_L", "BackLegFoot_L"), LEG),
        (("FrontLegShoulder_L", "FrontLegUpper_L", "FrontLegLower_L", "FrontLegAnkle_L"), ARM),
        (("left_hip", "left_knee", "left_ankle", "left_foot"), LEG),
        (("left_collar", "left_shoulder", "left_elbow", "left_wrist"), ARM),
        (("thigh_l", "calf_l", "foot_l", "ball_l"), LEG),
        (("clavicle_l", "upperarm_l", "lowerarm_l", "hand_l"), ARM),
        (("thigh.L", "shin.L", "foot.L", "toe.L"), LEG),
        (("shoulder.L", "upper_arm.L", "forearm.L", "hand.L"), ARM),
        (("shoulderFBXASC046L", "upper_armFBXASC046L", "forearmFBXASC046L", "handFBXASC046L"), ARM),
        (("DEF-thigh.L_023", "DEF-shin.L_025", "DEF-foot.L_027", "DEF-toe.L_028"), LEG),
        (("LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes"), LEG),
        (("LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand"), ARM),
        (("J_Bip_L_Shoulder", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand"), ARM),
        (("Bip01 L Clavicle", "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand"), ARM),
        (("Armature|leftshoulder", "leftarm", "leftforearm", "lefthand"), ARM),
        (("Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot", "Bip01 L Toe0"), LEG),
        (("ValveBiped.Bip01_L_Thigh", "ValveBiped.Bip01_L_Calf", "ValveBiped.Bip01_L_Foot", "Bip01_L_Toe0"), LEG),
        (("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToe"), LEG),
        (("UpperLeg_L", "LowerLeg_L", "Foot_L", "Toes_L"), LEG),
        (("Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L"), ARM),
        (("LeftHip", "LeftKnee", "LeftAnkle", "LeftToe"), LEG),
        (("LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist"), ARM),
        (("L_Hip", "L_Knee", "L_Ankle", "L_Foot"), LEG),
        (("L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist"), ARM),
        (("HipLeft", "KneeLeft", "AnkleLeft", "FootLeft"), LEG),
        (("CLAVICLE_LEFT", "SHOULDER_LEFT", "ELBOW_LEFT", "WRIST_LEFT"), ARM),
        (("Hip_L", "Knee_L", "Ankle_L", "Toes_L"), LEG),
        (("Left leg", "Left knee", "Left ankle", "Left toe"), LEG),
        (("Scapula_L", "Shoulder_L", "Elbow_L", "Wrist_L"), ARM),
        (("lThighBend", "lShin", "lFoot", "lToe"), LEG),
        (("lCollar", "lShldrBend", "lForearmBend", "lHand"), ARM),
        (("upperleg01.L", "lowerleg01.L", "foot.L", "toe1-1.L"), LEG),
        (("clavicle.L", "upperarm01.L", "lowerarm01.L", "wrist.L"), ARM),
        (("upperleg.l", "lowerleg.l", "foot.l", "toes.l"), LEG),
        (("J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot", "J_Bip_L_ToeBase"), LEG),
        (("CC_Base_L_Thigh", "CC_Base_L_Calf", "CC_Base_L_Foot", "CC_Base_L_ToeBase"), LEG),
        (("UpLeg_L", "LoLeg_L", "Foot_L", "Toe_L"), LEG),
        (("Clavicle_L", "UpArm_L", "LoArm_L", "Hand_L"), ARM),
        (("Skeleton_LThigh", "Skeleton_LShin", "Skeleton_LFoot", "Skeleton_LToe"), LEG),
        (("Skeleton_LShoulder", "Skeleton_LUArm", "Skeleton_LFArm", "Skeleton_LHand"), ARM),
        (("thigh_stretch.l", "leg_stretch.l", "foot.l", "toes_01.l"), LEG),
        (("shoulder.l", "arm_stretch.l", "forearm_stretch.l", "hand.l"), ARM),
        (("J_L_Clavicle", "J_L_Shoulder", "J_L_Elbow", "J_L_Hand"), ARM),
        (("Armature_LeftUpLeg", "Armature_LeftLeg", "Armature_LeftFoot", "Armature_LeftToeBase"), LEG),
        (("def_l_thigh", "def_l_knee", "def_l_ankle", "def_l_ball"), LEG),
        (("char:def_l_clav", "char:def_l_shoulder", "char:def_l_elbow", "char:def_l_wrist"), ARM),
        (("左足", "左ひざ", "左足首", "左つま先"), LEG),
        (("左肩", "左腕", "左ひじ", "左手首"), ARM),
        (("左大腿", "左小腿", "左脚", "左脚趾"), LEG),
        (("左锁骨", "左上臂", "左前臂", "左手"), ARM),
        (("LinkerOberschenkel", "LinkerUnterschenkel", "LinkerFuß", "LinkeZehen"), LEG),
        (("Schulter.L", "Oberarm.L", "Unterarm.L", "Hand.L"), ARM),
        (("MusloIzq", "PiernaIzq", "PieIzq", "DedosIzq"), LEG),
        (("Hombro_izquierdo", "Brazo_izquierdo", "Antebrazo_izquierdo", "Muñeca_izquierda"), ARM),
        (("CuisseGauche", "JambeGauche", "PiedGauche", "OrteilGauche"), LEG),
        (("Épaule.L", "Bras.L", "AvantBras.L", "Main.L"), ARM),
        (("Coscia_sx", "Gamba_sx", "Piede_sx", "Dita_sx"), LEG),
        (("Ombro.L", "Braço.L", "Antebraço.L", "Mão.L"), ARM),
        (("mixamorigLeftUpLeg", "mixamorigLeftLeg", "mixamorigLeftFoot", "mixamorigLeftToeBase"), LEG),
        (("Bip001LClavicle", "Bip001LUpperArm", "Bip001LForearm", "Bip001LHand"), ARM),
        (("thigh_l", "shank_l", "foot_l", "toes_l"), LEG),
        (("clavicle_l", "uarm_l", "larm_l", "hand_l"), ARM),
        (("femur_l", "tibia_l", "calcn_l", "toes_l"), LEG),
        (("clavicle_l", "humerus_l", "ulna_l", "hand_l"), ARM),
        (("LeftUpperLeg", "LeftLowerLeg", "LeftFootAnkle", "LeftFootBall"), LEG),
        (("LeftShoulder", "LeftArmUpper", "LeftArmLower", "LeftHandWrist"), ARM),
        (("LinkerBovenbeen", "LinkerOnderbeen", "LinkerVoet", "LinkerTenen"), LEG),
        (("LewyBark", "LeweRamie", "LewePrzedramie", "LewaDlon"), ARM),
        (("hidari_momo", "hidari_hiza", "hidari_ashikubi", "hidari_tsumasaki"), LEG),
        (("L_legUpper0001_bind_JNT", "L_legLower0001_bind_JNT", "L_foot0001_bind_JNT", "L_foot0002_bind_JNT"), LEG),
        (("L_clavicle_bind_JNT", "L_armUpper0001_bind_JNT", "L_armLower0001_bind_JNT", "L_hand0001_bind_JNT"), ARM),
    ],
)
def test_knows_limbs_by_many_names(names: tuple[str, ...], expected: tuple[str, ...]) -> None:
    found = roles(chain("Hips", *names))
    assert [found[role] for role in expected] == [(1,), (2,), (3,), (4,)]
    swapped = {"left": "right", "Left": "Right", "LEFT": "RIGHT", "_l": "_r", ".l": ".r", ".L": ".R", "_L": "_R"}
    mirrored = tuple(functools.reduce(lambda name, old: name.replace(old, swapped[old]), swapped, n) for n in names)
    mirrored = tuple(re.sub(r"^l(?=[A-Zchfrt])|^L(?=_)", lambda m: "rR"[m[0] == "L"], name) for name in mirrored)
    if mirrored != names and "Bip" not in names[0] and "JNT" not in names[0]:
        assert {role.replace("left", "right") for role in expected} <= set(roles(chain("Hips", *mirrored)))


@pytest.mark.parametrize(
    "name",
    ["MCH-thigh.L", "upperarm_twist_l", "LeftToeEnd", "lhipjoint", "IK_foot.L", "L_R_arm", "左足ＩＫ", "左腕捩", ""],
)
def test_does_not_guess(name: str) -> None:
    assert set(roles(chain("Hips", name))) == {"hips"}


@pytest.mark.parametrize(
    "names",
    [
        ("LowerTorso", "UpperTorso", "Head"),
        ("下半身", "上半身２", "頭"),
        ("pelvis", "stomach", "head"),
        ("root.x", "spine_01.x", "head.x"),
        ("def_c_hip", "def_c_spineA", "def_c_headA"),
    ],
)
def test_knows_trunks_by_many_names(names: tuple[str, ...]) -> None:
    assert roles(chain(*names)) | {"hips": (0,)} == {"hips": (0,), "spine": (1,), "head": (2,)}


def test_the_last_joint_of_a_neck_is_the_head_where_none_is_called_so() -> None:
    found = roles(chain("def_c_hip", "def_c_spineA", "def_c_spineB", "def_c_neckA", "def_c_neckB", "def_c_jaw"))
    assert (found["spine"], found["neck"], found["head"]) == ((1, 2), (3,), (4,))
    assert roles(chain("Hips", "Neck1", "Neck2", "Head"))["neck"] == (1, 2)
    assert "head" not in roles(chain("Hips", "Spine", "Neck"))


def test_takes_what_lies_between_hips_and_arms_for_the_spine_whatever_its_name() -> None:
    names = ("Pelvis", "J_L_Hip", "J_R_Hip", "J_L5", "J_T1", "J_L_Shoulder", "J_R_Shoulder", "J_C7")
    found = roles(upright(names, [-1, 0, 0, 0, 3, 4, 4, 4]))
    assert (found["hips"], found["spine"], found["left upper_arm"]) == ((0,), (3, 4), (5,))


def test_takes_a_body_that_carries_arms_and_hips_for_the_spine() -> None:
    names = ("Body", "Hips", "UpperLeg.L", "UpperLeg.R", "UpperArm.L", "UpperArm.R", "Head")
    found = roles(upright(names, [-1, 0, 1, 1, 0, 0, 0]))
    assert (found["hips"], found["spine"], found["head"]) == ((1,), (0,), (6,))


def test_what_ik_aims_at_takes_no_part_in_limbs() -> None:
    names = ("Hips", "Spine", "elbow.L", "upperarm.L", "lowerarm.L", "hand.L", "hand_L")
    found = roles(upright(names, [-1, 0, 1, 1, 3, 4, 0]))
    assert (found["left upper_arm"], found["left forearm"], found["left hand"]) == ((3,), (4,), (5,))


def test_takes_the_root_for_hips_without_a_name() -> None:
    assert roles(chain("root", "thing"))["hips"] == (0,)
    assert roles(chain("root", "pelvis"))["hips"] == (1,)


def test_knows_fingers() -> None:
    for names in (
        ("LeftHandThumb1", "LeftHandThumb2", "LeftHandThumb3"),
        ("thumb_01_l", "thumb_02_l", "thumb_03_l"),
        ("left_thumb1", "left_thumb2", "left_thumb3"),
        ("LeftThumbProximal", "LeftThumbIntermediate", "LeftThumbDistal"),
        ("Bip01 L Finger0", "Bip01 L Finger01", "Bip01 L Finger02"),
        ("finger1-1.L", "finger1-2.L", "finger1-3.L"),
        ("def_l_fngThumbA", "def_l_fngThumbB", "def_l_fngThumbC"),
    ):
        assert roles(chain("Hips", "LeftHand", *names))["left thumb"] == (2, 3, 4)


def tree(**parents: str) -> Skeleton:
    """Joints by name with the names of their parents, empty for none; `__` stands for a space."""
    names = tuple(parents)
    above = [names.index(parent) if parent else -1 for parent in parents.values()]
    return upright(names, above, np.ones((len(names), 3)), root=names.index("Hips") if "Hips" in names else 0)


def test_twist_joints_take_no_part_in_limbs() -> None:
    rig = tree(
        pelvis="",
        L_thigh="pelvis",
        L_thigh2="L_thigh",
        L_thigh_twist="L_thigh",
        L_shin="L_thigh",
        upperarm_twist_l="pelvis",
    )
    assert roles(rig)["left thigh"] == (1,)
    assert "left upper_arm" not in roles(rig)


def test_a_spine_that_carries_legs_and_head_gives_hips_neck_and_head() -> None:
    """Rigify's deforming bones: spine, spine.001 and so on from the hips to the head."""
    rig = tree(
        spine="", spine1="spine", spine2="spine1", spine3="spine2", spine4="spine3", spine5="spine4",
        thigh_L="spine", thigh_R="spine", upper_arm_L="spine2", upper_arm_R="spine2",
    )  # fmt: skip
    found = roles(rig)
    assert (found["hips"], found["spine"], found["neck"], found["head"]) == ((0,), (1, 2), (3, 4), (5,))


def test_hips_beside_the_legs_give_way_to_what_carries_both() -> None:
    rig = tree(Root="", Hips="Root", Abdomen="Hips", thigh_L="Root", thigh_R="Root")
    assert roles(rig)["hips"] == (0, 1)


def test_roles_that_a_file_states_win_over_names() -> None:
    rig = chain("Hips", "LeftArm", "Tube1", "Tube2")
    found = roles(rig, {"Tube1": "left upper_arm", "Tube2": "left forearm"})
    assert (found["left upper_arm"], found["left forearm"]) == ((2,), (3,))


def test_a_leg_of_one_bone_is_the_thigh_and_a_leg_below_something_unknown_is_not() -> None:
    block = tree(Root="", Hips="Root", leg_L="Hips", leg_R="Hips", foot_L="leg_L", foot_R="leg_R")
    assert {role for role in roles(block) if "left" in role} == {"left thigh", "left foot"}
    unknown = tree(Hips="", thing_L="Hips", thing_R="Hips", leg_L="thing_L", leg_R="thing_R")
    assert {role for role in roles(unknown) if "left" in role} == {"left shin"}


@pytest.mark.parametrize("owner", ["UnityChan_", "LowMan", "humanoid_ "])
def test_a_figures_own_name_before_all_joints_is_no_part_of_theirs(owner: str) -> None:
    plain = {
        "Hips": "",
        "Spine": "Hips",
        "Head": "Spine",
        **{f"{s}{n}": p.format(s) for s in ("Left", "Right") for n, p in (("Arm", "Spine"), ("ForeArm", "{}Arm"))},
        **{f"{s}{n}": p.format(s) for s in ("Left", "Right") for n, p in (("UpLeg", "Hips"), ("Leg", "{}UpLeg"))},
    }
    called = tree(**plain)
    owned = replace(called, names=tuple(owner + name for name in called.names))
    assert roles(owned) == roles(called)
    assert "left forearm" in roles(owned)
