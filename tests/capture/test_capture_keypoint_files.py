"""Files of 3D keypoints: the same points come back from the layouts of several tools, and what is wrong is named."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from captures import character_file
from commands import Commands

from mua.arrays import Array
from mua.capture.conventions import read_axes
from mua.capture.readers.keypoints import read_keypoints
from mua.capture.readers.keypoints.keypoints import BODY_25, COCO, MEDIAPIPE
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.poses_file import read_poses
from mua.pose.joint_names import roles
from mua.teachers.procedural import procedural_character

Z_UP = "X,-Z,Y"
MOVING = np.random.default_rng(0).normal(size=(3, 40, 3))  # frames of more points than any layout's body has


def easymocap(folder: Path, points: Array, *, person: int = 0, first: int = 0) -> Path:
    """keypoints3d/000000.json and on: rows of x, y, z and confidence."""
    folder.mkdir(exist_ok=True)
    for number, frame in enumerate(points, first):
        rows = [[*row, 0.9] for row in frame.tolist()]
        (folder / f"{number:06d}.json").write_text(json.dumps([{"id": person, "keypoints3d": rows}]))
    return folder


def openpose(folder: Path, points: Array) -> Path:
    """walk_000000000000_keypoints.json and on: x, y, z and confidence in one row."""
    folder.mkdir()
    for number, frame in enumerate(points):
        flat = np.column_stack([frame, np.ones(len(frame))]).ravel().tolist()
        people = [{"person_id": [-1], "pose_keypoints_2d": [], "pose_keypoints_3d": flat}]
        (folder / f"walk_{number:012d}_keypoints.json").write_text(json.dumps({"version": 1.3, "people": people}))
    return folder


def freemocap(path: Path, points: Array, names: tuple[str, ...] = MEDIAPIPE, *, prefix: str = "body_") -> Path:
    """The columns x, y and z of each point, in millimetres."""
    head = ",".join(f"{prefix}{name}_{axis}" for name in names for axis in "xyz")
    rows = [",".join(repr(1000 * value) for value in frame.ravel().tolist()) for frame in points]
    path.write_text("\n".join([head, *rows, ""]))
    return path


def saved(path: Path, values: Any) -> Path:
    np.save(path, values)
    return path


@pytest.mark.parametrize(
    ("write", "names"),
    [
        (lambda folder: easymocap(folder / "keypoints3d", MOVING), BODY_25),
        (lambda folder: easymocap(folder / "keypoints3d", MOVING[:, :17]), COCO),
        (lambda folder: openpose(folder / "json", MOVING[:, :25]), BODY_25),
        (lambda folder: freemocap(folder / "mediapipe_body_3d_xyz.csv", MOVING[:, :33]), MEDIAPIPE),
        (lambda folder: freemocap(folder / "mediapipe_body_3d_xyz.csv", MOVING[:, :33], prefix=""), MEDIAPIPE),
        (lambda folder: saved(folder / "mediaPipeSkel_3d_body_hands_face.npy", 1000 * MOVING), MEDIAPIPE),
    ],
)
def test_points_come_back_from_each_layout(
    tmp_path: Path, write: Callable[[Path], Path], names: tuple[str, ...]
) -> None:
    read = read_keypoints(write(tmp_path))
    assert read.names == names
    np.testing.assert_allclose(read.points, MOVING[:, : len(names)], atol=1e-12)
    assert read.rate == 30


@pytest.mark.parametrize(
    ("names", "numbers"),
    [
        (BODY_25, {"RElbow": 3, "RWrist": 4, "LElbow": 6, "LWrist": 7, "RKnee": 10, "LKnee": 13, "RHeel": 24}),
        (COCO, {"LElbow": 7, "RElbow": 8, "LWrist": 9, "RWrist": 10, "LKnee": 13, "RKnee": 14, "RAnkle": 16}),
        (MEDIAPIPE, {"left_elbow": 13, "right_wrist": 16, "left_hip": 23, "right_knee": 26, "right_foot_index": 32}),
    ],
)
def test_points_have_the_numbers_that_their_tool_documents(names: tuple[str, ...], numbers: dict[str, int]) -> None:
    assert {name: names.index(name) for name in numbers} == numbers


def test_a_person_is_posed_by_the_folder_of_a_world_with_z_up(command: Commands, tmp_path: Path) -> None:
    """The template in its bind pose, written by EasyMocap in centimetres."""
    template = tmp_path / "figure.glb"
    template.write_bytes(character_file(procedural_character()))
    surfaces = read_surfaces(template)
    skeleton, found = surfaces.skeleton, roles(surfaces.skeleton, surfaces.roles)
    _, bind = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    parts = {"Hip": "thigh", "Knee": "shin", "Ankle": "foot", "Shoulder": "upper_arm", "Elbow": "forearm"}
    points = np.zeros((2, 25, 3))
    for side in ("left", "right"):
        for name, part in {**parts, "Wrist": "hand"}.items():
            points[:, BODY_25.index(side[0].upper() + name)] = bind[found[f"{side} {part}"][0]]
    folder = easymocap(tmp_path / "keypoints3d", 100 * points @ read_axes(Z_UP).T)
    for file in folder.iterdir():  # what is left at 0 was not seen
        (person,) = json.loads(file.read_text())
        person["keypoints3d"] = [row if any(row[:3]) else [0, 0, 0, 0] for row in person["keypoints3d"]]
        file.write_text(json.dumps([person]))
    line = ("capture", "poses", folder, "--template", template, "--axes", Z_UP, "--scale", 0.01, "--rate", 50)
    ended = command(*line, "-o", tmp_path / "walk.npz")
    assert "2 poses at 50 frames per second" in ended.out, ended
    clip = read_poses(tmp_path / "walk.npz").clip
    _, at = skeleton.world(clip.rotations, clip.translations)
    np.testing.assert_allclose(at[0, found["left hand"][0]], bind[found["left hand"][0]], atol=1e-4)


def test_what_was_not_seen_is_no_point(tmp_path: Path) -> None:
    folder = easymocap(tmp_path / "keypoints3d", MOVING[:, :25])
    (folder / "000001.json").unlink()
    rows = [[1, 2, 3, 0], *([[1, 2, 3, 0.5]] * 24)]
    (folder / "000002.json").write_text(json.dumps([{"id": 0, "keypoints3d": rows}]))
    points = read_keypoints(folder).points
    assert np.isnan(points[1]).all()
    assert np.isnan(points[2, 0]).all()
    np.testing.assert_array_equal(points[2, 1], [1, 2, 3])
    table = freemocap(tmp_path / "body.csv", MOVING[:, :33])
    head, first, *rest = table.read_text().split("\n")
    table.write_text("\n".join([head, "," * first.count(","), *rest]))
    assert np.isnan(read_keypoints(table).points[0]).all()


def test_the_person_of_most_frames_is_read(tmp_path: Path) -> None:
    """Frames 10 to 12; somebody else is in the first alone."""
    folder = easymocap(tmp_path / "keypoints3d", MOVING[:, :25], person=4, first=10)
    (one,) = json.loads((folder / "000010.json").read_text())
    passer = {"id": 2, "keypoints3d": np.zeros((25, 4)).tolist()}
    (folder / "000010.json").write_text(json.dumps([one, passer]))
    np.testing.assert_allclose(read_keypoints(folder).points, MOVING[:, :25])


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("a.bvh", "", "a.bvh: .*expected a .trc, a .csv or .npy of FreeMoCap, or a folder"),
        ("a.csv", "frame,keypoint,x\n1,nose,2\n", "a.csv: the columns are frame, keypoint, x; expected x, y and z"),
        ("a.csv", "nose_x,nose_y,nose_z\n", "a.csv: has no frames"),
        ("a.csv", "nose_x,nose_y,nose_z\n1,2\n", "a.csv, line 2: has 2 cells; expected 3"),
        ("a.csv", "nose_x,nose_y,nose_z\n1,2,far\n", "a.csv, line 2: could not convert string to float: 'far'"),
        ("a.npy", "no array", "a.npy: cannot be read as .npy"),
        ("0.json", "{", "0.json: cannot be read as JSON"),
        ("0.json", "[]", "has 1 numbered .json files with no person"),
        ("0.json", "[1]", "0.json: is no list of people"),
        ("0.json", '[{"id": 0, "Rh": []}]', "0.json: a person has id, Rh; expected keypoints3d"),
        ("0.json", '[{"id": 0, "keypoints3d": [[1, 2]]}]', r"0.json: keypoints have the shape \[1, 2\]"),
        ("0.json", '[{"id": 0, "keypoints3d": ["a"]}]', "0.json: the keypoints are no rows of x, y, z and confidence"),
        (
            "0.json",
            '[{"id": 0, "keypoints3d": [[1, 2, 3, 1]]}]',
            r"people have 1 keypoints; expected 17 \(COCO\) or 25",
        ),
    ],
)
def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, name: str, text: str, sentence: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_keypoints(tmp_path if name.endswith(".json") else tmp_path / name)


def test_an_array_of_other_points_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"holds float64 \[3, 21, 3\]; expected coordinates \[frames, 33 or more, 3\]"):
        read_keypoints(saved(tmp_path / "hand.npy", MOVING[:, :21]))
