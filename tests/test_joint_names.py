"""Body parts behind joint names of many habits."""

import numpy as np
import pytest

from mua.motion.joint_names import roles
from mua.rig.skeleton import Skeleton

LEG = ("left thigh", "left shin", "left foot", "left toe")
ARM = ("left shoulder", "left upper_arm", "left forearm", "left hand")


def chain(*names: str) -> Skeleton:
    parents = np.arange(-1, len(names) - 1, dtype=np.int32)
    return Skeleton(names, parents, np.tile([1.0, 0, 0, 0], (len(names), 1)), np.ones((len(names), 3)), root=0)


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
