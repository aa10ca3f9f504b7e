"""AMASS reading: axis angles against scipy, names against the models' order, broken files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mua.errors import InputError
from mua.motion.amass import nominal_skeleton, read_amass
from mua.motion.face import read_face, with_face
from mua.motion.load import load_motions
from mua.motion.source_motion import SourceMotion
from mua.pose.signed_expressions import UNIT

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


@pytest.mark.parametrize("joints", [22, 24, 52, 55])
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


@pytest.mark.parametrize("joints", [22, 24, 52, 55])
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


def test_takes_thirty_frames_a_second_where_no_rate_is_stated_and_says_so(tmp_path: Path) -> None:
    motion = read_amass(write(tmp_path, mocap_framerate=None))
    assert motion.clip.rate == 30
    assert any("no frame rate" in note for note in motion.notes)


def same(found: SourceMotion, expected: SourceMotion) -> None:
    np.testing.assert_array_equal(found.clip.rotations, expected.clip.rotations)
    np.testing.assert_array_equal(found.clip.translations, expected.clip.translations)
    assert found.skeleton.names == expected.skeleton.names


@pytest.mark.parametrize(
    ("joints", "parts"),
    [
        (22, {"root_orient": 3, "pose_body": 63}),
        (22, {"global_orient": 3, "body_pose": 63}),
        (22, {"global_orient": 3, "body_pose": 63, "left_hand_pose": 6, "right_hand_pose": 6}),
        (24, {"global_orient": 3, "body_pose": 69}),
        (52, {"root_orient": 3, "pose_body": 63, "pose_hand": 90}),
        (52, {"global_orient": 3, "body_pose": 63, "left_hand_pose": 45, "right_hand_pose": 45}),
    ],
)
def test_puts_a_pose_in_parts_together(tmp_path: Path, joints: int, parts: dict[str, int]) -> None:
    whole = np.random.default_rng(4).normal(size=(5, 200))
    ends = np.cumsum(list(parts.values()))
    split = {key: whole[:, end - width : end] for (key, width), end in zip(parts.items(), ends, strict=True)}
    expected = read_amass(write(tmp_path, poses=whole[:, : 3 * joints]))
    same(read_amass(write(tmp_path, poses=None, **split)), expected)


def test_takes_vectors_by_joint_and_other_names_of_arrays(tmp_path: Path) -> None:
    poses = np.random.default_rng(5).normal(size=(5, 24, 3))
    trans = np.random.default_rng(6).normal(size=(5, 3))
    expected = read_amass(write(tmp_path, poses=poses.reshape(5, 72), trans=trans))
    same(read_amass(write(tmp_path, poses=None, smpl_poses=poses, trans=None, transl=trans)), expected)
    aist = {"smpl_poses": poses, "smpl_trans": trans * 64, "smpl_scaling": np.array([64.0])}
    same(read_amass(write(tmp_path, poses=None, trans=None, **aist)), expected)
    wham = {"pose": 0 * poses, "trans": 0 * trans, "pose_world": poses.reshape(5, 72), "trans_world": trans}
    same(read_amass(write(tmp_path, poses=None, **wham)), expected)


def test_takes_rotation_matrices(tmp_path: Path) -> None:
    """As HMR 2.0 and others write them; also of half a turn and of none."""
    poses = np.random.default_rng(5).normal(size=(5, 24, 3))
    poses[0, :2] = np.array([[0, 0, 0], [np.pi, 0, 0]])
    matrices = Rotation.from_rotvec(poses.reshape(-1, 3)).as_matrix().reshape(5, 24, 3, 3)
    found = read_amass(write(tmp_path, poses=None, global_orient=matrices[:, :1], body_pose=matrices[:, 1:]))
    expected = read_amass(write(tmp_path, poses=poses.reshape(5, 72)))
    dots = np.abs(np.sum(found.clip.rotations * expected.clip.rotations, axis=-1))
    np.testing.assert_allclose(dots, 1, atol=BOUND)


@pytest.mark.parametrize(("turn", "says"), [(0.0, "Y is up"), (np.pi, "Y is down")])
def test_judges_by_a_standing_body_what_is_up(tmp_path: Path, turn: float, says: str) -> None:
    poses = np.zeros((3, 66))
    poses[:, 0] = turn
    trans = np.array([[0.0, 0, 0], [0, np.cos(turn), 0], [0, 0, 0]])
    motion = read_amass(write(tmp_path, poses=poses, trans=trans))
    _, at = motion.skeleton.world(motion.clip.rotations, motion.clip.translations)
    assert (at[:, motion.skeleton.names.index("head"), 1] > at[:, 0, 1] + 0.4).all()
    np.testing.assert_allclose(at[1] - at[0], np.tile([0, 1, 0], (22, 1)), atol=1e-12)
    assert says in motion.notes[0]


def test_a_person_who_is_upside_down_for_a_while_stands_as_in_most_frames(tmp_path: Path) -> None:
    poses = np.zeros((10, 66))
    poses[:4, 0] = np.pi
    assert "Y is up" in read_amass(write(tmp_path, poses=poses, trans=np.zeros((10, 3)))).notes[0]


@pytest.mark.parametrize("joints", [52, 55])
def test_joints_of_a_finger_follow_each_other(joints: int) -> None:
    skeleton = nominal_skeleton(joints)
    above = {name: skeleton.names[parent] for name, parent in zip(skeleton.names, skeleton.parents, strict=True)}
    for side in ("left", "right"):
        for finger in ("index", "middle", "pinky", "ring", "thumb"):
            chain = [f"{side}_wrist", *(f"{side}_{finger}{k}" for k in (1, 2, 3))]
            assert [above[name] for name in chain[1:]] == chain[:-1]


def test_leaves_a_person_lying_in_a_file_of_amass(tmp_path: Path) -> None:
    lying = read_amass(write(tmp_path, poses=np.zeros((3, 156)), trans=np.zeros((3, 3)), dmpls=np.zeros((3, 8))))
    _, at = lying.skeleton.world(lying.clip.rotations, lying.clip.translations)
    assert abs(at[:, lying.skeleton.names.index("head"), 1] - at[:, 0, 1]).max() < 0.1
    assert lying.notes == ()


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"poses": None}, "poses"),
        ({"trans": None}, r"trans.*; zeros \[5, 3\] let the person stay in place"),
        ({"poses": None, "body_pose": np.zeros((5, 63))}, "global_orient"),
        ({"poses": None, "body_pose": np.zeros((5, 60)), "global_orient": np.zeros((5, 3))}, "body_pose"),
        ({"poses": None, "body_pose": np.zeros((4, 63)), "global_orient": np.zeros((5, 3))}, "5, 4"),
        ({"poses": None, "joints": np.zeros((5, 22, 3))}, "places of joints"),
        ({"trans": None, "smpl_trans": np.zeros((5, 3)), "smpl_scaling": np.zeros(1)}, "smpl_scaling"),
        ({"poses": np.zeros((5, 63))}, "poses"),
        ({"poses": np.zeros((0, 156)), "trans": np.zeros((0, 3))}, "poses"),
        ({"poses": np.full((5, 156), np.nan)}, "poses"),
        ({"poses": np.full((5, 156), 40.0)}, "poses: holds 40, expected axis angles in radians"),
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
    assert len(content) > 500
    for end in range(0, len(content), 13):
        path.write_bytes(content[:end])
        with pytest.raises(InputError, match=r"motion\.npz"):
            read_amass(path)


@pytest.mark.parametrize("key", ["expressions", "expression", "face_expr"])
def test_coefficients_of_a_face_move_pairs_of_expressions(tmp_path: Path, key: str) -> None:
    coefficients = UNIT * np.array([[0, 0, 0.5], [0.2, 0, 0], [-0.4, 0, 0], [2, 0, 0], [0, 0, 0]])
    path = write(tmp_path, **{key: coefficients})
    source = read_amass(path)
    assert source.expressions == ("Exp000+", "Exp000-", "Exp002+")
    expected = np.array([[0, 0, 0.5], [0.2, 0, 0], [0, 0.4, 0], [1, 0, 0], [0, 0, 0]])
    np.testing.assert_allclose(np.asarray(source.clip.expressions), expected)
    assert any(f"{key}: 6.7 % of the coefficients are beyond 5" in note for note in source.notes)
    np.testing.assert_allclose(read_face(path).weights, expected)
    names = ("jawOpen", "Exp000-", "Exp000+")
    (loaded,) = load_motions(path, source.skeleton, mapping=None, rate=120.0, face=names)
    on_character = np.stack([np.zeros(5), expected[:, 1], expected[:, 0]], axis=1)
    np.testing.assert_allclose(np.asarray(loaded.clip.expressions), on_character)
    (clip,), notes = with_face([loaded.clip], path, names)
    np.testing.assert_allclose(np.asarray(clip.expressions), on_character)
    assert notes == ["motion.npz: the character has no expression for Exp002+."]


def test_a_face_at_rest_is_none(tmp_path: Path) -> None:
    source = read_amass(write(tmp_path, expressions=np.zeros((5, 100))))
    assert (source.expressions, source.clip.expressions) == ((), None)
    assert not any("coefficients" in note for note in source.notes)


def test_refuses_a_face_of_another_length(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"motion\.npz: expression: the shape is \[4, 10\], expected \[5, "):
        read_amass(write(tmp_path, expression=np.zeros((4, 10))))
