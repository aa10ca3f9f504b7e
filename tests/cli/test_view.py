"""mua-view writes the image or video that it is asked for and refuses what it cannot show in a sentence."""

import json
import subprocess
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
from bvh_files import BVH
from commands import process
from PIL import Image

from mua.cli.view import view
from mua.errors import InputError
from mua.gpu import adapters

SHADES = 2  # of 255, by which float32 may differ where many splats meet, and one for rounding to 8 bits
CODED_SHADES = 3  # of 255, by which a plain colour may come back from 8-bit YCbCr: rounded thrice


def video(path: Path, *, side: int, channels: int = 3) -> np.ndarray:
    """Images [F, H, W, channels] of a video of square images."""
    clear = ["-c:v", "libvpx-vp9"] if path.suffix == ".webm" else []  # whose decoder reads transparency
    layout = "rgba" if channels == 4 else "rgb24"
    line = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *clear, "-i", path, "-f", "rawvideo", "-pix_fmt", layout]
    read = subprocess.run([*line, "-fps_mode", "passthrough", "-"], capture_output=True, check=True).stdout
    return np.frombuffer(read, np.uint8).reshape(-1, side, side, channels)


def pixels(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


def test_writes_an_image_of_the_size_and_background_asked_for(avatar_file: Path, tmp_path: Path) -> None:
    view(files=[avatar_file], output=tmp_path / "v.png", size="40x61", background="#204060")
    image = pixels(tmp_path / "v.png")
    assert image.shape == (61, 40, 3)
    np.testing.assert_array_equal(image[0, 0], [0x20, 0x40, 0x60])
    assert (image != image[0, 0]).any()


def test_frames_and_angles_differ(avatar_file: Path, tmp_path: Path) -> None:
    choices: list[dict[str, Any]] = [
        {},
        {"frame": 5},
        {"azimuth": 90.0},
        {"elevation": 60.0},
        {"zoom": 3.0},
        {"look_at": "middle"},
    ]
    for i, choice in enumerate(choices):
        view(files=[avatar_file], output=tmp_path / f"{i}.png", size="32", clip="wave", **choice)
    images = {pixels(tmp_path / f"{i}.png").tobytes() for i in range(len(choices))}
    assert len(images) == len(choices)


@pytest.mark.parametrize(
    ("name", "written"), [("v.png", "v.png: 40 x 60 pixels\n"), ("v.gif", "v.gif: 7 frames of 40 x 60 pixels, 0.3 s\n")]
)
def test_names_the_file_that_it_has_written(
    avatar_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, written: str
) -> None:
    view(files=[avatar_file], output=tmp_path / name, size="40x60")
    assert capsys.readouterr().out == f"{tmp_path}/{written}"


def test_a_transparent_picture_shows_the_figure_alone(avatar_file: Path, tmp_path: Path) -> None:
    for name, background in (("clear", "transparent"), ("black", "black"), ("white", "white")):
        view(files=[avatar_file], output=tmp_path / f"{name}.png", size="40x60", background=background)
    clear, black, white = (pixels(tmp_path / f"{name}.png").astype(float) for name in ("clear", "black", "white"))
    assert clear.shape == (60, 40, 4)
    assert clear[0, 0, 3] == 0
    assert clear[..., 3].max() > 128
    alpha = clear[..., 3:] / 255
    for shown, paper in ((black, 0), (white, 255)):
        composed = alpha * clear[..., :3] + (1 - alpha) * paper
        assert np.abs(composed - shown).max() <= SHADES


@pytest.mark.parametrize("name", ["v.webm", "v.gif"])
def test_a_transparent_video_is_clear_about_the_figure_alone(avatar_file: Path, tmp_path: Path, name: str) -> None:
    view(files=[avatar_file], output=tmp_path / name, size="64", frames="0:3", background="transparent")
    alpha = video(tmp_path / name, side=64, channels=4)[..., 3]
    assert len(alpha) == 3
    assert alpha[:, 0, 0].max() == 0
    assert (alpha > 200).mean() > 0.02


def test_a_turntable_shows_one_frame_from_all_sides_and_repeats_without_a_seam(
    avatar_file: Path, tmp_path: Path
) -> None:
    chosen: dict[str, Any] = {"size": "48", "frame": 3, "orbit": 360.0}
    view(files=[avatar_file], output=tmp_path / "v.webm", turntable=True, **chosen)
    pictures = video(tmp_path / "v.webm", side=48).astype(float)
    assert len(pictures) == 30  # a second
    steps = np.abs(pictures - np.roll(pictures, -1, axis=0)).mean(axis=(1, 2, 3))
    assert steps[-1] < 2 * np.median(steps)  # from the last to the first it is a step as any other
    assert np.abs(pictures[0] - pictures[15]).mean() > 2 * steps.max()


def test_command_exits_with_status_one_and_keeps_an_earlier_image(avatar_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "v.png"
    output.write_bytes(b"earlier")
    refused = process("view", avatar_file, "-o", output, "--clip", "jump")
    assert refused.sentence.startswith("error: --clip is 'jump'")
    assert refused.out == ""
    assert output.read_bytes() == b"earlier"


def test_the_device_and_the_cpu_reference_write_the_same_picture(avatar_file: Path, tmp_path: Path) -> None:
    for name, reference in (("device", False), ("reference", True)):
        view(files=[avatar_file], output=tmp_path / f"{name}.png", size="64x80", frame=3, reference=reference)
    found, expected = (pixels(tmp_path / f"{name}.png").astype(int) for name in ("device", "reference"))
    assert np.abs(found - expected).max() <= SHADES


def test_stereo_puts_two_different_eyes_side_by_side(
    avatar_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    view(files=[avatar_file], output=tmp_path / "v.png", size="40x60", stereo=True)
    assert capsys.readouterr().out.endswith("v.png: 80 x 60 pixels\n")
    image = pixels(tmp_path / "v.png")
    assert image.shape == (60, 80, 3)
    left, right = image[:, :40], image[:, 40:]
    columns = [np.nonzero((eye != 255).any(axis=(0, 2)))[0].mean() for eye in (left, right)]
    assert columns[0] > columns[1]  # what is near stands farther right in the left eye


def test_eyes_without_distance_see_the_same(avatar_file: Path, tmp_path: Path) -> None:
    view(files=[avatar_file], output=tmp_path / "v.png", size="32", stereo=True, ipd=0.0)
    image = pixels(tmp_path / "v.png")
    np.testing.assert_array_equal(image[:, :32], image[:, 32:])


def test_writes_a_video_of_the_frames_asked_for(avatar_file: Path, tmp_path: Path) -> None:
    view(files=[avatar_file], output=tmp_path / "v.mp4", size="64", frames="2:6", background="#204060")
    pictures = video(tmp_path / "v.mp4", side=64).astype(int)
    assert len(pictures) == 4
    assert np.abs(pictures[:, 0, 0] - [0x20, 0x40, 0x60]).max() <= CODED_SHADES
    assert [path.name for path in tmp_path.iterdir()] == ["v.mp4"]


def test_a_video_without_frames_named_holds_the_whole_clip(avatar_file: Path, tmp_path: Path) -> None:
    view(files=[avatar_file], output=tmp_path / "v.mp4", size="16")
    assert len(video(tmp_path / "v.mp4", side=16)) == 7


def test_the_camera_orbits_and_follows(avatar_file: Path, tmp_path: Path) -> None:
    choices: list[dict[str, Any]] = [{}, {"orbit": 90.0}, {"follow": True}]
    for i, choice in enumerate(choices):
        view(files=[avatar_file], output=tmp_path / f"{i}.mp4", size="32", **choice)
    assert len({video(tmp_path / f"{i}.mp4", side=32)[-1].tobytes() for i in range(len(choices))}) == len(choices)


def test_motion_of_another_file_moves_the_avatar(avatar_file: Path, tmp_path: Path) -> None:
    motion = tmp_path / "wave.bvh"
    motion.write_text(BVH)
    mapping = tmp_path / "joints.json"
    mapping.write_text(json.dumps({"root": "hips", "middle": "spine"}))
    for frame in (0, 2):
        chosen: dict[str, Any] = {"motion": motion, "mapping": mapping, "frame": frame}
        view(files=[avatar_file], output=tmp_path / f"{frame}.png", size="32", **chosen)
    assert (pixels(tmp_path / "0.png") != pixels(tmp_path / "2.png")).any()
    with pytest.raises(InputError, match=r"wave\.bvh"):
        view(files=[avatar_file], output=tmp_path / "v.png", motion=motion)


@pytest.mark.parametrize(
    ("name", "choice", "sentence"),
    [
        ("v.png", {"clip": "jump"}, "--clip is 'jump'; .* holds wave"),
        ("v.png", {"frame": 7}, "--frame is 7; clip 'wave' has frames 0 to 6"),
        ("v.png", {"frame": -1}, "--frame is -1; clip 'wave' has frames 0 to 6"),
        ("v.mp4", {"frames": "3"}, "--frames is '3'; expected FIRST:END"),
        ("v.mp4", {"frames": "a:b"}, "--frames is 'a:b'"),
        ("v.mp4", {"frames": "3:3"}, "--frames is '3:3'; clip 'wave' has frames 0 to 6"),
        ("v.mp4", {"frames": "0:8"}, "--frames is '0:8'; clip 'wave' has frames 0 to 6"),
        ("v.png", {"device": "no such device"}, "device no such device: no graphics device"),
        ("v.png", {"show": "skeleton", "reference": True}, "--reference draws only splats"),
    ],
)
def test_refuses_with_a_sentence_and_writes_nothing(
    avatar_file: Path, tmp_path: Path, name: str, choice: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        view(files=[avatar_file], output=tmp_path / name, **choice)
    assert list(tmp_path.iterdir()) == []


def test_refuses_several_files_for_one_picture(avatar_file: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected one FILE, found 2"):
        view(files=[avatar_file] * 2, output=tmp_path / "v.png")


def test_shows_what_is_toggled(avatar_file: Path, tmp_path: Path) -> None:
    for show in ("splats", "template", "geometry", "skeleton", "splats,shadow"):
        view(files=[avatar_file], output=tmp_path / f"{show}.png", size="48", show=show)
    assert len({pixels(path).tobytes() for path in tmp_path.glob("*.png")}) == 5


def test_without_a_display_says_so_and_offers_a_picture(avatar_file: Path) -> None:
    sentence = process("view", avatar_file, DISPLAY="", WAYLAND_DISPLAY="").sentence
    assert "display" in sentence
    assert "-o" in sentence


def test_lists_devices_without_a_file() -> None:
    listed = process("view", "--list-devices")
    assert listed.status == 0
    assert [line.split(":")[0] for line in listed.out.splitlines()] == [str(i) for i in range(len(adapters()))]
