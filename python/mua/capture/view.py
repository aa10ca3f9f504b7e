"""The view of one frame by one camera: read, undistorted, cut to the person, made smaller."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.capture.camera import UNDISTORTED, CaptureCamera
from mua.capture.lens import undistort
from mua.capture.pictures import read_mask, read_picture
from mua.capture.smaller import area_average
from mua.errors import InputError
from mua.files.inputs import require_file

MARGIN = 0.05  # of the longer side of the box around a mask, left free on each side of it
COVERED = 0.5 / 255  # of a mask; what is less is nothing in 8 bits
Box = tuple[int, int, int, int]  # left, upper, right, lower edge in pixels


@dataclass(frozen=True)
class Files:
    """The files of a view's images; `number` is its frame where they are videos."""

    image: Path
    mask: Path | None  # None: the alpha of the image
    background: Path | None
    number: int
    trim: int = 0  # pixels by which masks are made narrower


@dataclass(frozen=True, eq=False)
class View:
    """An image and the pinhole that fits it: `mask` x `image` + (1 - mask) x anything is the person before it."""

    image: Array  # [H, W, 3] float32 sRGB, 0..1, in steps of 8 bits
    mask: Array  # [H, W] float32, 0..1, in steps of 8 bits
    pinhole: CaptureCamera  # the camera, cut and made smaller as the image is
    background: Array | None = None  # [H, W, 3] float32 sRGB, 0..1: the empty set

    @property
    def camera(self) -> Camera:
        """The pinhole as images are drawn with it."""
        return self.pinhole.camera()

    @property
    def empty(self) -> bool:
        """Whether nobody is in it: such a view counts nowhere."""
        return not bool((self.mask > COVERED).any())


@dataclass(frozen=True, eq=False)
class RawFrame:
    """One frame as its camera took it, with distortion."""

    image: Array  # [H, W, 3] uint8 sRGB
    mask: Array  # [H, W, 1] uint8
    clear: bool  # whether the mask is the image's alpha: where it is 0 the image has no colour


def read_view(files: Files, camera: CaptureCamera, *, crop: bool = False, rows: int | None = None) -> View:
    """Read a view; see `Capture.view`."""
    background = None
    if files.background is not None:
        require_file(files.background)
        background = read_picture(files.background, number=0, size=camera.size)[..., :3]
    taken = trimmed(read_frame(files, camera), files.trim)
    return view_of(taken, camera, crop=crop, rows=rows, background=background)


def read_frame(files: Files, camera: CaptureCamera) -> RawFrame:
    """Read image and mask; raises InputError where there is none."""
    image = read_picture(files.image, number=files.number, size=camera.size)
    if files.mask is not None:
        mask = read_mask(files.mask, number=files.number, size=camera.size)
        return RawFrame(image[..., :3], mask, clear=False)
    if image.shape[2] < 4:
        raise InputError(f"{files.image}: has no alpha; expected it to have one, or capture.json to name masks")
    return RawFrame(image[..., :3], image[..., 3:], clear=True)


def trimmed(taken: RawFrame, pixels: int) -> RawFrame:
    """The frame with its mask so many pixels narrower all round."""
    if not pixels:
        return taken
    from scipy.ndimage import minimum_filter  # slow to load, and most captures need none

    rows, columns = np.ogrid[-pixels : pixels + 1, -pixels : pixels + 1]
    disc = rows**2 + columns**2 <= pixels**2
    return replace(taken, mask=minimum_filter(taken.mask[..., 0], footprint=disc, mode="nearest")[..., None])


def nobody(camera: CaptureCamera, *, rows: int | None = None) -> View:
    """The view that stands for one whose image or mask is missing."""
    pinhole = replace(smaller(camera, rows), distortion=UNDISTORTED)
    width, height = pinhole.size
    return View(np.zeros((height, width, 3), np.float32), np.zeros((height, width), np.float32), pinhole)


def view_of(
    taken: RawFrame,
    camera: CaptureCamera,
    *,
    crop: bool,
    rows: int | None,  # that the whole image would have
    background: Array | None = None,  # [H, W, 3] uint8
) -> View:
    """The view without distortion."""
    if rows is not None and not 0 < rows <= camera.size[1]:
        raise InputError(f"rows is {rows}; camera {camera.name} has {camera.size[1]}, expected 1 to as many")
    small = smaller(camera, rows)
    box = person(look(taken.mask, camera, small, (0, 0, *small.size))[..., 0]) if crop else (0, 0, *small.size)
    mask = look(taken.mask, camera, small, box)
    if taken.clear:
        cover = taken.mask.astype(np.float32) / 255
        image = look(taken.image * cover, camera, small, box) / np.maximum(mask, COVERED)
    else:
        image = look(taken.image, camera, small, box)
    empty = None if background is None else in_steps(look(background, camera, small, box))
    return View(in_steps(image), in_steps(mask)[..., 0], replace(small.cropped(box), distortion=UNDISTORTED), empty)


def smaller(camera: CaptureCamera, rows: int | None) -> CaptureCamera:
    """The camera of a whole image with so many rows."""
    width, height = camera.size
    return camera if rows is None else camera.resized((max(1, round(width * rows / height)), rows))


def look(
    picture: Array,  # [H, W, C] 0..255, with distortion
    camera: CaptureCamera,
    small: CaptureCamera,  # the same for a smaller image
    box: Box,  # of the smaller image
) -> Array:
    """The image that a pinhole would have seen in a box, [h, w, C] float32 in 0..1."""
    (left, upper, right, lower), scale = box, np.array(camera.size) / small.size
    columns, rows = np.arange(left, right + 1) * scale[0], np.arange(upper, lower + 1) * scale[1]
    reach = (int(columns[0]), int(rows[0]), int(np.ceil(columns[-1])), int(np.ceil(rows[-1])))
    reach = (*reach[:2], min(reach[2], camera.size[0]), min(reach[3], camera.size[1]))
    part = undistort(picture, camera, reach)
    return area_average(part, rows - reach[1], columns - reach[0]) / 255


def person(mask: Array) -> Box:
    """The box around what a mask [H, W] covers, with a margin; all of the image where it covers nothing."""
    height, width = mask.shape
    columns, rows = (np.flatnonzero((mask > COVERED).any(axis=axis)) for axis in (0, 1))
    if not len(rows):
        return (0, 0, width, height)
    margin = int(np.ceil(MARGIN * max(np.ptp(columns), np.ptp(rows)) + 1))
    (left, right), (upper, lower) = ((int(at[0]) - margin, int(at[-1]) + 1 + margin) for at in (columns, rows))
    return max(left, 0), max(upper, 0), min(right, width), min(lower, height)


def in_steps(values: Array) -> Array:
    """Rounded to what 8 bits hold, so that a stored view is the same as one that was just read."""
    return (np.rint(np.clip(values, 0, 1) * 255) / 255).astype(np.float32)
