"""A figure stands on the floor also where its feet are long for its legs, and its toes do not dip below it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from people import animal, person, walk, world
from scipy.spatial.transform import Rotation

from mua.motion.load import load_motions
from mua.motion.planted_feet import Feet
from mua.motion.poses_file import write_poses
from mua.motion.read import read_motion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

HEEL_UP = 50.0  # degrees by which a foot points down in the middle of a step
LEVEL = 0.005  # metres from how the lower foot of the source stands
HOVERS = 0.05  # metres by which a figure would hover if its lowest points made its floor
SOLES = ("LeftFoot", "LeftToeBase", "RightFoot", "RightToeBase")


@pytest.fixture
def steps(tmp_path: Path) -> Path:
    """A walk whose heels rise before the toes do."""
    skeleton, clip = person(), walk(person())
    time = np.arange(len(clip)) / clip.rate
    for side, phase in (("Left", 0.0), ("Right", 0.5)):
        swing = np.clip(((time + phase) % 1.0 - 0.5) / 0.5, 0, 1)
        pitch = Rotation.from_euler("x", (HEEL_UP * np.sin(np.pi * swing))[:, None], degrees=True)
        foot = skeleton.names.index(f"{side}Foot")
        turned = Rotation.from_quat(clip.rotations[:, foot], scalar_first=True) * pitch
        clip.rotations[:, foot] = turned.as_quat(scalar_first=True)
    write_poses(tmp_path / "steps.npz", skeleton, clip)
    return tmp_path / "steps.npz"


def feet_of(length: float) -> Skeleton:
    """The person with feet so many times as long."""
    skeleton = person()
    offsets = skeleton.bind_translations.copy()
    for side in ("Left", "Right"):
        for joint in (f"{side}ToeBase", f"{side}Toe_End"):
            offsets[skeleton.names.index(joint), 2] *= length
    return replace(skeleton, bind_translations=offsets)


def put_on(steps: Path, target: Skeleton, feet: Feet) -> tuple[Clip, str]:
    (loaded,) = load_motions(steps, target, mapping=None, rate=30.0, feet=feet)
    return loaded.clip, " ".join(loaded.notes)


def heights(target: Skeleton, clip: Clip) -> np.ndarray:
    """Of ankles and toes above where they stand, [F, 4] metres."""
    joints = [target.names.index(name) for name in SOLES]
    rest = target.world(target.bind_rotations, target.bind_translations)[1]
    return np.asarray(world(target, clip)[1][:, joints, 1] - rest[joints, 1])


def standing(found: np.ndarray) -> float:
    """How high the lower ankle mostly is."""
    return float(np.median(found[:, ::2].min(axis=1)))


@pytest.mark.parametrize("feet", ["auto", "plant"])
@pytest.mark.parametrize("length", [5.0, 7.0])
def test_long_feet_stand_on_the_floor_and_their_toes_do_not_dip(steps: Path, feet: Feet, length: float) -> None:
    target = feet_of(length)
    kept, kept_notes = put_on(steps, target, "keep")
    clip, notes = put_on(steps, target, feet)
    stood = standing(heights(person(), read_motion(steps)[0].clip))
    assert standing(heights(target, kept)) > stood + HOVERS
    assert "feet long for the legs are turned up" in notes
    assert kept_notes == ""
    found = heights(target, clip)
    assert standing(found) == pytest.approx(stood, abs=LEVEL)
    assert found.min() > -LEVEL
    assert found[:, 0].max() > 0.1  # it still steps
    knees = [target.names.index(f"{side}Leg") for side in ("Left", "Right")]
    if feet == "auto":
        np.testing.assert_allclose(clip.rotations[:, knees], kept.rotations[:, knees], atol=0.05)


def test_feet_of_usual_length_keep_their_direction(steps: Path) -> None:
    target = feet_of(1.2)
    clip, notes = put_on(steps, target, "auto")
    assert "turned up" not in notes
    feet = [target.names.index(name) for name in SOLES]
    turned = np.sum(
        world(target, clip)[0][:, feet] * world(target, put_on(steps, target, "keep")[0])[0][:, feet], axis=-1
    )
    np.testing.assert_allclose(np.abs(turned), 1, atol=1e-9)


def test_an_animal_stands_on_its_forelegs_too(steps: Path) -> None:
    """What would put its hind feet on the floor would put its forefeet below it."""
    target = animal(ahead=2, size=2, knee=0.05, toe=0.3)
    kept, clip = put_on(steps, target, "keep")[0], put_on(steps, target, "auto")[0]
    feet = [target.names.index(name) for name in SOLES]
    np.testing.assert_allclose(world(target, clip)[1][:, feet, 1], world(target, kept)[1][:, feet, 1], atol=LEVEL)
