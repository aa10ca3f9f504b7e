"""One image of a camera, from an image file or out of a video."""

from pathlib import Path

import numpy as np
from PIL import ExifTags, Image, ImageOps, UnidentifiedImageError

from mua.arrays import Array
from mua.atlas.pictures import in_8_bits
from mua.capture.video import VIDEOS, MissingImage, video_frame
from mua.errors import InputError
from mua.files.signature import told_by

GREY, DARK = 64, 32  # differences between red, green and blue that compression makes of greys; what it makes of black
LABELS = 32  # more parts of a body than any tool tells apart (LIP and CIHP 20, Sapiens 28)
LOSSLESS = (".png", ".bmp", ".tif", ".tiff")  # where small numbers are no noise of compression
TURNED, ON_SIDE = range(2, 9), range(5, 9)  # orientations of EXIF: turned or mirrored at all, by a quarter turn


def read_picture(
    path: Path,
    *,
    number: int,  # of the frame, where the file is a video
    size: tuple[int, int],  # width, height, pixels, that it must have
    labels: int = 0,  # up to which numbers of 16 bits are labels, which are not scaled to 8 bits
) -> Array:
    """Colours [H, W, 3] uint8 sRGB, or [H, W, 4] with alpha; raises MissingImage or, for anything else, InputError."""
    if not path.is_file():
        raise MissingImage(f"{path}: there is no such file")
    if path.suffix.lower() in VIDEOS:
        frame = video_frame(path, number)
        require_size(path, (frame.shape[1], frame.shape[0]), size)
        return frame
    try:
        with Image.open(path) as opened:
            image = _as_calibrated(path, opened, size)
            clear = "A" in image.getbands() or "transparency" in image.info
            return np.asarray(_in_8_bits(image, labels).convert("RGBA" if clear else "RGB"))
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        found = told_by(path.read_bytes()) if isinstance(error, UnidentifiedImageError) else ""
        raise InputError(f"{path}: cannot be read as an image: {f'it is {found}' if found else error}") from error


def picture_size(path: Path, *, like: tuple[int, int] | None) -> tuple[int, int]:
    """Width and height of an image that its camera, calibrated for images of a size `like`, means."""
    try:
        with Image.open(path) as opened:
            width, height = opened.size
            if _orientation(opened) in ON_SIDE and (like is None or (width > height) != (like[0] > like[1])):
                return height, width
            return width, height
    except OSError as error:
        raise InputError(f"{path}: cannot be read as an image: {error}") from error


def _orientation(opened: Image.Image) -> int:
    return int(opened.getexif().get(ExifTags.Base.Orientation, 1))


def _as_calibrated(path: Path, opened: Image.Image, size: tuple[int, int]) -> Image.Image:
    """The image as its camera was calibrated. OpenCV turns images as EXIF says, COLMAP does not: their sides tell."""
    orientation = _orientation(opened)
    if orientation in ON_SIDE and size[0] != size[1]:
        return ImageOps.exif_transpose(opened) if opened.size == size[::-1] else _of_size(path, opened, size)
    if orientation in TURNED:
        raise InputError(
            f"{path}: EXIF orientation is {orientation}, by which some programs turn images and others do not; "
            "expected images without it that lie as in the calibration"
        )
    return _of_size(path, opened, size)


def _of_size(path: Path, opened: Image.Image, size: tuple[int, int]) -> Image.Image:
    require_size(path, opened.size, size)
    return opened


def read_mask(path: Path, *, number: int, size: tuple[int, int]) -> Array:
    """Cover [H, W, 1] uint8: 255 inside."""
    labels = LABELS if path.suffix.lower() in LOSSLESS else 1
    return as_mask(read_picture(path, number=number, size=size, labels=labels), labels=labels)


def _in_8_bits(image: Image.Image, labels: int) -> Image.Image:
    if image.mode.startswith("I;16") and np.max(values := np.asarray(image)) <= labels:
        return Image.fromarray(values.astype(np.uint8))
    return in_8_bits(image)


def as_mask(
    picture: Array,  # [H, W, 3 or 4] uint8
    *,
    labels: int = 1,  # where nothing is larger, it is labels: of a person, or of the parts of a body
) -> Array:
    """Cover [H, W, 1] uint8: alpha of a cut-out, all that colours or labels paint, else brightness."""
    if picture.shape[2] == 4 and np.ptp(picture[..., 3]) > 0:
        cover = picture[..., 3:]
    else:
        red, green, blue = np.moveaxis(picture[..., :3], 2, 0)
        cover = np.maximum(np.maximum(red, green), blue)[..., None]
        least = np.minimum(np.minimum(red, green), blue)[..., None]
        if (cover - least).max() > GREY:  # labels of people or parts of a body, dark red for the first in many tools
            return np.where(cover > DARK, np.uint8(255), np.uint8(0))
    return np.where(cover > 0, np.uint8(255), np.uint8(0)) if cover.max() <= labels else cover


def require_size(path: Path, found: tuple[int, int], expected: tuple[int, int]) -> None:
    """Raises InputError where an image is not as large as its camera says."""
    if tuple(found) != expected:
        raise InputError(
            f"{path}: the image is {found[0]} x {found[1]} pixels; "
            f"capture.json gives its camera {expected[0]} x {expected[1]}"
        )
