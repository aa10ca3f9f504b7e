"""AMASS reading: axis angles against scipy, names against the models' order, broken files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mua.errors import InputError
from mua.motion.amass import nominal_skeleton, read_amass

BOUND = 64 * np.finfo(float).eps  # sine, cosine and one quaternion product


def write(folder: Path, **changes: Any) -> Path:
    random = np.random.default_rng(2)
    arrays: dict[str, Any] = {
        "poses": random.normal(size=(5, 156)),
        "trans": random.normal(size=(5, 3)),
        "betas": np.zeros(16),
        "gender": np.array("female"),
        "mocap_framerate": np.array(120.0),
    }
    arrays |= changes
    path = folder / "motion.npz"
    np.savez(path, **{key: value for key, value in arrays.items() if value is not None})
    return path


@pytest.mark.parametrize("joints", [24, 52, 55])
def test_reads_axis_angles_of_every_model(tmp_path: Path, joints: int) -> None:
    poses = np.random.default_rng(3).normal(size=(5, 3 * joints))
    poses[0] = 0
    motion = read_amass(write(tmp_path, poses=poses))
    expected = Rotation.from_rotvec(poses.reshape(-1, 3)).as_quat(scalar_first=True).reshape(5, joints, 4)[:, 1:]
    dots = np.abs(np.sum(motion.clip.rotations[:, 1:] * expected, axis=-1))
    np.testing.assert_allclose(dots, 1, atol=BOUND)
    assert motion.skeleton.names[15] == "head"
    assert len(motion.skeleton.names) == joints


def test_brings_z_up_to_y_up(tmp_path: Path) -> None:
    upright = np.zeros((2, 156))
    upright[:, 0] = np.pi / 2  # the model's rest pose has Y up, AMASS's world Z
    trans = np.array([[1.0, 2, 3], [1, 2, 4]])
    motion = read_amass(write(tmp_path, poses=upright, trans=trans))
    _, at = motion.skeleton.world(motion.clip.rotations, motion.clip.translations)
    names = motion.skeleton.names
    assert (at[:, names.index("head"), 1] > at[:, 0, 1] + 0.4).all()
    np.testing.assert_allclose(at[1] - at[0], np.tile([0, 1, 0], (52, 1)), atol=1e-12)
    pelvis = motion.skeleton.bind_translations[0] + trans[0]
    np.testing.assert_allclose(at[0, 0], [pelvis[0], pelvis[2], -pelvis[1]], atol=1e-12)


def test_a_turn_about_the_vertical_stays_one(tmp_path: Path) -> None:
    turned = np.zeros((1, 156))
    turned[0, :3] = (Rotation.from_rotvec([0, 0, 0.7]) * Rotation.from_rotvec([np.pi / 2, 0, 0])).as_rotvec()
    root = read_amass(write(tmp_path, poses=turned, trans=np.zeros((1, 3)))).clip.rotations[0, 0]
    np.testing.assert_allclose(Rotation.from_quat(root, scalar_first=True).as_rotvec(), [0, 0.7, 0], atol=BOUND)


@pytest.mark.parametrize("joints", [24, 52, 55])
def test_rests_as_a_person_facing_z(joints: int) -> None:
    skeleton = nominal_skeleton(joints)
    assert (skeleton.parents[1:] < np.arange(1, joints)).all()
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    place = dict(zip(skeleton.names, at, strict=True))
    assert 1.3 < place["head"][1] - place["left_foot"][1] < 1.7
    assert 1.2 < place["left_wrist"][0] - place["right_wrist"][0] < 1.8
    assert place["left_foot"][2] > place["left_ankle"][2]
    for name, where in place.items():
        if name.startswith("left"):
            np.testing.assert_allclose(place["right" + name[4:]], where * [-1, 1, 1], atol=1e-12)


def test_takes_either_spelling_of_the_rate(tmp_path: Path) -> None:
    assert read_amass(write(tmp_path)).clip.rate == 120
    assert read_amass(write(tmp_path, mocap_framerate=None, mocap_frame_rate=np.array([60]))).clip.rate == 60


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"poses": None}, "poses"),
        ({"trans": None}, "trans"),
        ({"mocap_framerate": None}, "mocap_framerate"),
        ({"poses": np.zeros((5, 63))}, "poses"),
        ({"poses": np.zeros((0, 156)), "trans": np.zeros((0, 3))}, "poses"),
        ({"poses": np.full((5, 156), np.nan)}, "poses"),
        ({"poses": np.array([["a"] * 156] * 5)}, "poses"),
        ({"trans": np.zeros((4, 3))}, "trans"),
        ({"trans": np.full((5, 3), np.inf)}, "trans"),
        ({"mocap_framerate": np.array(0.0)}, "mocap_framerate"),
        ({"mocap_framerate": np.array([30.0, 60])}, "mocap_framerate"),
    ],
)
def test_rejects_wrong_arrays_by_name(tmp_path: Path, changes: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=rf"motion\.npz.*{says}"):
        read_amass(write(tmp_path, **changes))


def test_never_unpickles(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="plain arrays"):
        read_amass(write(tmp_path, poses=np.array([{"a": 1}], dtype=object)))


def test_rejects_truncation_at_every_offset(tmp_path: Path) -> None:
    path = write(tmp_path, poses=np.zeros((1, 72)), trans=np.zeros((1, 3)))
    content = path.read_bytes()
    for end in range(0, len(content), 13):
        path.write_bytes(content[:end])
        with pytest.raises(InputError, match=r"motion\.npz"):
            read_amass(path)
