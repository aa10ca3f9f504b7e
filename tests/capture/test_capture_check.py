"""mua-capture check: what is right passes, and each thing that cannot be right has its sentence."""

import hashlib
import pickle
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from captures import FRAMES, SIDE, make_capture, repaint
from commands import Commands
from PIL import Image
from scipy.ndimage import distance_transform_edt

from mua.arrays import Array
from mua.capture import Capture, camera_fit, sheet, silhouette, write_capture
from mua.capture.camera import CaptureCamera
from mua.capture.check import Checked, check_capture
from mua.capture.fit import Posed, Seen, chosen_frames, look_at
from mua.capture.lens import undistorted
from mua.capture.sheet import MASK, OUTLINE, check_sheet
from mua.player.video import write_video

OPENGL = np.diag([1.0, -1, -1, 1])
Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])  # from our world to one with Z up


@pytest.fixture(scope="module", autouse=True)
def _kept_outlines() -> Iterator[None]:
    """Outlines of the same vertices in the same camera are drawn once: captures here differ in few views."""
    drawn: dict[bytes, Array] = {}
    draw = silhouette.fine_silhouette

    def kept(*asked: Any) -> Array:
        key = hashlib.sha256(pickle.dumps(asked)).digest()
        if key not in drawn:
            drawn[key] = draw(*asked)
        return drawn[key]

    with pytest.MonkeyPatch.context() as patch:
        for module in (silhouette, camera_fit):
            patch.setattr(module, "fine_silhouette", kept)
        yield


@pytest.fixture
def damaged(tmp_path: Path) -> Capture:
    """A capture of its own, to be damaged."""
    return make_capture(tmp_path / "damaged")


def everything(capture: Capture) -> Checked:
    """All frames in all cameras, checked."""
    return check_capture(capture, frames=0)


def calibrated(capture: Capture, change: Callable[[Array], Array]) -> Capture:
    """The capture with other matrices; the template, which is slow to read, is the same."""
    cameras = tuple(replace(one, world_to_camera=change(one.world_to_camera)) for one in capture.cameras)
    return replace(capture, cameras=cameras)


def millimetres(matrix: Array) -> Array:
    return matrix * np.array([[1, 1, 1, 1e3]] * 3 + [[1, 1, 1, 1]])


def test_a_capture_that_is_right_has_no_problems(small_capture: Capture) -> None:
    checked = everything(small_capture)
    assert checked.problems == ()
    assert len(checked.views) == 4 * sum(FRAMES.values())
    for fit in checked.cameras:
        assert fit.mean is not None
        assert fit.mean > 0.9
        assert fit.least is not None
        assert fit.least.overlap <= fit.mean
        assert fit.distance == pytest.approx(3.2, abs=0.3)


CONVENTIONS: dict[str, tuple[Callable[[Array], Array], str]] = {
    "OpenGL's axes": (lambda m: OPENGL @ m, r"the cameras' axes are OpenGL's \(y up, z back\)\."),
    "the inverse": (np.linalg.inv, r"the matrices are camera_to_world, expected their inverse\."),
    "another axis up": (lambda m: m @ Z_UP, r"the calibration's world has other axes: its X, Y, Z are our X, -Z, Y\."),
    "millimetres": (millimetres, r"lengths are in millimetres\."),
    "all at once": (
        lambda m: millimetres(np.linalg.inv(OPENGL @ m @ Z_UP)),
        r"the matrices .* and the cameras' .* and the calibration's .* X, -Z, Y and lengths are in millimetres\.",
    ),
}


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_another_convention_is_found_by_what_fits(small_capture: Capture, convention: str) -> None:
    change, sentence = CONVENTIONS[convention]
    (problem,) = check_capture(calibrated(small_capture, change), frames=1).problems
    assert re.search(rf"^Outlines and masks overlap by \d+%; they would by 9\d% if {sentence}", problem), problem


def test_poses_that_began_earlier_are_found(small_capture: Capture) -> None:
    walk, reach = small_capture.clips
    (problem,) = everything(replace(small_capture, clips=(replace(walk, first=0), reach))).problems
    assert re.fullmatch(r"Clip walk: outlines .* they would by 9\d% with first = 1 in place of 0\.", problem)


def test_a_camera_with_the_pictures_of_another_is_named(damaged: Capture) -> None:
    for clip, frames in FRAMES.items():
        for frame in range(frames):
            own, other = (damaged.files(clip, frame, name).image for name in ("front", "above"))
            own.write_bytes(other.read_bytes())
    (problem,) = everything(damaged).problems
    assert re.fullmatch(r"Camera front: .*; they would by 9\d% if they had the calibration of camera above\.", problem)


def test_a_camera_that_nothing_explains_is_named(small_capture: Capture) -> None:
    front, left, *others = small_capture.cameras
    wrong = replace(front, world_to_camera=left.world_to_camera)
    (problem,) = everything(replace(small_capture, cameras=(wrong, left, *others))).problems
    assert problem.startswith("Camera front: overlaps by")
    assert problem.endswith("its calibration, or which images it has, cannot be right.")


def test_a_camera_that_sees_nobody_is_named(small_capture: Capture) -> None:
    front, *others = small_capture.cameras
    away = replace(front, world_to_camera=np.diag([-1.0, 1, -1, 1]) @ front.world_to_camera)
    (problem,) = everything(replace(small_capture, cameras=(away, *others))).problems
    assert problem == "Camera front sees nobody: the posed template is outside its image."


def test_a_mask_of_another_frame_is_named_with_the_frame(damaged: Capture) -> None:
    images = [damaged.files("walk", frame, "left").image for frame in (0, 3)]
    images[0].write_bytes(images[1].read_bytes())
    (problem,) = everything(damaged).problems
    assert re.fullmatch(r"Camera left, clip walk, frame 0: overlaps by .* the mask fits frame 3 by 9\d%\.", problem)


def test_masks_of_whole_images_are_named(damaged: Capture) -> None:
    for image in damaged.folder.glob("images/*/left/*.png"):
        Image.open(image).convert("RGB").convert("RGBA").save(image)
    (problem,) = check_capture(damaged, frames=1).problems
    assert problem.startswith("Camera left: all masks that were looked at (2) cover the whole image; expected white")


def test_empty_masks_are_named(damaged: Capture) -> None:
    for image in damaged.folder.glob("images/*/right/*.png"):
        Image.new("RGBA", (SIDE, SIDE)).save(image)
    assert everything(damaged).problems == ("Camera right: all masks that were looked at (6) are empty.",)


def test_missing_frames_and_cameras_are_named(damaged: Capture) -> None:
    frame, camera = damaged.files("walk", 2, "front").image, damaged.folder / "images" / "walk" / "above"
    frame.unlink()
    for image in damaged.folder.glob("images/*/above/*.png"):
        image.unlink()
    last = damaged.files("reach", 1, "left").image
    last.unlink()
    assert everything(damaged).problems == (
        f"Camera front: 1 of 6 images are missing, first {frame} of clip walk, frame 2.",
        f"Camera left: 1 of 6 images are missing, first {last} of clip reach, frame 1.",
        f"Camera above: has no images: there is no {camera / '000000.png'}.",
    )


def test_a_picture_of_another_size_is_named(damaged: Capture) -> None:
    """Once for each camera and clip."""
    views = [("front", 1), ("left", 1), ("left", 2)]
    images = [damaged.files("walk", frame, camera).image for camera, frame in views]
    for image in images:
        Image.new("RGBA", (9, 7)).save(image)
    front, left = everything(damaged).problems
    assert front.startswith(f"Camera front, clip walk, frame 1: {images[0]}: the image is 9 x 7 pixels; ")
    assert left.startswith(f"Camera left, clip walk, frame 1: {images[1]}: the image is 9 x 7 pixels; ")


def test_a_video_that_ends_early_is_named(damaged: Capture) -> None:
    capture = replace(damaged, images="{clip}.mp4", masks="{clip}.mp4", cameras=damaged.cameras[:1])
    for clip, frames in FRAMES.items():
        video = (np.full((SIDE, SIDE, 3), 255, np.uint8) for _ in range(frames - (clip == "walk")))
        write_video(capture.folder / f"{clip}.mp4", video, rate=30)
    short = f"clip walk needs 4 frames of {capture.folder / 'walk.mp4'}, which has 3"
    assert f"Camera front: {short}." in everything(capture).problems


def test_a_motion_that_is_too_short_is_a_problem_of_its_clip_alone(small_capture: Capture) -> None:
    walk, reach = small_capture.clips
    checked = everything(replace(small_capture, clips=(replace(walk, frames=9), reach)))
    assert [problem for problem in checked.problems if "images" not in problem] == [
        f"Clip walk: {walk.motion}: has 5 poses at 30 frames per second; clip 'walk' needs 9 from pose 1 on."
    ]
    assert {view.clip for view in checked.views} == {"reach"}


@pytest.mark.parametrize(
    ("asked", "expected"), [(None, [3, 5]), (1, [4]), (3, [2, 4, 6]), (0, list(range(9))), (99, list(range(9)))]
)
def test_frames_are_spread_over_the_clip(small_capture: Capture, asked: int | None, expected: list[int]) -> None:
    """With 40 cameras and two clips, two frames of each clip make 160 views."""
    clip = replace(small_capture.clips[0], frames=9)
    many = replace(small_capture, cameras=small_capture.cameras * 10)
    assert chosen_frames(many, clip, asked) == expected


def test_the_picture_shows_both_outlines_where_the_person_is(small_capture: Capture) -> None:
    checked = everything(small_capture)
    picture = np.asarray(check_sheet(checked))
    outline, mask = ((picture == color).all(axis=-1) for color in (OUTLINE, MASK))
    assert np.count_nonzero(outline) > 2000
    assert np.count_nonzero(mask) > 2000
    apart = distance_transform_edt(~outline)[mask]  # the masks' pixels are about 9 of the sheet's
    assert np.median(apart) < 9


def test_the_picture_begins_with_the_worst_views_and_has_two_of_each_camera(
    small_capture: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    checked = everything(small_capture)
    shown: list[Seen] = []

    def cell(_: Checked, view: Seen) -> Image.Image:
        shown.append(view)
        return Image.new("RGB", (4, 2), (20 * len(shown), 0, 0))

    monkeypatch.setattr(sheet, "_cell", cell)
    picture = np.asarray(check_sheet(checked))
    assert picture[:4:2, ::4, 0].tolist() == [[20, 40, 60, 80], [100, 120, 140, 160]]
    names = [view.camera.name for view in shown]
    assert (names[:4], len(set(names))) == (names[4:], 4)
    worst = min(checked.cameras, key=lambda camera: camera.mean or 0)
    assert shown[0] is min(worst.views, key=lambda view: view.overlap)


def test_the_command_prints_what_it_found(small_capture: Capture, command: Commands, tmp_path: Path) -> None:
    ended = command("capture", "check", small_capture.folder, "-o", tmp_path / "check.png")
    assert ended.status == 0
    for expected in ("4 cameras, 30 frames", "held out: above", "walk (4 frames", "1.71 m tall", "Nothing was found"):
        assert expected in ended.out
    with Image.open(tmp_path / "check.png") as picture:
        assert picture.width > 1000


def test_the_command_looks_at_as_many_frames_as_asked_for(
    small_capture: Capture, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked: set[tuple[str, int]] = set()

    def keep(capture: Capture, posed: Any, clip: str, frame: int, camera: CaptureCamera) -> Any:
        looked.add((clip, frame))
        return look_at(capture, posed, clip, frame, camera)

    monkeypatch.setattr("mua.capture.check.look_at", keep)
    for frames, expected in (("1", len(small_capture.clips)), ("0", sum(clip.frames for clip in small_capture.clips))):
        looked.clear()
        assert command("capture", "check", small_capture.folder, "--frames", frames).status == 0
        assert len(looked) == expected


def test_the_command_fails_where_something_cannot_be_right(command: Commands, damaged: Capture) -> None:
    write_capture(calibrated(damaged, lambda m: OPENGL @ m))
    ended = command("capture", "check", damaged.folder, "--frames", 1)
    assert ended.status == 1
    assert "problem: Outlines and masks overlap by" in ended.out


def test_the_command_refuses_a_picture_it_cannot_write(small_capture: Capture, command: Commands) -> None:
    ended = command("capture", "check", small_capture.folder, "-o", "check.bmp")
    assert ended.sentence == "error: --output check.bmp: the suffix is .bmp, expected .png or .jpg"


def test_cameras_whose_masks_are_sometimes_empty_are_named_and_these_count_nowhere(
    small_capture: Capture, damaged: Capture, command: Commands
) -> None:
    for clip, frame in (("walk", 1), ("reach", 0)):
        Image.new("RGBA", (SIDE, SIDE)).save(damaged.files(clip, frame, "right").image)
    checked = everything(damaged)
    remark = "Camera right: 2 of 6 masks that were looked at are empty and count nowhere, first clip walk, frame 1."
    assert (checked.problems, checked.remarks) == ((), (remark,))
    (right,) = (fit for fit in checked.cameras if fit.camera.name == "right")
    (sound,) = (fit for fit in everything(small_capture).cameras if fit.camera.name == "right")
    assert right.mean == pytest.approx(sound.mean, abs=0.02)
    assert right.least is not None
    assert right.least.mask.any()
    ended = command("capture", "check", damaged.folder, "--frames", 0)
    assert ended.status == 0
    assert f"remark: {remark}" in ended.out


def invert(pixels: Array) -> None:
    pixels[..., 3] = 255 - pixels[..., 3]


@pytest.mark.parametrize(("camera", "named"), [("left", "Camera left"), ("*", "All cameras")])
def test_inverted_masks_are_named(damaged: Capture, camera: str, named: str) -> None:
    repaint(damaged.folder.glob(f"images/*/{camera}/*.png"), invert)
    (problem,) = check_capture(damaged, frames=2).problems
    assert re.fullmatch(
        rf"{named}: masks are inverted, by 9\d% they fit what is black; expected white .*\.", problem
    ), problem


@pytest.mark.parametrize(
    ("camera", "turn", "remedy"),
    [
        ("left", Image.Transpose.ROTATE_90, "Camera left: .* the images were turned by 90° to the right"),
        ("*", Image.Transpose.FLIP_LEFT_RIGHT, "All cameras: .* the images were mirrored, left to right"),
    ],
)
def test_images_that_lie_otherwise_are_named(damaged: Capture, camera: str, turn: Image.Transpose, remedy: str) -> None:
    for image in damaged.folder.glob(f"images/*/{camera}/*.png"):
        Image.open(image).transpose(turn).save(image)
    (problem,) = check_capture(damaged, frames=1).problems
    assert re.search(rf"^{remedy}\.$", problem), problem
    assert "they would by 9" in problem


def test_intrinsics_of_images_of_another_size_are_named(small_capture: Capture) -> None:
    front, *others = small_capture.cameras
    larger = [replace(one.resized((2 * SIDE, 2 * SIDE)), size=one.size) for one in others]
    capture = replace(small_capture, cameras=(front, *larger))
    (problem,) = check_capture(capture, frames=1).problems
    found = r"Cameras above, left, right: .* they would by 9\d% if focal and centre were divided by 2: .*"
    assert re.fullmatch(found, problem), problem


def test_a_camera_that_is_two_centimetres_off_is_named(small_capture: Capture) -> None:
    """The sentence says by how far; the other cameras get none."""
    front, left, *others = small_capture.cameras
    matrix = left.world_to_camera.copy()
    matrix[:2, 3] += 0.014, -0.014
    capture = replace(small_capture, cameras=(front, replace(left, world_to_camera=matrix), *others))
    (problem,) = everything(capture).problems
    found = re.fullmatch(
        r"Camera left: overlaps by 8\d%, the others typically by 9\d%; it would by 9\d% if it pointed (\d\.\d) cm "
        r"beside \(at the person\): calibrate it again\.",
        problem,
    )
    assert found is not None, problem
    assert float(found[1]) == pytest.approx(2, abs=0.6)


def test_a_camera_that_fits_less_well_for_no_known_reason_is_worth_a_remark(
    small_capture: Capture, damaged: Capture
) -> None:
    def widen(pixels: Array) -> None:
        pixels[..., 3] = np.maximum(pixels[..., 3], np.roll(pixels[..., 3], (1, 1), axis=(0, 1)))
        pixels[..., 3] = np.maximum(pixels[..., 3], np.roll(pixels[..., 3], (-1, -1), axis=(0, 1)))

    repaint(damaged.folder.glob("images/*/left/*.png"), widen)
    checked = everything(damaged)
    assert checked.problems == ()
    (remark,) = checked.remarks
    assert re.fullmatch(r"Camera left: overlaps by \d\d%, the others typically by 9\d%: look at its masks, .*", remark)


@pytest.mark.parametrize(("by", "number"), [(1, "1 frame higher"), (-1, "1 frame lower")])
def test_a_camera_whose_frames_are_counted_otherwise_is_named(damaged: Capture, by: int, number: str) -> None:
    images = [damaged.files("walk", frame, "left").image for frame in range(FRAMES["walk"])]
    shown = [image.read_bytes() for image in images]
    for frame, image in enumerate(images):
        image.write_bytes(shown[min(max(frame + by, 0), len(shown) - 1)])
    checked = everything(replace(damaged, clips=damaged.clips[:1]))
    (problem,) = (one for one in checked.problems if "clip" not in one)
    assert re.search(rf"^Camera left: .* it would by 9\d% if its images were numbered {number}\.$", problem), problem


@pytest.mark.parametrize("k1", [-0.2, 0.0])
def test_a_distortion_that_was_left_out_is_named(small_capture: Capture, tmp_path: Path, k1: float) -> None:
    """With wide lenses, near enough that the person fills the image: elsewhere distortion changes little."""
    wide = tuple(
        replace(camera, focal=(50.0, 50.0), centre=(SIDE / 2, SIDE / 2), world_to_camera=nearer(camera))
        for camera in small_capture.cameras
    )
    near = replace(small_capture, cameras=wide, images=f"{tmp_path}/{{clip}}/{{camera}}/{{frame}}.png")
    posed = Posed.of(near, near.clips)
    rows, columns = np.mgrid[:SIDE, :SIDE] + 0.5
    seen = np.stack([columns, rows]) / 50 - SIDE / 100
    seen *= np.minimum(1, 0.8 / np.linalg.norm(seen, axis=0))  # farther out, where nobody is, the lens folds over
    x, y = undistorted(seen[0], seen[1], (k1, 0.0, 0.0, 0.0, 0.0))
    column, row = ((50 * at + SIDE / 2).clip(0, SIDE - 1).astype(int) for at in (x, y))
    for clip, camera in product(near.clips, wide):
        for frame in range(clip.frames):
            mask = posed.covers(clip.name, frame, camera)[row, column]
            place = near.files(clip.name, frame, camera.name).image
            place.parent.mkdir(parents=True, exist_ok=True)
            Image.fromarray(np.dstack([np.zeros((SIDE, SIDE, 3), np.uint8), 255 * mask.astype(np.uint8)])).save(place)
    problems = check_capture(near).problems
    if k1 == 0:
        assert problems == ()
    else:
        assert re.search(r"would by 9\d\.\d% if k1 of each camera's distortion were 0\.[23] smaller", problems[0])


def nearer(camera: CaptureCamera) -> Array:
    matrix = camera.world_to_camera.copy()
    matrix[2, 3] -= 1.7  # of the 3.2 metres to the figure
    return matrix
