"""What the options of mua-view ask for, in the window and in files alike; checked before anything is loaded."""

from collections.abc import Mapping, Set
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, Literal

from mua.arguments import listed
from mua.avatar.camera import EYE_DISTANCE
from mua.cli.option_values import (
    EVEN,
    VIDEOS,
    is_video,
    parse_angle,
    parse_color,
    parse_expressions,
    parse_ipd,
    parse_level,
    parse_screen,
    parse_zoom,
    require_format,
)
from mua.errors import InputError
from mua.files.inputs import require_file, require_motion
from mua.motion.formats import require_face
from mua.option import Option
from mua.player.levels import AUTO, FULL
from mua.player.shot import Look, Shot
from mua.player.toggles import parse_toggles

Kind = Literal["window", "image", "video", "turntable"]
MEANT = {"window": "the window", "image": "an image", "video": "a video", "turntable": "a turntable"}
FITTING: dict[str, tuple[Kind, ...]] = {  # options that do not go with everything
    "--frame": ("window", "image", "turntable"),
    "--frames": ("video",),
    "--listen": ("window",),
    "--orbit": ("window", "video", "turntable"),
    "--reference": ("image", "video", "turntable"),
}
BESIDE = {"--mapping": ("--motion", "--listen"), "--ipd": ("--stereo",)}  # options that need one of others
INSTEAD = ("--motion", "--clip", "--frame")  # options that say what is played, as --listen does
CLOSE_UP = 4.0  # times nearer, where a joint is looked at


@dataclass(frozen=True)
class Defaults:
    """What options mean that are left out."""

    size: str
    background: str
    show: str
    follow: bool
    level: str


IN_FILES = Defaults(size="640x960", background="white", show="splats", follow=False, level=FULL)
IN_WINDOW = Defaults(size="1280x860", background="#edf0f2", show="splats,shadow", follow=True, level=AUTO)


@dataclass(frozen=True)
class Asked:
    """How the figure is to be seen: options of mua-view; None where one is left out."""

    _: KW_ONLY
    size: Annotated[
        str | None,
        Option(
            "Image size per eye in pixels: WIDTHxHEIGHT or one number.",
            default=f"{IN_FILES.size}, window {IN_WINDOW.size}",
        ),
    ] = None
    azimuth: Annotated[
        float, Option("Camera angle around the figure in degrees, towards its left; 0 is its front.")
    ] = 0.0
    elevation: Annotated[float, Option("Camera angle above the horizon in degrees.")] = 0.0
    zoom: Annotated[
        float | None,
        Option("Zoom factor; 1 shows the whole figure.", default=f"1; {CLOSE_UP:g} with --look-at"),
    ] = None
    look_at: Annotated[
        str | None, Option("Joint or body part to look at and follow, such as head, hips or 'left hand'.")
    ] = None
    orbit: Annotated[
        float | None,
        Option("Degrees per second by which the camera orbits the figure.", default="0; 60 with --turntable"),
    ] = None
    follow: Annotated[
        bool | None,
        Option("Whether the camera follows the figure.", default="follows in the window and with --look-at"),
    ] = None
    stereo: Annotated[bool, Option("Draw left and right eye side by side.")] = False
    ipd: Annotated[float | None, Option("Distance between the eyes in metres.", default=f"{EYE_DISTANCE:g}")] = None
    background: Annotated[
        str | None,
        Option(
            "Background: a colour name, #rrggbb or transparent.",
            default=f"{IN_FILES.background}, window {IN_WINDOW.background}",
        ),
    ] = None
    show: Annotated[
        str | None,
        Option(
            "What to draw, separated by commas: splats, geometry, template, skeleton, shadow.",
            default=f"{IN_FILES.show}; window {IN_WINDOW.show}",
        ),
    ] = None
    level: Annotated[
        str | None,
        Option(
            "Level of detail: full, texels along a side such as 384, or auto: fewer when seen from afar.",
            default=f"{IN_FILES.level}, window {IN_WINDOW.level}",
        ),
    ] = None
    expressions: Annotated[
        str | None,
        Option(
            "Weights of expressions, such as jawOpen=0.7,eyeBlinkLeft=1; mua-inspect lists their names.",
            default="those of the clip",
        ),
    ] = None


def kind_of(output: Path | None, *, turntable: bool) -> Kind:
    """What is asked for; raises InputError for a name that no such file has."""
    if turntable and (output is None or not is_video(output)):
        found = "no -o is given" if output is None else f"-o is {output}"
        raise InputError(f"--turntable: {found}; expected -o with a name that ends in {listed(VIDEOS)}")
    if output is None:
        return "window"
    require_format(output)
    if turntable:
        return "turntable"
    return "video" if is_video(output) else "image"


def check_fitting(kind: Kind, output: Path | None, given: Mapping[str, object]) -> None:
    """Raises InputError for an option that would change nothing; `given` has the value of each, None or False if none.

    Those that are not in FITTING act in the window and in files.
    """
    named = {option for option, value in given.items() if value is not None and value is not False}
    for option, kinds in FITTING.items():
        if option in named and kind not in kinds:
            fitting = listed([MEANT[kind] for kind in kinds])
            found = "no -o is given" if output is None else f"-o is {output}, {MEANT[kind]}"
            raise InputError(f"{option}: works only with {fitting}; {found}")
    check_together(named)
    if {"--reference", "--device"} <= named:
        raise InputError(
            "--device and --reference are both given, but --reference uses no graphics device; expected one of the two"
        )


def check_together(named: Set[str]) -> None:
    """Raises InputError for an option that lacks another one beside it, or has one that says otherwise."""
    for option, others in BESIDE.items():
        if option in named and not named & set(others):
            raise InputError(f"{option}: works only with {' or '.join(others)}, which is not given")
    for option in INSTEAD:
        if {option, "--listen"} <= named:
            raise InputError(f"{option}: works only without --listen, which shows what another program sends")


def check_inputs(files: list[Path], output: Path | None, motion: Path | None, face: Path | None) -> None:
    """Raises InputError for a file that is not there, or more of them than an image shows."""
    if output is not None and len(files) > 1:
        raise InputError(f"-o is {output}; expected one FILE, found {len(files)}")
    for file in files:
        require_file(file)
    if motion is not None:
        require_motion(motion)
    if face is not None:
        require_face(face)


def look_of(asked: Asked, output: Path | None) -> Look:
    """What the window (no output) or the file shows, and from where; raises InputError for what no option can be."""
    left_out = IN_WINDOW if output is None else IN_FILES
    even = output is not None and output.suffix.lower() in EVEN
    close = 1.0 if asked.look_at is None else CLOSE_UP
    shot = Shot(
        screen=parse_screen(asked.size or left_out.size, even=even),
        azimuth=parse_angle("--azimuth", asked.azimuth),
        elevation=parse_angle("--elevation", asked.elevation),
        turning=parse_angle("--orbit", asked.orbit or 0.0),
        follow=left_out.follow or asked.look_at is not None if asked.follow is None else asked.follow,
        eyes=parse_ipd(EYE_DISTANCE if asked.ipd is None else asked.ipd) if asked.stereo else None,
        zoom=parse_zoom(close if asked.zoom is None else asked.zoom),
        look_at=asked.look_at,
    )
    color = parse_color(asked.background or left_out.background, output)
    toggles = parse_toggles(asked.show or left_out.show)
    level = parse_level(asked.level or left_out.level, geometry=toggles.geometry)
    return Look(shot, toggles, color, level, parse_expressions(asked.expressions or ""))
