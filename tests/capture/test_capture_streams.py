"""UMA's layout: cameras of both calibration formats see what their formulas say; videos, masks and what is refused."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from captures import MIDDLE, looking, make_capture
from commands import Commands

from mua.arrays import Array
from mua.capture import Capture, open_capture
from mua.capture.readers.calibration_files import CAPTURY, SKELETOOL, read_calibration
from mua.capture.silhouette import pixels
from mua.errors import InputError
from mua.player.video import write_video

SIZE = (40, 24)
PLACES = ([2.0, 1.5, 3.0], [-2.5, 0.5, 2.0], [0.5, 1.0, -3.0])
K = np.array([[61.0, 0, 19.2], [0, 61.0, 11.1], [0, 0, 1]])
ROUNDING = 1e-9


def matrices() -> list[Array]:
    """World to camera, millimetres."""
    found = [looking(np.array(place), MIDDLE) for place in PLACES]
    for matrix in found:
        matrix[:3, 3] *= 1000
    return found


def skeletool(*, radial: float = 0, animated: int = 0, mirrored: bool = False) -> str:
    lines = [SKELETOOL]
    for number, matrix in enumerate(matrices()):
        matrix[0] *= -1 if mirrored else 1
        intrinsic = np.eye(4)
        intrinsic[:3, :3] = K
        flat = {"intrinsic": intrinsic, "extrinsic": matrix}
        lines += [f"name {number}", "  sensor 10 10", f"  size {SIZE[0]} {SIZE[1]}", f"  animated {animated}"]
        lines += [f"  {key} {' '.join(map(repr, values.ravel().tolist()))}" for key, values in flat.items()]
        lines += [f"  radial {radial:g}"]
    return "\n".join([*lines, ""])


def captury(*, model: str = "OpenCV", focal: float = 61.0) -> str:
    """The cameras in TheCaptury's format: a sensor 8 mm wide, whose pixels are square."""
    pixel = 8 / SIZE[0]
    middle = (K[:2, 2] + 0.5 - np.array(SIZE) / 2) * pixel
    lines = [CAPTURY, "camera\tframe\tsensor"]
    for number, matrix in enumerate(matrices()):
        turn = matrix[:3, :3]
        origin = -turn.T @ matrix[:3, 3]
        cells = [number, 0, 8, SIZE[1] * pixel, focal * pixel, 1, *middle, model, 0.1, -0.02, 0, 0, 0]
        lines.append("\t".join(map(str, [*cells, *origin, *-turn[1], *turn[0]])))
    return "\n".join([*lines, ""])


@pytest.mark.parametrize("text", [skeletool(), captury()], ids=["skeletool", "captury"])
def test_cameras_see_points_where_the_formula_says(tmp_path: Path, text: str) -> None:
    (tmp_path / "cameras.calib").write_text(text)
    points = np.random.default_rng(2).normal(MIDDLE, 0.4, (20, 3))
    cameras = read_calibration(tmp_path / "cameras.calib", size=SIZE)
    for camera, matrix in zip(cameras, matrices(), strict=True):
        seen = (matrix[:3, :3] @ (1000 * points).T + matrix[:3, 3:]).T @ K.T
        found, depth = pixels(camera, points)
        np.testing.assert_allclose(found, seen[:, :2] / seen[:, 2:] + 0.5, atol=ROUNDING)
        np.testing.assert_allclose(depth, seen[:, 2] / 1000, atol=ROUNDING)
        assert camera.size == SIZE
    assert cameras[0].distortion[:2] == ((0.1, -0.02) if text.startswith(CAPTURY) else (0, 0))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("OpenGL\n", "the first line is 'OpenGL'; expected 'Skeletool Camera"),
        (SKELETOOL + "\n", "holds no camera"),
        (skeletool(radial=0.2), "camera 0: radial is 0.2; undistort"),
        (skeletool(animated=1), "camera 0: is animated"),
        (skeletool().replace("  extrinsic", "  polynomial"), "line 7: 'polynomial' is not read"),
        (skeletool().replace("size 40 24", "size 40"), "line 4: size is '40', expected 2 finite numbers"),
        (skeletool().replace("  size 40 24\n", ""), "camera 0: holds no size"),
        (skeletool().replace("name", "size"), "line 2: 'size' comes before the first camera's name"),
        (captury(model="fisheye"), "line 3: the distortion is 'fisheye', expected OpenCV"),
        (captury(focal=-61), "the focal length is -12.2 and"),
        (captury().replace("\t1\t", "\t0.9\t", 1), "line 3: the pixels' aspect is 0.9, expected 1"),
        (captury().replace("\t1\t", "\t1.1\t", 1), "line 3: the pixels' aspect is 1.1, expected 1"),
        (skeletool(mirrored=True), "camera 0: the rotation matrix is not orthonormal and right-handed"),
        (captury().replace("OpenCV\t", ""), "line 3: has 22 columns, expected 23"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "a.calibration").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_calibration(tmp_path / "a.calibration", size=SIZE)


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """Three videos of 6, 5 and 6 frames, their masks, and a calibration."""
    folder = tmp_path / "subject"
    (folder / "metadata").mkdir(parents=True)
    (folder / "metadata" / "cameras.calib").write_text(skeletool())
    for number in range(3):
        for place, light in ((folder, 90), (folder / "foregroundSegmentation", 255)):
            place.mkdir(exist_ok=True)
            frames = (np.full((SIZE[1], SIZE[0], 3), light, np.uint8) for _ in range(6 - (number == 1)))
            write_video(place / f"stream{number:03d}.mp4", frames, rate=25)
    return folder


@pytest.fixture(scope="module")
def person(tmp_path_factory: pytest.TempPathFactory) -> Capture:
    return make_capture(tmp_path_factory.mktemp("person"))


def test_videos_become_a_capture(source: Path, person: Capture, command: Commands, tmp_path: Path) -> None:
    given = ("--template", person.template, "--motion", person.clips[0].motion)
    ended = command("capture", "describe", source, *given, "-o", tmp_path / "out")
    assert "3 cameras, 5 frames in 1 clip" in ended.out, ended
    capture = open_capture(tmp_path / "out")
    assert (capture.rate, [camera.name for camera in capture.cameras]) == (25, ["stream000", "stream001", "stream002"])
    view = capture.view("all", 4, "stream001")
    assert (view.image.shape, view.mask.min() > 0.98) == ((SIZE[1], SIZE[0], 3), True)
    assert 255 * view.image.mean() == pytest.approx(90, abs=3)


def test_what_is_said_of_a_capture_is_in_its_description(
    source: Path, person: Capture, command: Commands, tmp_path: Path
) -> None:
    (source / "stream000.json").touch()  # which is no video
    (source / "metadata" / "cameras.calib").write_text(captury())  # which does not say how large images are
    given = ("--template", person.template, "--motion", person.clips[0].motion, "--rate", 12, "--height", 1.5)
    command("capture", "describe", source, *given, "--leave-out", "hat", "--leave-out", "shoes", "-o", tmp_path / "out")
    capture = open_capture(tmp_path / "out")
    assert (capture.rate, capture.template_height, capture.leave_out) == (12, 1.5, ("hat", "shoes"))
    assert [camera.size for camera in capture.cameras] == [SIZE] * 3


def test_masks_beside_folders_of_videos_are_no_videos_of_the_person(
    source: Path, person: Capture, command: Commands, tmp_path: Path
) -> None:
    training = source / "training"
    training.mkdir()
    for video in source.glob("stream*.mp4"):
        video.rename(training / f"{video.stem}.MP4")  # as some cameras call them
    shutil.copytree(source / "foregroundSegmentation", training / "foregroundSegmentation")
    given = ("--template", person.template, "--motion", person.clips[0].motion)
    command("capture", "describe", source, *given, "-o", tmp_path / "out")
    capture = open_capture(tmp_path / "out")
    assert [(clip.name, clip.frames) for clip in capture.clips] == [("training", 5)]


def test_masks_may_be_pictures(source: Path, person: Capture, command: Commands, tmp_path: Path) -> None:
    for number in range(3):
        (source / "foregroundSegmentation" / f"stream{number:03d}.mp4").unlink()
        (source / "foregroundSegmentation" / f"stream{number:03d}").mkdir()
        (source / "foregroundSegmentation" / f"stream{number:03d}" / "00000.png").touch()
    given = ("--template", person.template, "--motion", person.clips[0].motion)
    command("capture", "describe", source, *given, "-o", tmp_path / "out")
    masks = open_capture(tmp_path / "out").masks
    assert masks is not None
    assert masks.endswith("/foregroundSegmentation/{camera}/{frame:05d}.png")
    first = source / "foregroundSegmentation" / "stream000"
    (first / "00000.png").rename(first / "00001.png")
    ended = command("capture", "describe", source, *given, "-o", tmp_path / "out")
    assert (
        "stream000/00001.png: is the first mask of stream000; expected masks that are counted from 0" in ended.sentence
    )


def test_what_is_missing_is_named(source: Path, person: Capture, command: Commands, tmp_path: Path) -> None:
    given = ("--template", person.template, "-o", tmp_path / "out")
    motion = ("--motion", person.clips[0].motion)
    assert (
        "found no .character of the person; give --template and --motion"
        in command("capture", "describe", source, *given).sentence
    )
    (source / "foregroundSegmentation" / "stream000.mp4").unlink()
    ended = command("capture", "describe", source, *given, *motion)
    assert "foregroundSegmentation: found no masks of stream000" in ended.sentence
    (source / "stream001.mp4").unlink()
    ended = command("capture", "describe", source, *given, *motion)
    assert "has 2 videos, cameras.calib has 3 cameras" in ended.sentence
    (source / "other.calibration").write_text(skeletool())
    ended = command("capture", "describe", source, *given, *motion)
    assert "expected one calibration" in ended.sentence
    assert not (tmp_path / "out" / "capture.json").exists()
