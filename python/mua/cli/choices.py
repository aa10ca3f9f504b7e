"""What the texts of mua-view's options mean."""

from pathlib import Path

from PIL import Image, ImageColor

from mua.errors import InputError
from mua.motion.clip import Clip

LARGEST = 8192  # pixels along a side
VIDEO = ".mp4"


def parse_screen(size: str, *, even: bool = False) -> tuple[int, int]:
    """Width and height from `640x960` or `640`; `even` as a video's must be."""
    parts = size.split("x")
    if len(parts) > 2 or not all(p.isdecimal() and 0 < int(p) <= LARGEST for p in parts):
        raise InputError(f"--size is {size!r}; expected WIDTHxHEIGHT or one number, each from 1 to {LARGEST}")
    width, height = int(parts[0]), int(parts[-1])
    if even and (width % 2 or height % 2):
        raise InputError(f"--size is {size!r}; a video needs an even width and height")
    return width, height


def parse_color(text: str) -> tuple[float, float, float]:
    """sRGB in 0..1 from a colour name or #rrggbb."""
    try:
        red, green, blue = ImageColor.getrgb(text)[:3]
    except ValueError as error:
        raise InputError(f"--background is {text!r}; expected a colour name or #rrggbb") from error
    return red / 255, green / 255, blue / 255


def parse_frame(frame: int | None, clip: Clip) -> range:
    """The one frame of a picture, the first if none is given."""
    index = 0 if frame is None else frame
    if not 0 <= index < len(clip):
        raise InputError(f"--frame is {index}; clip {clip.name!r} has frames 0 to {len(clip) - 1}")
    return range(index, index + 1)


def parse_frames(text: str | None, clip: Clip) -> range:
    """The frames of `FIRST:END`, FIRST and not END; either may be left out."""
    if text is None:
        return range(len(clip))
    first, colon, end = text.partition(":")
    if not colon or not all(part == "" or part.isdecimal() for part in (first, end)):
        raise InputError(f"--frames is {text!r}; expected FIRST:END, such as 0:30 for the first thirty")
    frames = range(int(first or 0), int(end or len(clip)))
    if not frames or frames.stop > len(clip):
        raise InputError(f"--frames is {text!r}; clip {clip.name!r} has frames 0 to {len(clip) - 1}")
    return frames


def is_video(output: Path) -> bool:
    return output.suffix.lower() == VIDEO


def require_format(output: Path) -> None:
    """Refuse a suffix that neither an image format nor a video has, before any work is done."""
    if not is_video(output) and output.suffix.lower() not in Image.registered_extensions():
        raise InputError(f"-o is {output}; expected a suffix of an image format, such as .png, or {VIDEO}")
