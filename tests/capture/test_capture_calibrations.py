"""Calibrations of public tools: every format gives the cameras that its formula says; folders become captures."""

import json
import struct
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from calibration_files import (
    LENS,
    MATRICES,
    NAMES,
    ROUNDING,
    SIZE,
    K,
    actorshq,
    colmap,
    colmap_binary,
    easymocap,
    toml,
    transforms,
    vector,
    write,
)
from captures import MIDDLE, make_capture
from commands import Commands
from PIL import Image

from mua.capture import Capture, open_capture
from mua.capture.conventions import read_axes
from mua.capture.readers.calibrations import read_cameras
from mua.capture.silhouette import pixels
from mua.errors import InputError
from mua.player.video import write_video

KINDS = (
    "anipose",
    "caliscope",
    "actorshq",
    "transforms",
    "easymocap",
    "easymocap without sizes",
    "colmap",
    "colmap binary",
)


@pytest.mark.parametrize("kind", KINDS)
def test_cameras_see_points_where_the_formula_says(tmp_path: Path, kind: str) -> None:
    points = np.random.default_rng(2).normal(MIDDLE, 0.4, (20, 3))
    cameras = read_cameras(write(tmp_path, kind))
    assert [one.name.split("/")[0] for one in cameras] == list(NAMES)
    for one, matrix in zip(cameras, MATRICES, strict=True):
        camera = one.camera(SIZE, name="a", scale=1, axes=np.eye(3))
        seen = (matrix[:3, :3] @ points.T + matrix[:3, 3:]).T @ K.T
        found, depth = pixels(camera, points)
        np.testing.assert_allclose(found, seen[:, :2] / seen[:, 2:] + 0.5, atol=ROUNDING)
        np.testing.assert_allclose(depth, seen[:, 2], atol=ROUNDING)
        assert (camera.size, camera.distortion) == (SIZE, (0.0,) * 5 if kind == "actorshq" else (*LENS, 0.0))
        assert (one.size is None) == (kind == "easymocap without sizes")


@pytest.mark.parametrize("points", ["", " ", "1.0 2.0 -1 "])
@pytest.mark.parametrize("last_line", [True, False], ids=["whole", "without its last line"])
def test_images_of_colmap_without_points_are_cameras_too(tmp_path: Path, points: str, last_line: bool) -> None:
    """A model of known poses has no points: each second line is empty, and an editor may have cut the last one off."""
    colmap(tmp_path)
    text = (tmp_path / "images.txt").read_text().replace("1.0 2.0 -1 ", points)
    (tmp_path / "images.txt").write_text(text if last_line else text.removesuffix(f"{points}\n"))
    cameras = read_cameras(tmp_path)
    assert [one.name for one in cameras] == [f"{name}/000000" for name in NAMES]
    np.testing.assert_allclose([one.world_to_camera for one in cameras], MATRICES, atol=ROUNDING)


@pytest.mark.parametrize(
    ("model", "number", "parameters", "focal", "distortion"),
    [
        ("SIMPLE_PINHOLE", 0, (61.0, 19.7, 11.6), (61.0, 61.0), (0, 0, 0, 0, 0)),
        ("PINHOLE", 1, (61.0, 60.0, 19.7, 11.6), (61.0, 60.0), (0, 0, 0, 0, 0)),
        ("SIMPLE_RADIAL", 2, (61.0, 19.7, 11.6, 0.1), (61.0, 61.0), (0.1, 0, 0, 0, 0)),
        ("RADIAL", 3, (61.0, 19.7, 11.6, 0.1, 0.2), (61.0, 61.0), (0.1, 0.2, 0, 0, 0)),
        ("OPENCV", 4, (61.0, 60.0, 19.7, 11.6, 0.1, 0.2, 0.3, 0.4), (61.0, 60.0), (0.1, 0.2, 0.3, 0.4, 0)),
        (
            "FULL_OPENCV",
            6,
            (61.0, 60.0, 19.7, 11.6, 0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0),
            (61.0, 60.0),
            (0.1, 0.2, 0.3, 0.4, 0.5),
        ),
    ],
)
@pytest.mark.parametrize("binary", [False, True])
def test_every_model_of_colmap_is_read(
    tmp_path: Path,
    model: str,
    number: int,
    parameters: tuple[float, ...],
    focal: tuple[float, float],
    distortion: tuple[float, ...],
    binary: bool,
) -> None:
    if binary:
        colmap_binary(tmp_path)
        other = struct.pack("<iiQQd", 6, 0, 9, 9, 5.0) + struct.pack("<dd", 4, 4)  # before it: sizes of models differ
        lens = struct.pack(f"<iiQQ{len(parameters)}d", 7, number, 40, 24, *parameters)
        (tmp_path / "cameras.bin").write_bytes(struct.pack("<Q", 2) + other + lens)
    else:
        colmap(tmp_path)
        (tmp_path / "cameras.txt").write_text(f"7 {model} 40 24 {' '.join(map(str, parameters))}\n")
    cameras = read_cameras(tmp_path)
    assert len(cameras) == len(NAMES)
    for one in cameras:
        assert (one.size, one.focal, one.centre, one.distortion) == (SIZE, focal, (19.7, 11.6), distortion)


def test_cameras_that_a_toml_ignores_are_left_out(tmp_path: Path) -> None:
    first, second = toml().split("[cam_02]")
    (tmp_path / "Calib.toml").write_text(f"{first}ignore = true\n[cam_02]\nignore = false{second}")
    assert [one.name for one in read_cameras(tmp_path / "Calib.toml")] == ["cam_02"]


def test_cameras_of_easymocap_need_one_rotation_and_no_distortion(tmp_path: Path) -> None:
    easymocap(tmp_path)
    for file, key in (("extri.yml", "R"), ("intri.yml", "dist")):
        text = (tmp_path / file).read_text()
        (tmp_path / file).write_text(text.replace(f"{key}_cam", f"other_{key}_cam"))
    cameras = read_cameras(tmp_path)
    np.testing.assert_allclose([one.world_to_camera for one in cameras], MATRICES, atol=ROUNDING)
    assert [one.distortion for one in cameras] == [(0.0,) * 5] * 2


def test_unit_and_axes_of_the_world_are_taken_back(tmp_path: Path) -> None:
    """A world of millimetres whose X, Y, Z are our Z, X, Y sees the same as ours."""
    turned = read_axes("Z,X,Y")
    points = np.random.default_rng(2).normal(MIDDLE, 0.4, (20, 3))
    for one, matrix in zip(read_cameras(write(tmp_path, "anipose")), MATRICES, strict=True):
        theirs = matrix.copy()
        theirs[:3, :3] = matrix[:3, [2, 0, 1]]
        theirs[:3, 3] *= 1000
        camera = replace(one, world_to_camera=theirs).camera(SIZE, name="a", scale=0.001, axes=turned)
        np.testing.assert_allclose(camera.world_to_camera, matrix, atol=ROUNDING)
    np.testing.assert_allclose(points @ turned.T, points[:, [2, 0, 1]])
    up = np.array([0.0, 1, 0])
    np.testing.assert_array_equal(read_axes("X,-Z,Y") @ up, [0, 0, 1])


@pytest.mark.parametrize("text", ["X,Y", "X,Y,Y", "X,Z,Y", "a,b,c", "X,Y,--Z"])
def test_axes_that_are_none_are_refused(text: str) -> None:
    with pytest.raises(InputError, match=f"--axes {text}: expected what X, Y and Z of the calibration are"):
        read_axes(text)


def test_smaller_pictures_have_a_smaller_camera(tmp_path: Path) -> None:
    one = read_cameras(write(tmp_path, "anipose"))[0]
    camera = one.camera((20, 12), name="a", scale=1, axes=np.eye(3))
    np.testing.assert_allclose([*camera.focal, *camera.centre], [30.5, 30.0, 9.85, 5.8])
    with pytest.raises(InputError, match="camera cam_01: was calibrated for images of 40 x 24, those of a are 20 x 24"):
        one.camera((20, 24), name="a", scale=1, axes=np.eye(3))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[a", "Calib.toml: cannot be read as TOML"),
        ("a = 1", "Calib.toml: holds no camera: no table has a matrix"),
        (toml(fisheye="true"), "camera cam_01: has a fisheye lens; undistort"),
        (toml(distortions="[0, 0, 0, 0, 0, 1]"), "camera cam_01: the distortion has 6 coefficients; expected k1, k2"),
        (toml(rotation="[1.0, 2.0]"), "camera cam_01: rotation has 2 numbers, expected 3 or 9"),
        (
            toml(rotation="[[1, 0, 0], [0, 1, 0], [0, 0, -1]]"),
            "camera cam_01: the rotation matrix is not orthonormal and right-handed",
        ),
        (toml(translation="[1.0, nan, 1.0]"), "camera cam_01: translation"),
        (toml(matrix="[[-61, 0, 1], [0, 61, 1], [0, 0, 1]]"), "focal lengths are -61 and 61, expected above 0"),
        (toml(matrix="[[61, 9, 1], [0, 61, 1], [0, 0, 1]]"), "camera cam_01: the skew is 9, expected 0"),
        (toml(size="[0, 24]"), "camera cam_01: size is 0 x 24"),
        (toml().replace("translation", "place"), "camera cam_01: holds no translation"),
    ],
)
def test_what_a_toml_cannot_say_is_named(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "Calib.toml").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_cameras(tmp_path / "Calib.toml")


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("calibration.csv", actorshq().splitlines()[0], "holds no camera"),
        ("calibration.csv", actorshq().replace(",40,24,", ",40,x,"), "camera cam_01: w, h: expected 2 numbers"),
        ("calibration.csv", "#cameras,5", "calibration.csv: looks like RealityCapture's, which is not read; export"),
        ("transforms.json", "{", "transforms.json: cannot be read as JSON"),
        ("transforms.json", transforms(frames=[]), "expected an object with a list of at least one of frames"),
        ("transforms.json", transforms(camera_model="OPENCV_FISHEYE"), "or a fisheye; undistort the images first"),
        ("transforms.json", transforms(fl_x=0), "cam_01/000000.jpg: the focal lengths are 0 and 60, expected above 0"),
        ("transforms.json", transforms(fl_y="a"), "cam_01/000000.jpg: fl_y"),
        ("transforms.json", transforms(k4=0.1), "the distortion has 6 coefficients"),
        (
            "transforms_train.json",
            json.dumps({"camera_angle_x": 0.6, "frames": [{"file_path": "./train/r_0"}]}),
            "no tr",
        ),
        (
            "cameras.sfm",
            "{}",
            "looks like Meshroom's, which is not read; export COLMAP's .* with aliceVision_exportColmap",
        ),
        ("cameras.xml", "<document/>", "looks like Metashape's, which is not read; export COLMAP's"),
        ("out.yml", "%YAML:1.0", "looks like OpenCV or numpy's, which is not read; write OpenCV's matrices"),
        ("annots.npy", "", "looks like ZJU-MoCap's, which is not read; it is pickled, and opening it may run code"),
        ("cameras.txt", "", "is no calibration that is read; expected a .toml"),
    ],
)
def test_what_another_file_cannot_say_is_named(tmp_path: Path, name: str, text: str, sentence: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_cameras(tmp_path / name)


def test_what_other_files_cannot_say_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is no calibration that is read"):
        read_cameras(tmp_path)
    easymocap(tmp_path)
    extri = (tmp_path / "extri.yml").read_text()
    (tmp_path / "extri.yml").write_text(
        extri.replace("T_cam_01: !!opencv-matrix\n  rows: 3", "T_cam_01: !!opencv-matrix\n  rows: 4")
    )
    with pytest.raises(InputError, match=r"extri.yml: T_cam_01 is .*; expected 4 x 1 numbers"):
        read_cameras(tmp_path)
    (tmp_path / "extri.yml").write_text("")
    with pytest.raises(InputError, match=r"no camera has both K_ in intri.yml and T_ in extri.yml"):
        read_cameras(tmp_path)
    (tmp_path / "extri.yml").unlink()
    colmap(tmp_path, model="THIN_PRISM_FISHEYE")
    with pytest.raises(InputError, match="line 2: the camera model is THIN_PRISM_FISHEYE with 8 parameters; expected"):
        read_cameras(tmp_path)
    colmap(tmp_path)
    (tmp_path / "cameras.txt").write_text("8 PINHOLE 40 24 60 60 20 12\n")
    with pytest.raises(InputError, match=r"cam_01/000000.jpg: its camera 7 is not in cameras.txt"):
        read_cameras(tmp_path)
    (tmp_path / "cameras.txt").unlink()
    (tmp_path / "images.txt").unlink()
    colmap_binary(tmp_path)
    whole = (tmp_path / "images.bin").read_bytes()
    for length in range(whole.index(b"cam_01")):
        (tmp_path / "images.bin").write_bytes(whole[:length])
        with pytest.raises(InputError, match="cannot be read as COLMAP's: a file is cut short or damaged"):
            read_cameras(tmp_path)


@pytest.fixture(scope="module")
def person(tmp_path_factory: pytest.TempPathFactory) -> Capture:
    return make_capture(tmp_path_factory.mktemp("person"))


@pytest.fixture
def given(person: Capture) -> tuple[object, ...]:
    return ("--template", person.template, "--motion", person.clips[0].motion)


def test_videos_become_a_capture(given: tuple[object, ...], command: Commands, tmp_path: Path) -> None:
    source = tmp_path / "anna"
    for kind, light in (("videos", 90), ("masks", 255)):
        (source / kind).mkdir(parents=True)
        for name, frames in (("cam01", 6), ("cam02", 5)):
            pictures = (np.full((SIZE[1], SIZE[0], 3), light, np.uint8) for _ in range(frames))
            write_video(source / kind / f"{name}.mp4", pictures, rate=25)
    calibration = write(tmp_path, "anipose")
    ended = command("capture", "describe", source, *given, "--calibration", calibration, "-o", tmp_path / "out")
    assert "2 cameras, 5 frames in 1 clip" in ended.out, ended
    capture = open_capture(tmp_path / "out")
    assert (capture.rate, [camera.name for camera in capture.cameras]) == (25, ["cam01", "cam02"])
    np.testing.assert_allclose(capture.camera("cam02").world_to_camera, MATRICES[1], atol=ROUNDING)
    view = capture.view("all", 4, "cam02")
    assert (view.image.shape, bool(view.mask.max() > 0.98)) == ((SIZE[1], SIZE[0], 3), True)


def test_pictures_become_clips_without_those_that_a_camera_lacks(
    given: tuple[object, ...], command: Commands, tmp_path: Path
) -> None:
    source = tmp_path / "anna"
    for name in NAMES:
        for kind in ("images", "masks"):
            (source / kind / name).mkdir(parents=True)
            for number in range(3, 10):
                Image.new("RGB", SIZE, (20 * number,) * 3).save(source / kind / name / f"{number:04d}.png")
    (source / "masks" / NAMES[1] / "0006.png").unlink()
    easymocap(tmp_path, sized=False)
    line = ("describe", source, *given, "--calibration", tmp_path, "-o", tmp_path / "out", "--rate", 50)
    assert "2 cameras, 6 frames in 2 clips" in command("capture", *line).out
    said = json.loads((tmp_path / "out" / "capture.json").read_text())
    assert [(clip["first"], clip["first_image"], clip["frames"]) for clip in said["clips"]] == [(0, 3, 3), (4, 7, 3)]
    assert said["rate"] == 50
    image = open_capture(tmp_path / "out").view("frames_000007", 1, NAMES[0]).image
    assert image[SIZE[1] // 2, SIZE[0] // 2, 0] == pytest.approx(160 / 255, abs=0.01)


@pytest.mark.parametrize(
    ("images", "masks"),
    [
        ("rgbs/{0}/{0}_rgb{1:06d}.jpg", "masks/{0}/{0}_mask{1:06d}.png"),  # ActorsHQ
        ("{0}/{1:06d}.jpg", "mask_cihp/{0}/{1:06d}.png"),  # ZJU-MoCap
        ("images/{0}/capture-f{1:05d}.png", "masks/{0}/mask-f{1:05d}.png"),  # 4D-Dress
    ],
)
def test_pictures_are_found_by_the_names_of_data_sets(
    given: tuple[object, ...], command: Commands, tmp_path: Path, images: str, masks: str
) -> None:
    source = tmp_path / "anna"
    for pattern in (images, masks):
        for name, number in product(NAMES, range(11, 14)):
            place = source / pattern.format(name, number)
            place.parent.mkdir(parents=True, exist_ok=True)
            Image.new("L", SIZE, 13).save(place)  # as a mask, the label of a part of the body
    (source / "calibration.csv").write_text(actorshq())
    line = ("describe", source, "-o", tmp_path / "out")
    ask = command("capture", *line).sentence
    assert f"with --calibration {source / 'calibration.csv'}, the person with --template" in ask
    ended = command("capture", *line, *given, "--calibration", source)
    assert "2 cameras, 3 frames in 1 clip" in ended.out, ended
    view = open_capture(tmp_path / "out").view("all", 2, NAMES[1])
    assert (view.mask == 1).all()
    assert view.image.max() < 0.1


def test_a_data_set_that_is_not_read_says_the_way_out(command: Commands, tmp_path: Path) -> None:
    (tmp_path / "Capture").mkdir()
    (tmp_path / "Capture" / "cameras.pkl").touch()
    assert "looks like 4D-Dress's" in command("capture", "describe", tmp_path, "-o", tmp_path / "out").sentence
    assert "capture.json, which mua-capture describe writes" in command("capture", "check", tmp_path).sentence


def test_cameras_are_those_of_their_name_whatever_the_order_of_the_file(
    given: tuple[object, ...], command: Commands, tmp_path: Path
) -> None:
    source, calibration = tmp_path / "anna", write(tmp_path, "anipose")
    first, second = calibration.read_text().removesuffix("[metadata]\nerror = 0.1\n").split("[cam_02]")
    calibration.write_text(f"[cam_02]{second}{first}")
    for name in NAMES:
        (source / "images" / name).mkdir(parents=True)
        for number in range(2):
            Image.new("RGB", SIZE).save(source / "images" / name / f"{number}.png")
    line = ("describe", source, *given, "--calibration", calibration, "-o", tmp_path / "out")
    ended = command("capture", *line, "--height", 1.5, "--leave-out", "hat", "--leave-out", "shoes")
    assert ended.status == 0, ended
    capture = open_capture(tmp_path / "out")
    for name, matrix in zip(NAMES, MATRICES, strict=True):
        np.testing.assert_allclose(capture.camera(name).world_to_camera, matrix, atol=ROUNDING)
    assert (capture.template_height, capture.leave_out) == (1.5, ("hat", "shoes"))


def test_the_command_takes_unit_and_axes_back(given: tuple[object, ...], command: Commands, tmp_path: Path) -> None:
    """The cameras of a calibration in millimetres whose X, Y, Z are our Z, X, Y."""
    for name in NAMES:
        (tmp_path / "anna" / "images" / name).mkdir(parents=True)
        for number in range(2):
            Image.new("RGB", SIZE).save(tmp_path / "anna" / "images" / name / f"{number}.png")
    calibration = write(tmp_path, "anipose")
    text = calibration.read_text()
    for matrix in MATRICES:
        turned = np.column_stack([matrix[:3, [2, 0, 1]], 1000 * matrix[:3, 3]])
        text = text.replace(str(vector(matrix).tolist()), str(vector(turned).tolist()))
        text = text.replace(str(matrix[:3, 3].tolist()), str(turned[:, 3].tolist()))
    calibration.write_text(text)
    line = ("describe", tmp_path / "anna", *given, "--calibration", calibration, "-o", tmp_path / "out")
    ended = command("capture", *line, "--axes", "Z,X,Y", "--scale", 0.001)
    assert ended.status == 0, ended
    for camera, matrix in zip(open_capture(tmp_path / "out").cameras, MATRICES, strict=True):
        np.testing.assert_allclose(camera.world_to_camera, matrix, atol=ROUNDING)


def test_what_a_folder_lacks_is_named(given: tuple[object, ...], command: Commands, tmp_path: Path) -> None:
    source, calibration = tmp_path / "anna", write(tmp_path, "anipose")
    source.mkdir()
    line = ("describe", source, "-o", tmp_path / "out")
    calibrated = (*line, "--calibration", calibration, *given)
    assert "found no images; looked for videos/cam00.mp4" in command("capture", *calibrated).sentence
    assert (
        "expected --template and --motion with it" in command("capture", *line, "--calibration", calibration).sentence
    )
    assert "--axes and --scale apply to a --calibration" in command("capture", *line, *given, "--scale", 0.001).sentence
    for name in ("cam01", "side"):
        (source / "images" / name).mkdir(parents=True)
        Image.new("RGB", SIZE).save(source / "images" / name / "0.png")
    assert "has no camera called side, as images in" in command("capture", *calibrated).sentence
    (source / "images" / "side").rename(source / "images" / "cam02")
    assert "no two frames in a row have images and masks of all 2 cameras" in command("capture", *calibrated).sentence
    (source / "images" / "cam02" / "0.png").unlink()
    for place in ("cam01/1.png", "cam02/0.jpg", "cam02/1.jpg"):
        Image.new("RGB", SIZE).save(source / "images" / place)
    assert command("capture", *calibrated).sentence.endswith("cam02/0.png is the first that is not there")
    calibration.write_text(toml(head="cameras.x{name}", name="'a'"))
    assert "two cameras are called a; expected one for each" in command("capture", *calibrated).sentence
    assert not (tmp_path / "out" / "capture.json").exists()
