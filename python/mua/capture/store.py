"""Views kept on disk as training reads them: a video is decoded once, a large image undistorted and shrunk once."""

import hashlib
from collections.abc import Iterator
from contextlib import ExitStack, closing, suppress
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from mua.arrays import Array
from mua.avatar.rendering import to_bytes
from mua.capture.camera import UNDISTORTED, CaptureCamera
from mua.capture.capture import Capture
from mua.capture.pictures import as_mask, read_mask, read_picture, require_size
from mua.capture.video import VIDEOS, MissingImage, video_frames
from mua.capture.view import MARGIN, Box, RawFrame, View, in_steps, look, nobody, smaller, trimmed, view_of
from mua.files.write import replacing

LIMIT = 50_000_000_000  # bytes that a store may hold; beyond it, views are read anew each time
QUICK = 1  # of PNG's levels of compression


class ViewStore:
    """`view` gives what `Capture.view` does with the same crop and rows, from a folder where it is there already.

    Where image or mask is missing, it gives a view without the person; where the folder of images that it has read is
    gone, it raises InputError.
    """

    def __init__(
        self, capture: Capture, folder: Path, *, crop: bool = True, rows: int | None = None, limit: int = LIMIT
    ) -> None:
        """`rows` is held at what a camera has. Views of other calibrations, files or sizes are not used."""
        self._capture, self._folder, self._crop, self._rows = capture, folder, crop, rows
        self._room = limit - sum(file.stat().st_size for file in folder.rglob("*.png"))
        self._background = cache(self._read_background)
        self._missing: set[tuple[str, int, str]] = set()  # clip, frame and camera that were looked for once
        self._read_from: set[Path] = set()  # folders of images

    def view(self, clip: str, frame: int, camera: str) -> View:
        """A view; where one frame of a video is missing, the clip's frames are decoded and stored from there on."""
        calibrated = self._capture.camera(camera)
        place, rows = self._place(clip, frame, calibrated), self._height(calibrated)
        if (clip, frame, camera) in self._missing:
            return nobody(calibrated, rows=rows)
        if not place.is_file() and self._room > 0 and self._is_video(clip, calibrated):
            with suppress(MissingImage):  # of this frame or of a later one
                self._store_rest(clip, frame, calibrated)
        images = self._capture.files(clip, frame, camera).image.parent
        if place.is_file():
            self._read_from.add(images)
            return self._read(place, calibrated)
        try:
            view = self._capture.view(clip, frame, camera, crop=self._crop, rows=rows)
        except MissingImage:
            if images in self._read_from and not images.is_dir():
                raise
            self._missing.add((clip, frame, camera))
            return nobody(calibrated, rows=rows)
        self._read_from.add(images)
        self._write(place, view)
        return view

    def _store_rest(self, clip: str, first: int, camera: CaptureCamera) -> None:
        """Decode a video from a frame on, as far as it goes, until a frame that is there already or the limit."""
        for frame, taken in enumerate(self._taken(clip, first, camera), start=first):
            place = self._place(clip, frame, camera)
            if place.is_file() or self._room <= 0:
                return
            self._write(place, view_of(taken, camera, crop=self._crop, rows=self._height(camera)))

    def _taken(self, clip: str, first: int, camera: CaptureCamera) -> Iterator[RawFrame]:
        """Frames of a video with their masks, from one on."""
        files = self._capture.files(clip, first, camera.name)
        with ExitStack() as stack:
            images = stack.enter_context(closing(video_frames(files.image, files.number)))
            masks = None
            if files.mask is not None and files.mask.suffix.lower() in VIDEOS:
                masks = stack.enter_context(closing(video_frames(files.mask, files.number)))
            for frame, image in zip(range(first, self._capture.clip(clip).frames), images, strict=False):
                require_size(files.image, (image.shape[1], image.shape[0]), camera.size)
                mask = next(masks, None) if masks is not None else None
                place = self._capture.files(clip, frame, camera.name).mask
                if place is None or (masks is not None and mask is None):
                    return
                cover = read_mask(place, number=0, size=camera.size) if mask is None else as_mask(mask)
                yield trimmed(RawFrame(image, cover, clear=False), files.trim)

    def _height(self, camera: CaptureCamera) -> int | None:
        """Rows of a camera's whole image."""
        return None if self._rows is None else min(self._rows, camera.size[1])

    def _is_video(self, clip: str, camera: CaptureCamera) -> bool:
        image = self._capture.files(clip, 0, camera.name).image
        return image.suffix.lower() in VIDEOS and image.is_file()

    def _place(self, clip: str, frame: int, camera: CaptureCamera) -> Path:
        """Where a view is stored; its name changes with everything that the view is made from."""
        files = self._capture.files(clip, frame, camera.name)
        states = [path.stat() for path in (files.image, files.mask) if path is not None and path.is_file()]
        made_from = (
            *(self._crop, self._height(camera), MARGIN, files.number, files.trim),
            *(
                camera.size,
                camera.focal,
                camera.centre,
                camera.distortion,
                [(state.st_size, state.st_mtime_ns) for state in states],
            ),
        )
        digest = hashlib.sha256(repr(made_from).encode()).hexdigest()[:16]
        return self._folder / clip / camera.name / f"{frame:06d}-{digest}.png"

    def _write(self, place: Path, view: View) -> None:
        if self._room <= 0:
            return
        metadata = PngInfo()
        metadata.add_text("box", " ".join(map(str, self._box(view))))
        picture = Image.fromarray(to_bytes(np.dstack([view.image, view.mask])))
        with replacing(place) as temporary:
            picture.save(temporary, pnginfo=metadata, compress_level=QUICK)
        self._room -= place.stat().st_size

    def _box(self, view: View) -> Box:
        """The part of the whole image that a view is."""
        pinhole = view.pinhole
        camera = self._capture.camera(pinhole.name)
        whole = smaller(camera, self._height(camera))
        left, upper = (round(a - b) for a, b in zip(whole.centre, pinhole.centre, strict=True))
        return left, upper, left + pinhole.size[0], upper + pinhole.size[1]

    def _read(self, place: Path, camera: CaptureCamera) -> View:
        with Image.open(place) as stored:
            left, upper, right, lower = (int(edge) for edge in stored.info["box"].split())
            values = (np.asarray(stored) / 255).astype(np.float32)
        whole = self._background(camera.name)
        background = None if whole is None else whole[upper:lower, left:right]
        pinhole = replace(
            smaller(camera, self._height(camera)).cropped((left, upper, right, lower)), distortion=UNDISTORTED
        )
        return View(values[..., :3], values[..., 3], pinhole, background)

    def _read_background(self, name: str) -> Array | None:
        """The empty set [H, W, 3] as a whole image."""
        camera, pattern = self._capture.camera(name), self._capture.backgrounds
        if pattern is None:
            return None
        picture = read_picture(self._capture.place(pattern, camera=name), number=0, size=camera.size)
        small = smaller(camera, self._height(camera))
        return in_steps(look(picture[..., :3], camera, small, (0, 0, *small.size)))
