"""Views of a capture: distortion undone, cut to the person, made smaller; and each file that cannot be a view's."""

from dataclasses import replace
from pathlib import Path
from subprocess import run
from types import SimpleNamespace

import numpy as np
import pytest
from captures import FRAMES, SIDE, make_capture
from imageio_ffmpeg import get_ffmpeg_exe
from PIL import Image

from mua.arrays import Array
from mua.capture import Capture, CaptureCamera, video
from mua.capture.lens import distorted, undistort
from mua.capture.pictures import as_mask
from mua.capture.silhouette import pixels
from mua.capture.smaller import area_average
from mua.capture.video import video_frames
from mua.capture.view import RawFrame, person, view_of
from mua.errors import InputError
from mua.kernels.splat_project import eye_ellipses
from mua.player.video import write_video

LENS = (-0.28, 0.09, 1.2e-3, -8e-4, -0.01)
STEP = 1 / 255  # of a view
CAMERA = CaptureCamera("cam", (160, 120), (150.0, 140.0), (83.0, 57.0), np.eye(4), LENS)


def opencv(camera: CaptureCamera, points: Array) -> Array:
    """Columns and rows [N, 2] of points [N, 3] before a camera, by the formula of OpenCV's projectPoints."""
    k1, k2, p1, p2, k3 = camera.distortion
    found = []
    for x, y, z in points:
        a, b = x / z, y / z
        r = (a**2 + b**2) ** 0.5
        radial = 1 + k1 * r**2 + k2 * r**4 + k3 * r**6
        u = a * radial + 2 * p1 * a * b + p2 * (r**2 + 2 * a**2)
        v = b * radial + p1 * (r**2 + 2 * b**2) + 2 * p2 * a * b
        found.append((camera.focal[0] * u + camera.centre[0], camera.focal[1] * v + camera.centre[1]))
    return np.array(found)


def test_the_lens_bends_as_opencv_says() -> None:
    points = np.random.default_rng(3).uniform([-0.5, -0.4, 1], [0.5, 0.4, 2], (50, 3))
    x, y = distorted(points[:, 0] / points[:, 2], points[:, 1] / points[:, 2], LENS)
    found = np.stack([x, y], axis=1) * CAMERA.focal + CAMERA.centre
    np.testing.assert_allclose(found, opencv(CAMERA, points), rtol=0, atol=1e-11)


def test_straight_lines_and_places_are_back_where_a_pinhole_has_them() -> None:
    """Each pixel of the lens' image holds the direction it looks in, so the undone image is linear."""
    rows, columns = np.mgrid[:120, :160] + 0.5
    # Where a lens pixel looks, by fixed-point iteration of the forward formula, which the code never inverts.
    x = seen_x = (columns - CAMERA.centre[0]) / CAMERA.focal[0]
    y = seen_y = (rows - CAMERA.centre[1]) / CAMERA.focal[1]
    for _ in range(60):
        off_x, off_y = (np.asarray(a) for a in distorted(x, y, LENS))
        x, y = x + seen_x - off_x, y + seen_y - off_y
    found = undistort(np.stack([x, y], axis=-1), CAMERA, (10, 10, 150, 110))
    wanted = np.stack([seen_x, seen_y], axis=-1)[10:110, 10:150]
    inside = (np.abs(found).sum(axis=-1) > 0) & (np.abs(wanted).sum(axis=-1) > 0)
    assert inside.mean() > 0.9
    curvature = 2e-4  # of directions between neighbouring pixels, which bilinear interpolation leaves
    np.testing.assert_allclose(found[inside], wanted[inside], atol=curvature)


def test_a_picture_without_distortion_is_left_as_it_is() -> None:
    picture = np.random.default_rng(0).integers(0, 255, (120, 160, 3), dtype=np.uint8)
    plain = replace(CAMERA, distortion=(0.0,) * 5)
    np.testing.assert_array_equal(undistort(picture, plain, (5, 6, 50, 40)), picture[6:40, 5:50])


@pytest.mark.parametrize(("old", "new"), [(12, 12), (12, 4), (13, 5), (7, 1), (1, 1)])
def test_a_smaller_picture_holds_means_of_areas(old: int, new: int) -> None:
    picture = np.random.default_rng(old).uniform(0, 255, (old, old + 3, 2))
    found = area_average(picture, np.linspace(0, old, new + 1), np.linspace(0, old + 3, new + 1))
    fine = picture.repeat(new, axis=0).repeat(new, axis=1)  # whose pixels are whole parts of both
    expected = fine.reshape(new, old, new, old + 3, 2).mean(axis=(1, 3))
    np.testing.assert_allclose(found, expected, rtol=old * 2**-22)


def test_an_edge_that_is_rounded_beyond_the_picture_is_its_end() -> None:
    picture = np.arange(12.0).reshape(3, 4, 1)
    beyond = np.nextafter(np.array([[0, 1.5, 3], [0, 2, 4]]), np.inf)
    found = area_average(picture, beyond[0], beyond[1])
    np.testing.assert_allclose(found, area_average(picture, np.array([0, 1.5, 3]), np.array([0, 2.0, 4])), atol=1e-6)


@pytest.mark.parametrize("rows", [None, 48, 17])
def test_cutting_and_shrinking_move_the_camera_with_the_picture(small_capture: Capture, rows: int | None) -> None:
    """A patch of the whole image lies where both cameras project the same points of the world."""
    whole, part = (small_capture.view("walk", 1, "left", rows=rows, crop=crop) for crop in (False, True))
    points = np.random.default_rng(1).normal([0, 0.85, 0], 0.2, (30, 3))
    tiny = np.tile([1e-8, 0, 0, 1e-8, 0, 1e-8], (30, 1))
    at, cut_at = (
        eye_ellipses(points, tiny, v.camera.view, v.camera.projection, v.camera.screen, v.camera.near)[:, :2]
        for v in (whole, part)
    )
    corner = np.rint((at - cut_at)[0]).astype(int)
    np.testing.assert_allclose(at - cut_at, np.tile(corner, (30, 1)), atol=1e-9)
    width, height = part.camera.screen
    assert whole.camera.screen[1] == (rows or SIDE)
    assert part.image.shape == (height, width, 3)
    window = np.s_[corner[1] : corner[1] + height, corner[0] : corner[0] + width]
    np.testing.assert_array_equal(part.image, whole.image[window])
    np.testing.assert_array_equal(part.mask, whole.mask[window])


def test_a_wide_picture_stays_as_wide_where_it_is_made_smaller() -> None:
    """A square of the world is one in the smaller image, and lies where the smaller camera says."""
    wide = replace(CAMERA, distortion=(0.0,) * 5)
    picture = np.zeros((120, 160, 4), np.uint8)
    picture[40:80, 100:140] = 255
    view = view_of(RawFrame(picture[..., :3], picture[..., 3:], clear=False), wide, crop=False, rows=30)
    bent = view_of(
        RawFrame(picture[..., :3], picture[..., 3:], clear=False), replace(wide, distortion=LENS), crop=False, rows=30
    )
    assert bent.pinhole.distortion == view.pinhole.distortion
    assert (view.pinhole.size, view.image.shape, view.mask.shape) == ((40, 30), (30, 40, 3), (30, 40))
    np.testing.assert_array_equal(np.argwhere(view.mask), np.argwhere(picture[::4, ::4, 3]))
    corner = np.array([[(100 - wide.centre[0]) / wide.focal[0], (40 - wide.centre[1]) / wide.focal[1], 1.0]])
    seen = view.pinhole.world_to_camera[:3, :3].T @ (corner[0] - view.pinhole.world_to_camera[:3, 3])
    np.testing.assert_allclose(pixels(view.pinhole, seen[None])[0], [[25, 10]])


def test_the_box_holds_the_whole_person_with_a_margin(small_capture: Capture) -> None:
    whole, part = (small_capture.view("walk", 1, "left", crop=crop) for crop in (False, True))
    assert part.mask.sum() == pytest.approx(whole.mask.sum())
    border = np.concatenate([part.mask[0], part.mask[-1], part.mask[:, 0], part.mask[:, -1]])
    assert border.max() == 0
    assert part.mask.size < whole.mask.size / 2


def test_the_margin_is_a_twentieth_of_the_longer_side_and_a_pixel() -> None:
    mask = np.zeros((140, 100))
    mask[20:120, 50:70] = 1
    assert person(mask) == (44, 14, 76, 126)
    assert person(mask[:, 50:]) == (0, 14, 26, 126)


def test_an_empty_mask_keeps_the_whole_picture(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    Image.new("RGBA", (SIDE, SIDE)).save(capture.files("walk", 0, "front").image)
    assert capture.view("walk", 0, "front", crop=True).camera.screen == (SIDE, SIDE)


def test_colours_at_the_rim_are_not_darkened_by_what_has_no_colour(tmp_path: Path) -> None:
    """A red square whose surroundings are clear white stays red where new pixels lie over its edge."""
    capture = make_capture(tmp_path)
    picture = np.tile(np.array([255, 255, 255, 0], np.uint8), (SIDE, SIDE, 1))
    picture[10:31, 10:31] = [200, 0, 0, 255]
    Image.fromarray(picture).save(capture.files("walk", 0, "front").image)
    view = capture.view("walk", 0, "front", rows=SIDE // 4)
    covered = view.mask > STEP
    np.testing.assert_allclose(view.image[covered], [[200 / 255, 0, 0]] * covered.sum(), atol=STEP)
    assert view.mask.sum() * 16 == pytest.approx(21 * 21, rel=0.01)


def test_what_is_nearly_clear_has_its_colour(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    faint = np.tile(np.array([200, 90, 10, 2], np.uint8), (SIDE, SIDE, 1))
    Image.fromarray(faint).save(capture.files("walk", 0, "front").image)
    view = capture.view("walk", 0, "front", rows=SIDE // 2)
    np.testing.assert_allclose(255 * view.image[5, 5], [200, 90, 10], atol=0.5)
    np.testing.assert_allclose(255 * view.mask, 2, atol=1e-4)


def test_a_clear_colour_of_a_palette_is_a_mask_too(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    picture = Image.new("P", (SIDE, SIDE))
    picture.putpalette([0, 0, 0, 200, 90, 10])
    picture.paste(1, (10, 20, 30, 50))
    picture.save(capture.files("walk", 0, "front").image, transparency=0)
    view = capture.view("walk", 0, "front")
    assert (view.mask.sum(), view.mask[20:50, 10:30].min()) == (20 * 30, 1)


def test_masks_of_their_own_are_read_in_place_of_alpha(tmp_path: Path) -> None:
    capture = replace(make_capture(tmp_path), masks="masks/{clip}/{camera}/{frame}.png")
    place = capture.files("walk", 2, "right").mask
    assert place is not None
    place.parent.mkdir(parents=True)
    mask = np.zeros((SIDE, SIDE), np.uint8)
    mask[5:30, 20:40] = 1  # some tools write 0 and 1
    Image.fromarray(mask).save(place)
    view = capture.view("walk", 2, "right")
    np.testing.assert_array_equal(view.mask, mask)
    with Image.open(capture.files("walk", 2, "right").image) as image:
        np.testing.assert_allclose(255 * view.image, np.asarray(image)[..., :3], atol=1e-4)
    narrower = replace(capture, trim_masks=3).view("walk", 2, "right")
    np.testing.assert_array_equal(narrower.mask, np.pad(mask[8:27, 23:37], ((8, 37), (23, 27))))
    np.testing.assert_array_equal(narrower.image, view.image)


@pytest.mark.parametrize(("light", "cover"), [([0, 0, 1], 255), ([255, 0, 0], 255), ([2, 2, 0], 2), ([0, 0, 0], 0)])
def test_a_mask_covers_by_its_lightest_channel(light: list[int], cover: int) -> None:
    """Some tools write 0 and 1; what is nearly black beside is nearly nothing."""
    found = as_mask(np.array([[light, [0, 0, 0]]], np.uint8))
    np.testing.assert_array_equal(found, [[[cover], [0]]])


def test_a_background_is_seen_as_the_picture_is(tmp_path: Path) -> None:
    capture = replace(make_capture(tmp_path), backgrounds="empty/{camera}.png")
    empty = np.random.default_rng(8).integers(0, 256, (SIDE, SIDE, 3), dtype=np.uint8)
    (tmp_path / "empty").mkdir()
    Image.fromarray(empty).save(tmp_path / "empty" / "left.png")
    Image.fromarray(np.dstack([empty, np.full((SIDE, SIDE), 255, np.uint8)])).save(
        capture.files("walk", 0, "left").image
    )
    view = capture.view("walk", 0, "left", rows=20)
    assert view.background is not None
    np.testing.assert_array_equal(view.background, view.image)


@pytest.fixture(scope="module")
def filmed(tmp_path_factory: pytest.TempPathFactory) -> Capture:
    """A capture whose images are videos: each frame as bright as its number says."""
    capture = make_capture(tmp_path_factory.mktemp("filmed"))
    capture = replace(capture, images="video/{camera}.mp4", masks="video/mask.mp4")
    clips = (replace(capture.clips[0], first_image=37), capture.clips[1])
    (capture.folder / "video").mkdir()
    numbered = [np.full((SIDE, SIDE, 3), 40 + 4 * number, np.uint8) for number in range(45)]
    for name in ("front", "mask"):
        write_video(capture.folder / "video" / f"{name}.mp4", iter(numbered), rate=30000 / 1001)
    return replace(capture, clips=clips)


@pytest.mark.parametrize(("clip", "frame"), [("walk", 0), ("walk", 3), ("reach", 0), ("reach", 1)])
def test_a_video_gives_the_frame_of_its_number(filmed: Capture, clip: str, frame: int) -> None:
    view = filmed.view(clip, frame, "front")
    number = frame + filmed.clip(clip).first_image
    coded = 2.5 / 255  # that an encoder changes of an even image
    assert view.image.mean() == pytest.approx((40 + 4 * number) / 255, abs=coded / 2)
    assert view.mask.mean() == pytest.approx((40 + 4 * number) / 255, abs=coded / 2)


def test_a_video_of_another_size_is_refused(filmed: Capture) -> None:
    wider = replace(filmed, cameras=tuple(replace(one, size=(SIDE, SIDE + 2)) for one in filmed.cameras))
    with pytest.raises(InputError, match=r"front\.mp4: the image is 64 x 64 pixels; .* 64 x 66"):
        wider.view("walk", 0, "front")


def test_a_pause_between_frames_is_not_filled(filmed: Capture) -> None:
    """Each frame is there once, whatever the time between them."""
    paused = filmed.folder / "video" / "paused.mkv"
    command = [get_ffmpeg_exe(), "-v", "error", "-i", filmed.folder / "video" / "front.mp4"]
    run([*command, "-vf", "setpts=PTS+gte(N\\,20)/TB", "-fps_mode", "vfr", paused], check=True)
    assert len(list(video_frames(paused))) == 45


def test_a_video_without_a_rate_says_so(filmed: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        video, "run", lambda *_, **__: SimpleNamespace(stderr=b"Stream #0:0: Video: h264, 0 fps, 25 tbr")
    )
    with pytest.raises(InputError, match=r"front\.mp4: ffmpeg cannot read it as a video of a steady rate"):
        filmed.view("walk", 0, "front")


def test_a_video_that_is_too_short_says_how_long_it_is(filmed: Capture) -> None:
    longer = replace(filmed, clips=(replace(filmed.clips[0], first_image=43), *filmed.clips[1:]))
    with pytest.raises(InputError, match=r"front\.mp4: has 45 frames; frame 46, counted from 0, is wanted"):
        longer.view("walk", 3, "front")


def test_a_file_that_is_no_video_says_so(filmed: Capture) -> None:
    (filmed.folder / "video" / "left.mp4").write_bytes(b"nothing")
    with pytest.raises(InputError, match=r"left\.mp4: ffmpeg cannot read it as a video"):
        filmed.view("reach", 0, "left")


def test_names_a_picture_that_cannot_be_a_view(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    for name, picture in (("small", Image.new("RGBA", (SIDE, 9))), ("solid", Image.new("RGB", (SIDE, SIDE)))):
        picture.save(tmp_path / f"{name}.png")
    (tmp_path / "text.png").write_text("no image")
    files = {"small": r"is 64 x 9 pixels; capture\.json gives its camera 64 x 64", "solid": "has no alpha"}
    for name, sentence in (files | {"text": "cannot be read as an image", "none": "there is no such file"}).items():
        with pytest.raises(InputError, match=rf"{name}\.png: .*{sentence}"):
            replace(capture, images=f"{name}.png").view("walk", 0, "front")


def test_names_a_frame_a_clip_and_a_number_of_rows_that_are_none(small_capture: Capture) -> None:
    with pytest.raises(InputError, match="frame is 4; clip 'walk' has frames 0 to 3"):
        small_capture.view("walk", FRAMES["walk"], "front")
    with pytest.raises(InputError, match="frame is -1; clip 'walk' has frames 0 to 3"):
        small_capture.view("walk", -1, "front")
    with pytest.raises(InputError, match="none is called 'jump'"):
        small_capture.view("jump", 0, "front")
    for rows in (0, 65):
        with pytest.raises(InputError, match=f"rows is {rows}; camera front has 64"):
            small_capture.view("walk", 0, "front", rows=rows)
