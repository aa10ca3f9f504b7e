"""mua-view: an avatar in a window, or as a picture, a video or an animation."""

from pathlib import Path
from typing import Annotated

import typer

from mua.camera import EYE_DISTANCE
from mua.cli.failure import refusing
from mua.cli.view_options import CLOSE_UP, IN_FILES, IN_WINDOW, Asked, check_fitting, check_inputs, kind_of, look_of
from mua.errors import InputError
from mua.files import require_writable
from mua.motion.mapping import read_mapping
from mua.player.source import Source
from mua.player.toggles import Toggles

DEFAULTS = f"{IN_FILES.size}, in the window {IN_WINDOW.size}"


def _list_devices(wanted: bool) -> None:
    """Print every graphics device and stop, before FILE is asked for."""
    if wanted:
        from mua.gpu import adapters  # here, as all that needs a device: pictures by the CPU do without

        for index, adapter in enumerate(adapters()):
            print(f"{index}: {adapter}, {adapter.kind}")
        raise typer.Exit


def view(
    files: Annotated[list[Path], typer.Argument(help="A .muaavatar file; several to switch between in the window.")],
    clip: Annotated[str | None, typer.Option(help="Name of a clip in the file; the first if left out.")] = None,
    frame: Annotated[
        int | None, typer.Option(help="Frame at the avatar's rate, from 0: of a picture or turntable, or to stop at.")
    ] = None,
    frames: Annotated[str | None, typer.Option(help="Frames of a video, FIRST:END; all if left out.")] = None,
    motion: Annotated[Path | None, typer.Option(help="Motion file in place of the avatar's own clips.")] = None,
    mapping: Annotated[Path | None, typer.Option(help="JSON or TOML: avatar's joint to joint of the motion.")] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", help="Picture (.png ...), video (.mp4, .webm) or animation (.gif) to write; no window."
        ),
    ] = None,
    size: Annotated[
        str | None, typer.Option(help=f"WIDTHxHEIGHT of an eye in pixels, or one number; {DEFAULTS} if left out.")
    ] = None,
    azimuth: Annotated[
        float, typer.Option(help="Degrees round it to its left; 0 is its front in the first frame shown.")
    ] = 0,
    elevation: Annotated[float, typer.Option(help="Degrees from which the camera looks down.")] = 0,
    zoom: Annotated[
        float | None,
        typer.Option(help=f"Times nearer than all of the figure asks for; 1, or {CLOSE_UP:g} with --look-at."),
    ] = None,
    look_at: Annotated[
        str | None, typer.Option(help="What to look at and follow: a joint, or head, hips, 'left hand' ...")
    ] = None,
    orbit: Annotated[
        float | None, typer.Option(help="Degrees per second by which the camera goes round; 0, or 60 with --turntable.")
    ] = None,
    turntable: Annotated[
        bool, typer.Option("--turntable", help="A video of one frame from all sides that repeats without a seam.")
    ] = False,
    follow: Annotated[
        bool | None,
        typer.Option(help="Whether the camera goes along with the figure; it does in the window and with --look-at."),
    ] = None,
    stereo: Annotated[bool, typer.Option("--stereo", help="Left and right eye side by side.")] = False,
    ipd: Annotated[
        float | None, typer.Option(min=0.0, help=f"Metres between the eyes; {EYE_DISTANCE:g} if left out.")
    ] = None,
    background: Annotated[
        str | None, typer.Option(help=f"Colour name, #rrggbb or transparent; {IN_FILES.background} in files.")
    ] = None,
    device: Annotated[str | None, typer.Option(help="Part of the name of a graphics device, or its number.")] = None,
    list_devices: Annotated[
        bool, typer.Option("--list-devices", is_eager=True, callback=_list_devices, help="Number and name them.")
    ] = False,
    show: Annotated[
        str | None,
        typer.Option(
            help="Some of splats,geometry,template,skeleton,shadow, separated by commas; "
            f"{IN_FILES.show}, in the window {IN_WINDOW.show} if left out."
        ),
    ] = None,
    reference: Annotated[
        bool, typer.Option("--reference", help="Compute on the CPU in numpy; needs no device.")
    ] = False,
) -> None:
    """Show FILES in a window, or with -o write a picture, a video or an animation of one."""
    kind = kind_of(output, turntable=turntable)
    given: dict[str, object] = {
        "--frame": frame,
        "--frames": frames,
        "--orbit": orbit,
        "--ipd": ipd,
        "--stereo": stereo,
    }
    given |= {"--reference": reference, "--device": device, "--mapping": mapping, "--motion": motion}
    check_fitting(kind, output, given)
    asked = Asked(size, azimuth, elevation, zoom, look_at, orbit, follow, stereo, ipd, background, show)
    look = look_of(asked, output)
    if reference and look.toggles != Toggles():
        raise InputError(f"--show is {show!r}; --reference draws splats alone")
    check_inputs(files, output, motion)
    joints = None if mapping is None else read_mapping(mapping)
    source = Source(tuple(files), motion, joints, clip, frame)
    if output is None:
        from mua.player.window import show as show_window  # here, because pictures need no window system

        show_window(source, look, device=device)
        return
    require_writable(output)
    from mua.cli.view_files import write  # here, so that a wrong name costs no time

    write(output, kind, source, look, frames=frames, device=device, reference=reference)


def run() -> None:
    """Entry point of the command."""
    refusing(view)
