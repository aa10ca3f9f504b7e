"""One image of a camera, from an image file or out of a video."""

from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError

from mua.arrays import Array
from mua.atlas.pictures import in_8_bits
from mua.capture.video import VIDEOS, MissingImage, video_frame
from mua.errors import InputError


def read_picture(
    path: Path,
    *,
    number: int,  # of the frame, where the file is a video
    size: tuple[int, int],  # width, height, pixels, that it must have
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
            require_size(path, opened.size, size)
            clear = "A" in opened.getbands() or "transparency" in opened.info
            return np.asarray(in_8_bits(opened).convert("RGBA" if clear else "RGB"))
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path}: cannot be read as an image: {error}") from error


def read_mask(path: Path, *, number: int, size: tuple[int, int]) -> Array:
    """Cover [H, W, 1] uint8: 255 inside."""
    return as_mask(read_picture(path, number=number, size=size))


def as_mask(
    picture: Array,  # [H, W, 3 or 4] uint8
) -> Array:
    """Cover [H, W, 1] uint8; a mask of nothing but 0 and 1 is taken for 0 and 255."""
    cover = picture[..., :3].max(axis=2, keepdims=True)
    return cover * np.uint8(255) if cover.max() == 1 else cover


def require_size(path: Path, found: tuple[int, int], expected: tuple[int, int]) -> None:
    """Raises InputError where an image is not as large as its camera says."""
    if tuple(found) != expected:
        raise InputError(
            f"{path}: the image is {found[0]} x {found[1]} pixels; "
            f"capture.json gives its camera {expected[0]} x {expected[1]}"
        )
