"""AvatarReX and THuman4: SMPL-X poses land on the template where the set's own cameras see them."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from avatarrex_files import FRAMES, JOINTS, LENS, SIZE, WORLDS, template, write_source
from captures import character_file
from commands import Commands
from PIL import Image
from scipy.spatial.transform import Rotation
from tube import tube

from mua.arrays import Array
from mua.capture import open_capture
from mua.capture.silhouette import pixels
from mua.errors import InputError
from mua.motion.poses_file import read_poses, write_poses
from mua.pose.clip import Clip

PIXEL_BOUND = 1e-3  # float32 positions of a template some metres away, at a focal length of 1200


@pytest.fixture(params=WORLDS)
def source(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A set in a world of another up, with all that its makers publish but the people."""
    return write_source(tmp_path / "set", WORLDS[request.param])


def joints_seen(source: Path, camera: str) -> Array:
    """Columns and rows [F, 55, 2] of the joints, by the model's own recursion and the set's own calibration."""
    said = json.loads((source / "calibration_full.json").read_text())[camera]
    skeleton = template()
    with np.load(source / "smpl_params.npz") as file:
        pose = [file["global_orient"], file["body_pose"], np.zeros((FRAMES, 9)), file["left_hand_pose"]]
        vectors = np.concatenate([*pose, file["right_hand_pose"]], axis=1).reshape(FRAMES, 55, 3)
        moved = file["transl"]
    found = np.empty((FRAMES, 55, 2))
    for frame in range(FRAMES):
        turned: list[Array] = []
        at: list[Array] = []
        for joint, vector in enumerate(vectors[frame]):
            above, offset = int(skeleton.parents[joint]), skeleton.bind_translations[joint]
            local = Rotation.from_rotvec(vector).as_matrix()
            turned.append(local if above < 0 else turned[above] @ local)
            at.append(offset + moved[frame] if above < 0 else at[above] + turned[above] @ offset)
        seen = (np.array(said["R"]).reshape(3, 3) @ np.array(at).T).T + said["T"]
        image = (np.array(said["K"]).reshape(3, 3) @ seen.T).T
        found[frame] = image[:, :2] / image[:, 2:] + 0.5
    return found


def described(source: Path, command: Commands, *more: object) -> Path:
    folder = source.parent / "capture"
    ended = command("capture", "describe", source, "--template", source.parent / "template.glb", "-o", folder, *more)
    assert ended.status == 0, ended
    return folder


def test_joints_are_where_the_sets_own_cameras_see_them(source: Path, command: Commands) -> None:
    capture = open_capture(described(source, command, "--rate", 25))
    assert capture.rate == 25
    clip, skeleton = capture.motion("frames_000000"), capture.surfaces.skeleton
    _, at = skeleton.world(clip.rotations, clip.translations)
    order = [skeleton.names.index(name) for name in JOINTS]
    for camera in capture.cameras:
        found, depth = pixels(camera, at[:, order])
        assert (depth > 1).all()
        np.testing.assert_allclose(found, joints_seen(source, camera.name), atol=PIXEL_BOUND)
        assert (camera.size, camera.distortion) == (SIZE, tuple(LENS))
    assert (at[:, skeleton.names.index("head"), 1] > at[:, skeleton.names.index("pelvis"), 1]).all()


def test_frames_that_a_camera_lacks_are_left_out(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    (source / "22053925" / "00000002.jpg").unlink()
    capture = open_capture(described(source, command))
    assert [(clip.name, clip.first, clip.first_image, clip.frames) for clip in capture.clips] == [
        ("frames_000000", 0, 0, 2),
        ("frames_000003", 3, 3, 2),
    ]
    view = capture.view("frames_000003", 1, "22010708")
    assert 255 * view.image[12, 12, 0] == pytest.approx(36, abs=4)  # frame 4, in JPEG


def test_frames_without_a_mask_are_left_out(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    (source / "22010708" / "mask" / "pha" / "00000000.jpg").unlink()
    capture = open_capture(described(source, command))
    assert [(clip.name, clip.first_image, clip.frames) for clip in capture.clips] == [("frames_000001", 1, 4)]


@pytest.mark.parametrize("begin", [0, 1])
def test_pictures_may_have_other_names(tmp_path: Path, command: Commands, begin: int) -> None:
    """Fewer digits, masks as PNG, and counted from 1: the first image then shows the first pose."""
    source = write_source(tmp_path / "set", WORLDS["y"])
    for file in sorted(source.rglob("*.jpg"), reverse=True):
        masked = "pha" in file.parts
        with Image.open(file) as picture:
            picture.save(file.with_name(f"{int(file.stem) + begin:06d}.{'png' if masked else 'jpg'}"))
        file.unlink()
    capture = open_capture(described(source, command))
    (clip,) = capture.clips
    assert (clip.first, clip.first_image, clip.frames) == (0, begin, FRAMES)
    view = capture.view(clip.name, 3, "22053925")
    assert 255 * view.image[12, 12, 0] == pytest.approx(27, abs=4)


def test_a_first_picture_that_one_camera_lacks_does_not_shift_the_poses(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    for camera in ("22010708", "22053925"):
        for folder in (source / camera, source / camera / "mask" / "pha"):
            (folder / f"{FRAMES:08d}.jpg").write_bytes((folder / "00000004.jpg").read_bytes())  # it has no pose
    (source / "22010708" / "00000000.jpg").unlink()
    (clip,) = open_capture(described(source, command)).clips
    assert (clip.first, clip.first_image, clip.frames) == (1, 1, FRAMES - 1)


def test_what_a_set_lacks_is_named(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    asked = ("capture", "describe", source, "--template", tmp_path / "template.glb", "-o", tmp_path / "out")
    for camera in ("22010708", "22053925"):
        (source / camera / "mask" / "pha" / "00000002.jpg").unlink()
        (source / camera / "00000001.jpg").unlink()
        (source / camera / "00000003.jpg").unlink()
    assert "no two frames in a row have images and masks of all 2 cameras" in command(*asked).sentence
    for camera in ("22010708", "22053925"):
        (source / camera / "mask" / "pha").rename(source / camera / "mask" / "fgr")
    assert "22010708/mask/pha: found no masks; expected 00000000.jpg" in command(*asked).sentence
    (source / "smpl_params.npz").unlink()
    assert "holds calibration_full.json, but no smpl_params.npz" in command(*asked).sentence


def test_the_full_calibration_is_the_one_that_is_read(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    (source / "calibration.json").write_text("{}")
    assert len(open_capture(described(source, command)).cameras) == 2


def test_the_template_is_as_tall_and_as_whole_as_asked(tmp_path: Path, command: Commands) -> None:
    """Poses are those of the person at that height: on a template twice as tall, joints are twice as far apart."""
    source = write_source(tmp_path / "set", WORLDS["y"])
    whole = open_capture(described(source, command))
    height = float(np.ptp(whole.surfaces.vertices[:, 1]))
    taller = open_capture(described(source, command, "--height", 2 * height))
    assert np.ptp(taller.surfaces.vertices[:, 1]) == pytest.approx(2 * height)
    apart = []
    for capture in (whole, taller):
        clip, skeleton = capture.motion("frames_000000"), capture.surfaces.skeleton
        _, at = skeleton.world(clip.rotations, clip.translations)
        apart.append(at[0, skeleton.names.index("head")] - at[0, skeleton.names.index("pelvis")])
    np.testing.assert_allclose(apart[1], 2 * apart[0], atol=1e-6)
    ended = command(
        *("capture", "describe", source, "--template", tmp_path / "template.glb", "-o", tmp_path / "out"),
        *("--leave-out", "hat"),
    )
    assert "--leave-out hat" in ended.sentence


def with_a_second_mesh(path: Path, name: str) -> None:
    """Show the mesh of a .glb again, by a node of another name."""
    content = path.read_bytes()
    (length,) = struct.unpack_from("<I", content, 12)
    said, rest = json.loads(content[20 : 20 + length]), content[20 + length :]
    (shown,) = (node for node in said["nodes"] if "mesh" in node)
    said["scenes"][0]["nodes"].append(len(said["nodes"]))
    said["nodes"].append(shown | {"name": name})
    text = json.dumps(said).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON")
    path.write_bytes(head + text + rest)


def test_what_nobody_filmed_of_the_template_is_left_out(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    alone = len(open_capture(described(source, command)).surfaces.vertices)
    with_a_second_mesh(tmp_path / "template.glb", "hat")
    assert len(open_capture(described(source, command)).surfaces.vertices) > alone
    assert len(open_capture(described(source, command, "--leave-out", "hat")).surfaces.vertices) == alone


def test_thumans_names_are_known_too(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    (source / "calibration_full.json").rename(source / "calibration.json")
    for camera in ("22010708", "22053925"):
        (source / "masks").mkdir(exist_ok=True)
        (source / "images").mkdir(exist_ok=True)
        (source / camera / "mask" / "pha").rename(source / "masks" / camera)
        (source / camera / "mask").rmdir()
        (source / camera).rename(source / "images" / camera)
    capture = open_capture(described(source, command))
    assert capture.view("frames_000000", 1, "22010708").image.shape == (SIZE[1], SIZE[0], 3)


FAULTS: dict[str, tuple[dict[str, Any], str]] = {
    "no hips": ({"global_orient": None}, r"smpl_params\.npz: holds no global_orient; found"),
    "another model": ({"body_pose": np.zeros((FRAMES, 69))}, r"body_pose: the shape is \[5, 69\], expected \[5, 63\]"),
    "no number": ({"transl": np.full((FRAMES, 3), np.nan)}, r"transl: pose 0 is not finite"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_poses_that_cannot_be_are_named(tmp_path: Path, command: Commands, fault: str) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    change, sentence = FAULTS[fault]
    with np.load(source / "smpl_params.npz") as file:
        arrays = {**file} | change
    np.savez(source / "smpl_params.npz", **{key: value for key, value in arrays.items() if value is not None})
    ended = command("capture", "describe", source, "--template", tmp_path / "template.glb", "-o", tmp_path / "out")
    with pytest.raises(InputError, match=sentence):
        raise InputError(ended.sentence)
    assert not (tmp_path / "out" / "capture.json").exists()


def test_a_template_on_other_joints_is_refused(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    (tmp_path / "template.glb").write_bytes(character_file(tube()))
    ended = command("capture", "describe", source, "--template", tmp_path / "template.glb", "-o", tmp_path / "out")
    assert "template.glb: 0 of its joints are called as SMPL-X's" in ended.sentence


def test_an_unknown_layout_is_refused(tmp_path: Path, command: Commands) -> None:
    (tmp_path / "template.glb").write_bytes(b"glTF")
    ended = command("capture", "describe", tmp_path, "--template", tmp_path / "template.glb", "-o", tmp_path / "out")
    assert "its layout is not known" in ended.sentence


@pytest.mark.parametrize("count", [1, 3, 6])
def test_a_lens_of_another_model_is_refused(tmp_path: Path, command: Commands, count: int) -> None:
    source = write_source(tmp_path / "set", WORLDS["y"])
    cameras = json.loads((source / "calibration_full.json").read_text())
    cameras["22010708"]["distCoeff"] = [0.1] * count
    (source / "calibration_full.json").write_text(json.dumps(cameras))
    ended = command("capture", "describe", source, "--template", tmp_path / "template.glb", "-o", tmp_path / "out")
    assert f"22010708: distCoeff has {count} numbers; expected OpenCV's k1, k2, p1, p2, k3" in ended.sentence


def test_braces_in_the_name_of_the_folder_are_no_fields(tmp_path: Path, command: Commands) -> None:
    source = write_source(tmp_path / "{clip} of {me}", WORLDS["y"])
    assert open_capture(described(source, command)).view("frames_000000", 1, "22010708").image.shape[0] == SIZE[1]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"parents": np.arange(55)[::-1]}, "parents: a joint comes before its parent"),
        ({"parents": np.full(55, 99)}, "parents: expected whole numbers of -1 to 54"),
        ({"root": 60}, "root: expected whole numbers of 0 to 54"),
        ({"rotations": np.zeros((1, 55, 4))}, "rotations: a quaternion is 0 0 0 0"),
        ({"translations": np.zeros((3, 55, 3))}, r"translations: the shape is \[3, 55, 3\]"),
        ({"rate": 0}, "has 1 poses at 0 frames per second"),
    ],
)
def test_poses_that_are_none_are_named(tmp_path: Path, change: dict[str, Any], sentence: str) -> None:
    skeleton = template()
    bind = skeleton.bind_pose
    write_poses(tmp_path / "a.npz", skeleton, Clip("a", 30.0, bind.rotations[None], bind.translations[None]))
    with np.load(tmp_path / "a.npz") as file:
        arrays = {**file} | change
    np.savez(tmp_path / "a.npz", **arrays)
    with pytest.raises(InputError, match=rf"a\.npz: {sentence}"):
        read_poses(tmp_path / "a.npz")
