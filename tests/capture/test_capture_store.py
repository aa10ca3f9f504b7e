"""Stored views are those of the capture, made once; masks that do not fit count less."""

import os
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from captures import FRAMES, SIDE, make_capture
from PIL import Image

from mua.capture import Capture, View
from mua.capture import store as stores
from mua.capture.pictures import read_picture
from mua.capture.store import ViewStore
from mua.capture.trust import MaskTrust
from mua.errors import InputError
from mua.player.video import write_video


def same(a: View, b: View) -> None:
    np.testing.assert_array_equal(a.image, b.image)
    np.testing.assert_array_equal(a.mask, b.mask)
    np.testing.assert_array_equal(a.camera.view, b.camera.view)
    np.testing.assert_allclose(a.camera.projection, b.camera.projection, rtol=1e-15)
    assert (a.background is None) == (b.background is None)
    if a.background is not None:
        np.testing.assert_array_equal(a.background, b.background)


def filmed(folder: Path, *, ending: str = "mp4") -> Capture:
    """The capture with distorted videos for images, and with backgrounds."""
    capture = make_capture(folder, distortion=(-0.1, 0.05, 1e-3, 0.0, 0.0))
    rng = np.random.default_rng(2)
    for camera in capture.cameras:
        for clip, frames in FRAMES.items():
            taken = [capture.view(clip, frame, camera.name) for frame in range(frames)]
            for name, pictures in (("video", [v.image for v in taken]), ("mask", [v.mask for v in taken])):
                bytes_of = (np.rint(255 * p if p.ndim == 3 else 255 * np.dstack([p] * 3)) for p in pictures)
                place = folder / name / clip / f"{camera.name}.mp4"
                place.parent.mkdir(parents=True, exist_ok=True)
                write_video(place, (b.astype(np.uint8) for b in bytes_of), rate=30)
                place.rename(place.with_suffix(f".{ending}"))
        empty = rng.integers(0, 256, (SIDE, SIDE, 3), dtype=np.uint8)
        (folder / "empty").mkdir(exist_ok=True)
        Image.fromarray(empty).save(folder / "empty" / f"{camera.name}.png")
    return replace(
        capture,
        images=f"video/{{clip}}/{{camera}}.{ending}",
        masks=f"mask/{{clip}}/{{camera}}.{ending}",
        backgrounds="empty/{camera}.png",
    )


@pytest.mark.parametrize("rows", [None, 24])
def test_a_stored_view_is_the_view(tmp_path: Path, rows: int | None) -> None:
    capture = filmed(tmp_path / "filmed")
    store = ViewStore(capture, tmp_path / "store", rows=rows)
    for clip, frame in (("walk", 2), ("reach", 1), ("walk", 0), ("walk", 2)):
        same(store.view(clip, frame, "left"), capture.view(clip, frame, "left", crop=True, rows=rows))


def test_a_video_is_decoded_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    capture, decoded = filmed(tmp_path / "filmed", ending="MP4"), []  # as some cameras call them
    of_video = stores.video_frames

    def counted(path: Path, first: int = 0) -> object:
        decoded.append(path.parent.parent.name)
        return of_video(path, first)

    monkeypatch.setattr(stores, "video_frames", counted)
    for _ in range(2):
        store = ViewStore(capture, tmp_path / "store")
        for frame in range(FRAMES["walk"]):
            store.view("walk", frame, "front")
    assert sorted(decoded) == ["mask", "video"]


def of_cameras(**changes: Any) -> Callable[[Capture], Capture]:
    return lambda c: replace(c, cameras=tuple(replace(one, **changes) for one in c.cameras))


CHANGES: dict[str, tuple[Callable[[Capture], Capture], dict[str, Any]]] = {  # of the capture, and of the store
    "focal length": (of_cameras(focal=(80.0, 80.0)), {}),
    "middle of the image": (of_cameras(centre=(30.0, 32.0)), {}),
    "lens": (of_cameras(distortion=(-0.1, 0.05, 0.0, 0.0, 0.0)), {}),
    "numbers of images": (lambda c: replace(c, clips=(replace(c.clips[0], first_image=1), c.clips[1])), {}),
    "trimmed masks": (lambda c: replace(c, trim_masks=2), {}),
    "height": (lambda c: c, {"rows": 24}),
    "cut": (lambda c: c, {"crop": False}),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_was_stored_for_something_else_is_not_used(small_capture: Capture, tmp_path: Path, change: str) -> None:
    asked: dict[str, Any] = {"crop": True, "rows": 32}
    ViewStore(small_capture, tmp_path, crop=True, rows=32).view("walk", 1, "front")
    of_capture, of_store = CHANGES[change]
    changed, asked = of_capture(small_capture), asked | of_store
    found = ViewStore(changed, tmp_path, crop=asked["crop"], rows=asked["rows"]).view("walk", 1, "front")
    same(found, changed.view("walk", 1, "front", **asked))
    assert len(list(tmp_path.rglob("*.png"))) == 2


def test_a_video_that_begins_elsewhere_is_read_again(tmp_path: Path) -> None:
    capture = filmed(tmp_path / "filmed")
    ViewStore(capture, tmp_path / "store").view("walk", 0, "left")
    later = replace(capture, clips=(replace(capture.clips[0], first_image=2, frames=2), capture.clips[1]))
    same(ViewStore(later, tmp_path / "store").view("walk", 0, "left"), later.view("walk", 0, "left", crop=True))


def test_a_store_asks_no_camera_for_more_rows_than_it_has(small_capture: Capture, tmp_path: Path) -> None:
    store = ViewStore(small_capture, tmp_path, rows=999)
    same(store.view("walk", 1, "front"), small_capture.view("walk", 1, "front", crop=True))


@pytest.mark.parametrize("kept", ["size", "time"])
@pytest.mark.parametrize("what", ["image", "mask"])
def test_a_picture_that_changed_is_read_again(tmp_path: Path, what: str, kept: str) -> None:
    capture = replace(make_capture(tmp_path / "capture"), masks="masks/{clip}/{camera}/{frame}.png")
    files = capture.files("walk", 0, "front")
    assert files.mask is not None
    files.mask.parent.mkdir(parents=True)
    Image.fromarray(np.random.default_rng(1).integers(0, 256, (SIDE, SIDE), dtype=np.uint8)).save(files.mask)
    store = ViewStore(capture, tmp_path / "store")
    store.view("walk", 0, "front")
    changed = files.image if what == "image" else files.mask
    before = changed.stat()
    Image.new("RGBA", (SIDE, SIDE), (9, 9, 9, 255)).save(changed)
    if kept == "size":
        content = changed.read_bytes()
        changed.write_bytes(content[: before.st_size] + bytes(before.st_size - len(content)))  # PNG ends before
        os.utime(changed, ns=(0, before.st_mtime_ns + 10**9))
    else:
        os.utime(changed, ns=(0, before.st_mtime_ns))
    same(store.view("walk", 0, "front"), capture.view("walk", 0, "front", crop=True))


def test_beyond_the_limit_views_are_read_but_not_stored(small_capture: Capture, tmp_path: Path) -> None:
    """What an earlier store left counts too."""
    for limit in (1, 2):
        store = ViewStore(small_capture, tmp_path, limit=limit)
        for frame in range(3):
            same(store.view("walk", frame, "front"), small_capture.view("walk", frame, "front", crop=True))
    assert len(list(tmp_path.rglob("*.png"))) == 1


def test_frames_that_are_stored_are_left_alone(tmp_path: Path) -> None:
    capture = filmed(tmp_path / "filmed")
    store = ViewStore(capture, tmp_path / "store")
    store.view("walk", 2, "left")
    before = {file: file.stat().st_ino for file in (tmp_path / "store").rglob("*.png")}
    store.view("walk", 0, "left")
    after = {file: file.stat().st_ino for file in (tmp_path / "store").rglob("*.png")}
    assert (len(before), len(after)) == (2, 4)
    assert after.items() >= before.items()


def test_a_view_that_was_half_written_is_none(
    small_capture: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(picture: Image.Image, place: Path, **options: object) -> None:
        place.write_bytes(b"\x89PNG")
        raise KeyboardInterrupt

    store = ViewStore(small_capture, tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(Image.Image, "save", killed)
        with pytest.raises(KeyboardInterrupt):
            store.view("walk", 1, "front")
    found = store.view("walk", 1, "front")
    same(found, small_capture.view("walk", 1, "front", crop=True))


def test_the_empty_set_is_read_once(small_capture: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    capture = replace(small_capture, backgrounds=str(tmp_path / "{camera}.png"))
    Image.new("RGB", (SIDE, SIDE), (1, 2, 3)).save(tmp_path / "front.png")
    store = ViewStore(capture, tmp_path / "store")
    read: list[Path] = []

    def reading(path: Path, **asked: Any) -> Any:
        read.append(path)
        return read_picture(path, **asked)

    monkeypatch.setattr(stores, "read_picture", reading)
    for frame in (0, 1, 0, 1):
        store.view("walk", frame, "front")
    assert read == [tmp_path / "front.png"]


def assert_nobody(view: View) -> None:
    """A whole image without the person."""
    assert view.empty
    assert view.image.shape == (SIDE, SIDE, 3)
    assert view.pinhole.size == (SIDE, SIDE)


def test_after_a_video_ends_nobody_is_seen(tmp_path: Path) -> None:
    capture = filmed(tmp_path / "filmed")
    longer = replace(capture, clips=(replace(capture.clips[0], first_image=2), capture.clips[1]))
    store = ViewStore(longer, tmp_path / "store")
    store.view("walk", 1, "left")
    assert_nobody(store.view("walk", 2, "left"))


def test_after_a_video_of_masks_ends_nobody_is_seen(tmp_path: Path) -> None:
    capture = filmed(tmp_path / "filmed")
    masks = (np.full((SIDE, SIDE, 3), 255, np.uint8) for _ in range(2))
    write_video(tmp_path / "filmed" / "mask" / "walk" / "left.mp4", masks, rate=30)
    store = ViewStore(capture, tmp_path / "store")
    same(store.view("walk", 1, "left"), capture.view("walk", 1, "left", crop=True))
    assert_nobody(store.view("walk", 2, "left"))


def test_where_an_image_is_missing_nobody_is_seen_until_it_is_there(tmp_path: Path) -> None:
    capture = make_capture(tmp_path / "filmed")
    image = capture.files("walk", 2, "left").image
    content = image.read_bytes()
    image.unlink()
    assert_nobody(ViewStore(capture, tmp_path / "store").view("walk", 2, "left"))
    image.write_bytes(content)
    assert not ViewStore(capture, tmp_path / "store").view("walk", 2, "left").empty


def test_a_missing_background_is_an_error(tmp_path: Path) -> None:
    capture = replace(make_capture(tmp_path / "filmed"), backgrounds="{camera}.png")
    with pytest.raises(InputError, match=r"left\.png: there is no such file"):
        ViewStore(capture, tmp_path / "store").view("walk", 2, "left")


def test_a_video_of_another_size_is_refused(tmp_path: Path) -> None:
    capture = filmed(tmp_path / "filmed")
    wider = replace(capture, cameras=tuple(replace(one, size=(SIDE + 2, SIDE)) for one in capture.cameras))
    with pytest.raises(InputError, match=r"left\.mp4: the image is 64 x 64 pixels; .* 66 x 64"):
        ViewStore(wider, tmp_path / "store").view("walk", 0, "left")


def test_masks_that_fit_count_in_full_and_those_of_other_things_not(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    images = [capture.files("walk", frame, "left").image for frame in (0, 3)]
    images[0].write_bytes(images[1].read_bytes())
    Image.new("RGBA", (SIDE, SIDE)).save(capture.files("walk", 1, "left").image)
    trust = MaskTrust(capture)

    def weight(frame: int, camera: str, *, crop: bool = True) -> float:
        return trust.weight("walk", frame, capture.view("walk", frame, camera, crop=crop, rows=48))

    assert (weight(0, "left"), weight(1, "left")) == (0, 0)
    assert min(weight(frame, camera) for frame in range(4) for camera in ("front", "right", "above")) > 0.9


def behead(image: Path) -> None:
    """Take the upper third of a mask away."""
    with Image.open(image) as opened:
        picture = np.array(opened)
    rows = np.flatnonzero(picture[..., 3].any(axis=1))
    picture[: rows[len(rows) * 35 // 100], :, 3] = 0
    Image.fromarray(picture).save(image)


def test_half_a_mask_counts_less(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    behead(capture.files("walk", 0, "front").image)
    trust = MaskTrust(capture)
    assert 0 < trust.weight("walk", 0, capture.view("walk", 0, "front")) < 0.95


@pytest.mark.parametrize(("cut", "full"), [(5, False), (7, True)])
def test_how_masks_usually_fit_is_what_most_of_the_training_views_do(tmp_path: Path, cut: int, full: bool) -> None:
    """A mask without its upper third counts in full where more than half of the 12 are no better.

    What is held out is spoilt where that would change the result: it does not count.
    """
    capture = make_capture(tmp_path)
    trained_on = [camera for camera in capture.cameras if not camera.held_out]
    views = [("walk", *one) for one in product(range(FRAMES["walk"]), trained_on)][:cut]
    if not full:
        views += [("reach", *one) for one in product(range(FRAMES["reach"]), capture.cameras)]
        views += [("walk", frame, capture.camera("above")) for frame in range(FRAMES["walk"])]
    for clip, frame, camera in views:
        behead(capture.files(clip, frame, camera.name).image)
    trust = MaskTrust(capture)
    weights = [trust.weight("walk", 0, capture.view("walk", 0, camera.name)) for camera in trained_on]
    assert (min(weights) > 0.99) == full
