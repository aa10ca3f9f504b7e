"""Retargeting of real motion, and of the rest poses of SMPL and CMU."""

import numpy as np
import pytest
from people import ANGLE_BOUND, LIMBS, angle, assert_turned_as_at_rest, bone, person, retarget, still, world
from shared_data import SharedData

from mua.characters.read import read_surfaces
from mua.motion.amass import nominal_skeleton
from mua.motion.bvh import read_bvh
from mua.motion.source_motion import SourceMotion
from mua.pose.skeleton import Skeleton

CMU_FACING = 1e-6  # radians by which the hips of CMU's zero pose are turned from facing +Z: rounding of its offsets
CMU_NAMES = {"Arm": "humerus", "ForeArm": "radius", "Hand": "wrist", "UpLeg": "femur", "Leg": "tibia", "Foot": "foot"}
SMPL_NAMES = {"Arm": "shoulder", "ForeArm": "elbow", "Hand": "wrist", "UpLeg": "hip", "Leg": "knee", "Foot": "ankle"}


@pytest.mark.parametrize("joints", [24, 52, 55])
def test_amass_rest_pose_stands_upright_in_the_targets_place(joints: int) -> None:
    smpl, target = nominal_skeleton(joints), person(axes=2)
    standing = still(smpl, root=[0, 0.95, 0])
    found, _ = retarget(SourceMotion(smpl, standing), target)
    for begin, end in LIMBS:
        side = "left" if begin.startswith("Left") else "right"
        limb = [f"{side}_{SMPL_NAMES[part.removeprefix('Left').removeprefix('Right')]}" for part in (begin, end)]
        assert angle(bone(target, found, begin, end), bone(smpl, standing, *limb)) < ANGLE_BOUND
    turned, at = world(target, found)
    _, bind_at = target.world(target.bind_rotations, target.bind_translations)
    placed = [target.names.index(name) for name in ("Hips", "Head", "LeftFoot", "RightToeBase")]
    assert np.abs(at[0, placed, 1] - bind_at[placed, 1]).max() < 0.02
    assert_turned_as_at_rest(target, turned[0], "Hips", "Head")


@pytest.fixture(scope="module")
def woman(shared_data: SharedData) -> Skeleton:
    return read_surfaces(shared_data.path("characters/White_F_3_Casual.glb")).skeleton


@pytest.mark.parametrize("name", ["02_01", "02_03", "01_05"])
@pytest.mark.parametrize("target_name", ["person", "woman"])
def test_real_motion_moves_limbs_alike(
    shared_data: SharedData, request: pytest.FixtureRequest, name: str, target_name: str
) -> None:
    target = person(axes=3) if target_name == "person" else request.getfixturevalue("woman")
    source = read_bvh(shared_data.path(f"motion/cmu/{name}.bvh"))
    found, notes = retarget(source, target)
    assert len(found) == len(source.clip)
    assert not any("floor" in note for note in notes)
    for begin, end in LIMBS:
        limb = [
            f"{part[0].lower()}{CMU_NAMES[part.removeprefix('Left').removeprefix('Right')]}" for part in (begin, end)
        ]
        assert angle(bone(target, found, begin, end), bone(source.skeleton, source.clip, *limb)) < CMU_FACING


@pytest.mark.parametrize("name", ["02_01", "02_03"])
def test_walks_and_runs_upright_on_the_floor_with_knees_forward(
    shared_data: SharedData, woman: Skeleton, name: str
) -> None:
    clip, _ = retarget(read_bvh(shared_data.path(f"motion/cmu/{name}.bvh")), woman)
    _, at = world(woman, clip)
    place = {joint: at[:, j] for j, joint in enumerate(woman.names)}
    rest = woman.world(woman.bind_rotations, woman.bind_translations)[1]
    assert (place["Head"][:, 1] - place["Hips"][:, 1] > 0.5).all()
    assert (place["LeftHand"][:, 1] < place["Head"][:, 1]).all()
    toes = [woman.names.index(f"{side}ToeBase") for side in ("Left", "Right")]
    assert np.abs((at[:, toes, 1] - rest[toes, 1]).min(axis=0)).max() < 0.03
    forward = np.cross(place["LeftUpLeg"] - place["RightUpLeg"], [0, 1, 0])
    for side in ("Left", "Right"):
        hip, knee, ankle = (place[f"{side}{part}"] for part in ("UpLeg", "Leg", "Foot"))
        bend = np.sum((knee - (hip + ankle) / 2) * forward, axis=-1)
        assert bend.mean() > 0
        assert (bend > -0.02 * np.linalg.norm(forward, axis=-1)).all()
    travel = place["Hips"][-1] - place["Hips"][0]
    assert np.sum(travel * forward.mean(axis=0)) > 0.9 * np.linalg.norm(travel) * np.linalg.norm(forward.mean(axis=0))
