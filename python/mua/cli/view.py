"""mua-view: one frame of an avatar as an image, by the CPU reference."""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from PIL import Image, ImageColor

from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.camera import orbit
from mua.cli.failure import refusing
from mua.decode import decode_clip_frame
from mua.errors import InputError
from mua.files import replacing
from mua.motion.clip import Clip
from mua.motion.resample import resample
from mua.render import frame_bounds, render, to_bytes

LARGEST = 8192  # pixels along a side


def view(
    file: Annotated[Path, typer.Argument(help="A .muaavatar file.")],
    clip: Annotated[str | None, typer.Option(help="Name of a clip in the file; the first if left out.")] = None,
    frame: Annotated[int, typer.Option(help="Frame of the clip at the avatar's rate, from 0.")] = 0,
    output: Annotated[Path, typer.Option("--output", "-o", help="Image to write; its suffix names the format.")] = Path(
        "view.png"
    ),
    size: Annotated[str, typer.Option(help="WIDTHxHEIGHT in pixels, or one number for a square.")] = "640x960",
    azimuth: Annotated[float, typer.Option(help="Degrees round it to its left; 0 is the front of its bind pose.")] = 0,
    elevation: Annotated[float, typer.Option(help="Degrees from which the camera looks down.")] = 0,
    background: Annotated[str, typer.Option(help="Colour name or #rrggbb.")] = "white",
) -> None:
    """Render one frame of FILE."""
    screen, color = _screen(size), _color(background)
    _require_format(output)
    avatar = read(file)
    chosen = resample(_find(avatar, file, clip), avatar.encoding.rate)
    if not 0 <= frame < len(chosen):
        raise InputError(f"--frame is {frame}; clip {chosen.name!r} has frames 0 to {len(chosen) - 1}")
    posed = decode_clip_frame(avatar, chosen, frame=frame)
    camera = orbit(frame_bounds(posed), screen=screen, azimuth=np.radians(azimuth), elevation=np.radians(elevation))
    image = render(posed, camera, background=color)
    with replacing(output) as temporary:
        Image.fromarray(to_bytes(image)).save(temporary)


def run() -> None:
    """Entry point of the command."""
    refusing(view)


def _find(avatar: Avatar, file: Path, name: str | None) -> Clip:
    """The clip of that name, or the first."""
    names = [clip.name for clip in avatar.clips]
    if not names:
        raise InputError(f"{file} holds no clips; mua-view needs one to pose the avatar")
    if name is not None and name not in names:
        raise InputError(f"--clip is {name!r}; {file} holds {', '.join(names)}")
    return avatar.clips[0 if name is None else names.index(name)]


def _screen(size: str) -> tuple[int, int]:
    """Width and height from `640x960` or `640`."""
    parts = size.split("x")
    if len(parts) > 2 or not all(p.isdecimal() and 0 < int(p) <= LARGEST for p in parts):
        raise InputError(f"--size is {size!r}; expected WIDTHxHEIGHT or one number, each from 1 to {LARGEST}")
    return int(parts[0]), int(parts[-1])


def _color(text: str) -> tuple[float, float, float]:
    """sRGB in 0..1 from a colour name or #rrggbb."""
    try:
        red, green, blue = ImageColor.getrgb(text)[:3]
    except ValueError as error:
        raise InputError(f"--background is {text!r}; expected a colour name or #rrggbb") from error
    return red / 255, green / 255, blue / 255


def _require_format(output: Path) -> None:
    """Refuse a suffix that no image format has, before any work is done."""
    if output.suffix.lower() not in Image.registered_extensions():
        raise InputError(f"-o is {output}; expected a suffix of an image format, such as .png")
