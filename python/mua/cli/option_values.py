"""Parses the values of options: screens, frames, azimuths, colours, names of files."""

import math
from pathlib import Path

from mua.arguments import listed
from mua.errors import InputError
from mua.live.receiver import LOOPBACK, Address
from mua.player.levels import AUTO, FULL
from mua.player.motion import require_frame
from mua.player.viewpoint import FARTHEST, NEAREST
from mua.pose.clip import Clip

LARGEST = 8192  # pixels along a side
HIGHEST_PORT = 65535
VIDEOS = (".mp4", ".webm", ".gif")
EVEN = (".mp4", ".webm")  # whose colours are coarser than their pixels
CLEAR = (".webm", ".gif", ".png", ".webp", ".tif", ".tiff")  # that can be transparent
TRANSPARENT = "transparent"


def parse_screen(size: str, *, even: bool = False) -> tuple[int, int]:
    """Width and height from `640x960` or `640`; `even` as a video's must be."""
    parts = size.split("x")
    if len(parts) > 2 or not all(p.isdecimal() and 0 < int(p) <= LARGEST for p in parts):
        raise InputError(f"--size is {size!r}; expected WIDTHxHEIGHT or one number, each from 1 to {LARGEST}")
    width, height = int(parts[0]), int(parts[-1])
    if even and (width % 2 or height % 2):
        raise InputError(f"--size is {size!r}; a video needs an even width and height")
    return width, height


def parse_color(text: str, output: Path | None) -> tuple[float, float, float] | None:
    """sRGB in 0..1 from a colour name or #rrggbb; None where the output is to be transparent."""
    if text == TRANSPARENT:
        if output is None or output.suffix.lower() not in CLEAR:
            where = "the window" if output is None else str(output)
            raise InputError(f"--background is transparent, but {where} cannot be; expected -o with {listed(CLEAR)}")
        return None
    from PIL import ImageColor

    try:
        red, green, blue = ImageColor.getrgb(text)[:3]
    except ValueError as error:
        raise InputError(f"--background is {text!r}; expected a colour name, #rrggbb or {TRANSPARENT}") from error
    return red / 255, green / 255, blue / 255


def parse_angle(option: str, degrees: float) -> float:
    """Convert degrees to radians; raises InputError unless they are finite."""
    if not math.isfinite(degrees):
        raise InputError(f"{option} is {degrees}; expected a finite number of degrees")
    return math.radians(degrees)


def parse_listen(text: str) -> Address:
    """A UDP port of this machine from `39539`, or of other addresses of it too, from `0.0.0.0:39539`."""
    host, _, port = text.rpartition(":")
    if not (port.isdecimal() and port.isascii() and 0 < int(port) <= HIGHEST_PORT) or (":" in text and not host):
        raise InputError(f"--listen is {text!r}; expected a port from 1 to {HIGHEST_PORT}, or ADDRESS:PORT")
    return Address(int(port), host or LOOPBACK)


def parse_zoom(zoom: float) -> float:
    """Check a zoom factor; raises InputError outside of the range that the mouse reaches."""
    if not 1 / FARTHEST <= zoom <= 1 / NEAREST:
        raise InputError(f"--zoom is {zoom:g}; expected {1 / FARTHEST:.2f} to {1 / NEAREST:g}")
    return zoom


def parse_expressions(text: str) -> dict[str, float]:
    """Weights by name from `jawOpen=0.7,eyeBlinkLeft=1`, held to 0 to 1."""
    weights: dict[str, float] = {}
    for part in filter(None, text.split(",")):
        name, found, weight = part.rpartition("=")
        try:
            value = float(weight)
        except ValueError:
            value = math.nan
        if not (found and name.strip() and math.isfinite(value)):
            raise InputError(f"--expressions has {part!r}; expected a name and a weight, such as jawOpen=0.7")
        weights[name.strip()] = min(max(value, 0.0), 1.0)
    return weights


def parse_level(level: str, *, geometry: bool) -> str | int:
    """`auto`, `full` or texels along a side; `geometry` where the surface is shown, which only the finest level has."""
    if level not in (AUTO, FULL) and not (level.isdecimal() and 0 < int(level) <= LARGEST):
        raise InputError(f"--level is {level!r}; expected {AUTO}, {FULL} or a number of texels such as 384")
    if geometry and level.isdecimal():
        raise InputError(f"--level is {level} and --show has geometry, which only the finest level has")
    return int(level) if level.isdecimal() else level


def parse_ipd(metres: float) -> float:
    """Check the distance between the eyes; raises InputError unless it is finite and not negative."""
    if not 0 <= metres < math.inf:
        raise InputError(f"--ipd is {metres:g}; expected a distance in metres")
    return metres


def parse_frame(frame: int | None, clip: Clip) -> range:
    """The frame of an image; the first if none is given."""
    index = require_frame(clip, 0 if frame is None else frame)
    return range(index, index + 1)


def parse_frames(text: str | None, clip: Clip) -> range:
    """The frames of `FIRST:END`, without END; either may be left out."""
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
    return output.suffix.lower() in VIDEOS


def require_format(output: Path) -> None:
    """Refuse a suffix that neither an image format nor a video has, before any work is done."""
    if is_video(output):
        return
    from PIL import Image

    kind = Image.registered_extensions().get(output.suffix.lower())
    if kind not in Image.SAVE:
        raise InputError(
            f"-o is {output}; expected a name that ends like an image, such as .png, or in {listed(VIDEOS)}"
        )
