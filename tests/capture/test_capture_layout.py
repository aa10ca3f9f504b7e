"""capture.json: what is written is read back, and each way to be wrong has its sentence."""

import json
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from captures import looking

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.capture import Capture, CaptureCamera, CaptureClip, open_capture, write_capture
from mua.capture.view import smaller
from mua.errors import InputError
from mua.kernels.splat_project import eye_ellipses

ROUNDING = 1e-12  # of pixels in the hundreds, in float64


def tilted_camera(**changes: Any) -> CaptureCamera:
    turned = looking(np.array([1.5, 1.2, 3.0]), np.array([0.1, 0.9, 0.0]))
    camera = CaptureCamera("cam00", (320, 240), (410.0, 395.0), (171.3, 98.6), turned)
    return replace(camera, **changes)


@pytest.fixture
def capture(tmp_path: Path) -> Capture:
    """A capture whose capture.json is written, and which names files that are there."""
    (tmp_path / "template.glb").write_bytes(b"glTF")
    (tmp_path / "walk.bvh").write_text("HIERARCHY")
    found = Capture(
        folder=tmp_path,
        name="anna",
        rate=25.0,
        template=tmp_path / "template.glb",
        cameras=(tilted_camera(), tilted_camera(name="cam01", distortion=(0.1, -0.2, 1e-3, 2e-3, 0.05), held_out=True)),
        clips=(
            CaptureClip("walk", tmp_path / "walk.bvh", 10, 4, first_image=3),
            CaptureClip("run", tmp_path / "walk.bvh", 0, 2, True),
        ),
        images="images/{clip}/{camera}/{frame:06d}.png",
        masks="masks/{clip}/{camera}.mp4",
        template_height=1.7,
        leave_out=("floor",),
    )
    write_capture(found)
    return found


def test_what_is_written_is_read_back(capture: Capture) -> None:
    found = open_capture(capture.folder)
    for mine, other in zip(capture.cameras, found.cameras, strict=True):
        np.testing.assert_array_equal(mine.world_to_camera, other.world_to_camera)
        same = replace(other, world_to_camera=mine.world_to_camera)
        assert vars(same) == vars(mine)
    assert vars(replace(found, cameras=capture.cameras)) == vars(capture)


def test_every_field_is_written(capture: Capture) -> None:
    patterns: dict[str, Any] = {
        "backgrounds": "b/{camera}.png",
        "meshes": "m/{clip}/{frame}.ply",
        "tracks": "{clip}.npz",
    }
    whole = replace(capture, **patterns, tracks_2d="t/{clip}/{camera}.npz", trim_masks=2)
    write_capture(whole)
    found = open_capture(capture.folder)
    assert not [field.name for field in fields(Capture) if getattr(found, field.name) == field.default]
    assert vars(replace(found, cameras=whole.cameras)) == vars(whole)


def test_a_smaller_picture_keeps_its_shape_to_half_a_pixel() -> None:
    assert [smaller(tilted_camera(), rows).size for rows in (100, 101, 1, None)] == [
        (133, 100),
        (135, 101),
        (1, 1),
        (320, 240),
    ]


def test_a_folder_that_was_moved_is_read_where_it_is(capture: Capture, tmp_path: Path) -> None:
    moved = tmp_path.with_name("moved")
    tmp_path.rename(moved)
    assert open_capture(moved).clips[0].motion == moved / "walk.bvh"


def test_a_pattern_names_the_file_of_a_frame(capture: Capture) -> None:
    place = capture.place(capture.images, clip="walk", camera="cam00", frame=2)
    assert place == capture.folder / "images/walk/cam00/000005.png"


def test_cameras_and_clips_are_found_by_name(capture: Capture) -> None:
    assert capture.camera("cam01") is capture.cameras[1]
    with pytest.raises(InputError, match="clips: none is called 'jump'; there are walk, run"):
        capture.clip("jump")


def opencv_pixels(camera: CaptureCamera, points: Array) -> Array:
    """Columns and rows [N, 2] by OpenCV's formula without distortion."""
    x, y, z = camera.world_to_camera[:3, :3] @ points.T + camera.world_to_camera[:3, 3:]
    assert (z > 0).all()
    return np.stack([camera.focal[0] * x / z + camera.centre[0], camera.focal[1] * y / z + camera.centre[1]], axis=1)


def drawn_pixels(camera: Camera, points: Array) -> Array:
    """Where our kernel puts the middles of splats."""
    tiny = np.tile([1e-8, 0, 0, 1e-8, 0, 1e-8], (len(points), 1))
    return eye_ellipses(points, tiny, camera.view, camera.projection, camera.screen, camera.near)[:, :2]


@pytest.mark.parametrize("box", [(0, 0, 320, 240), (37, 11, 200, 230), (-20, -30, 300, 400)])
@pytest.mark.parametrize("scale", [1, 0.5])
def test_splats_fall_where_opencv_projects_them(box: tuple[int, int, int, int], scale: float) -> None:
    points = np.random.default_rng(5).normal([0.1, 0.9, 0.0], 0.3, (40, 3))
    camera = tilted_camera()
    expected = (opencv_pixels(camera, points) - box[:2]) * scale
    size = (round((box[2] - box[0]) * scale), round((box[3] - box[1]) * scale))
    exact = np.array(size) / scale / (box[2] - box[0], box[3] - box[1])  # half of an odd side is no whole number
    seen = drawn_pixels(camera.cropped(box).resized(size).camera(), points)
    np.testing.assert_allclose(seen, expected * exact, atol=1e3 * ROUNDING)


def test_a_camera_stands_where_its_view_does() -> None:
    camera = tilted_camera()
    np.testing.assert_allclose(camera.position, [1.5, 1.2, 3.0], atol=ROUNDING)
    np.testing.assert_allclose(camera.camera().position, camera.position, atol=ROUNDING)


def test_a_field_of_view_reaches_from_edge_to_edge() -> None:
    camera = tilted_camera(centre=(110.0, 90.0), focal=(190.0, 80.0))
    assert camera.field_of_view == pytest.approx(np.degrees(np.arctan2(110, 190) + np.arctan2(320 - 110, 190)))


def changed(capture: Capture, change: Callable[[dict[str, Any]], Any]) -> None:
    """Put a fault into capture.json."""
    said = json.loads(capture.file.read_text())
    change(said)
    capture.file.write_text(json.dumps(said))


FAULTS: dict[str, tuple[Callable[[dict[str, Any]], Any], str]] = {
    "another format": (lambda s: s.update(format="nerf"), "format is 'nerf', version 1"),
    "a newer version": (lambda s: s.update(version=2), r"version 2 \(int\); this program reads 'mua-capture', vers"),
    "no rate": (lambda s: s.pop("rate"), "holds no rate"),
    "a rate of none": (lambda s: s.update(rate=0), "rate is 0; expected 1 to 1000 frames per second"),
    "a rate that is text": (lambda s: s.update(rate="25"), "rate: has elements of type"),
    "a field too many": (lambda s: s.update(mask="m"), "'mask' is no field; there are"),
    "no cameras": (lambda s: s.update(cameras=[]), "cameras is .*; expected a list of at least one"),
    "a template that is missing": (lambda s: s.update(template="no.glb"), "no.glb: there is no such file"),
    "a motion that is missing": (lambda s: s["clips"][0].update(motion="no.bvh"), "no.bvh: there is no such file"),
    "a template that is no text": (lambda s: s.update(template=3), r"template is 3 \(int\); expected a text"),
    "an impossible height": (lambda s: s.update(template_height=1700), "template_height is 1700; expected 0.01 to 100"),
    "one thing to leave out": (lambda s: s.update(leave_out="floor"), "leave_out is 'floor'; expected a list of names"),
    "masks trimmed by too much": (lambda s: s.update(trim_masks=64), "trim_masks is 64; expected at most 32 pixels"),
    "a clip's name with a slash": (lambda s: s["clips"][0].update(name="a/b"), r"clips\[0\]: name is 'a/b'"),
    "two clips of a name": (lambda s: s["clips"][1].update(name="walk"), "clips: two are called 'walk'"),
    "two cameras of a name": (lambda s: s["cameras"][1].update(name="cam00"), "cameras: two are called 'cam00'"),
    "no frames": (lambda s: s["clips"][0].update(frames=0), r"clips\[0\] \(walk\): frames is 0 \(int\); .* at least 1"),
    "frames that are a flag": (
        lambda s: s["clips"][0].update(frames=True),
        r"frames is True \(bool\); expected a whole",
    ),
    "a pixel and a half": (
        lambda s: s["cameras"][0].update(size=[320.5, 240]),
        r"size is \[320.5, 240\]; expected width",
    ),
    "three coefficients": (
        lambda s: s["cameras"][0].update(distortion=[0.1] * 3),
        "has 3 coefficients; expected OpenCV",
    ),
    "a clip that is the folder": (
        lambda s: s["clips"][0].update(name=".."),
        r"name is '\.\.'; expected a name that can",
    ),
    "a path that no file has": (lambda s: s.update(template="a\0b"), "template is .*; expected a text"),
    "an image larger than any": (lambda s: s["cameras"][0].update(size=[32769, 240]), "1 to 32768 pixels"),
    "a turn that stretches": (
        lambda s: s["cameras"][0]["world_to_camera"][1].__setitem__(slice(0, 3), [0.0, 1.01, 0.0]),
        "not a rotation: its rows have lengths 1, 1.01, 1",
    ),
    "half a frame": (lambda s: s["clips"][0].update(first=0.5), r"\(walk\): first is 0.5"),
    "held out by a text": (lambda s: s["clips"][0].update(held_out="no"), "held_out is 'no'; expected true or false"),
    "images of one camera": (
        lambda s: s.update(images="{clip}/{frame}.png"),
        r"images is .* expected {camera} in it",
    ),
    "images of one clip": (
        lambda s: s.update(images="{camera}/{frame}.png", clips=[{**clip, "first_image": 0} for clip in s["clips"]]),
        r"images is .* expected {clip} in it",
    ),
    "braces of another name": (lambda s: s.update(images="{clip}/{view}.png"), "and no other braces"),
    "braces that do not close": (lambda s: s.update(images="{clip}/{camera.png"), "and no other braces"),
    "one mesh for all frames": (lambda s: s.update(meshes="{clip}.ply"), "expected a file for each {frame}"),
    "a negative focal length": (
        lambda s: s["cameras"][1].update(focal=[-410, 395]),
        r"cameras\[1\] \(cam01\): focal is \[-410, 395\]; expected two lengths above 0",
    ),
    "a size of one number": (lambda s: s["cameras"][0].update(size=[320]), r"\(cam00\): size: the shape is \[1\]"),
    "half a pixel": (lambda s: s["cameras"][0].update(size=[320, 0.5]), r"\(cam00\): size is \[320, 0.5\]"),
    "a centre that is no number": (
        lambda s: s["cameras"][0].update(centre=[float("nan"), 1]),
        "a value is not",
    ),
    "distortion of another model": (
        lambda s: s["cameras"][0].update(distortion=[0.1] * 8),
        "distortion: has 8 coefficients; expected OpenCV's k1, k2, p1, p2, k3; undistort the images",
    ),
    "columns for rows": (
        lambda s: s["cameras"][0].update(world_to_camera=np.transpose(s["cameras"][0]["world_to_camera"]).tolist()),
        "world_to_camera: the last row is",
    ),
    "a mirror": (lambda s: s["cameras"][0].update(world_to_camera=np.diag([-1.0, 1, 1, 1]).tolist()), "it mirrors"),
    "a scale": (
        lambda s: s["cameras"][0].update(world_to_camera=np.diag([1e3, 1e3, 1e3, 1]).tolist()),
        "not a rotation: its rows have lengths 1000, 1000, 1000",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_names_what_cannot_be(capture: Capture, fault: str) -> None:
    change, sentence = FAULTS[fault]
    changed(capture, change)
    with pytest.raises(InputError, match=sentence):
        open_capture(capture.folder)


def test_clips_may_be_parts_of_one_film(capture: Capture) -> None:
    """Frames 3 to 6 are walk's; run's begin after them, or with the last of them."""
    for first, apart in ((7, True), (6, False)):
        changed(capture, lambda s, first=first: s["clips"][1].update(first_image=first))  # type: ignore[misc]
        changed(capture, lambda s: s.update(images="{camera}.mp4", masks="{camera}.mp4"))
        if apart:
            assert open_capture(capture.folder).clips[1].first_image == first
        else:
            with pytest.raises(InputError, match=r"expected {clip} in it"):
                open_capture(capture.folder)


def test_four_coefficients_leave_the_last_at_none(capture: Capture) -> None:
    changed(capture, lambda s: s["cameras"][0].update(distortion=[0.1, 0.2, 0.3, 0.4]))
    assert open_capture(capture.folder).cameras[0].distortion == (0.1, 0.2, 0.3, 0.4, 0.0)


def test_refuses_a_folder_that_is_no_capture(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"not a capture, it holds no capture\.json"):
        open_capture(tmp_path)
    with pytest.raises(InputError, match="there is no such directory"):
        open_capture(tmp_path / "absent")
    (tmp_path / "capture.json").write_text("{")
    with pytest.raises(InputError, match=r"capture.json: cannot be read as JSON: .* line 1"):
        open_capture(tmp_path)
