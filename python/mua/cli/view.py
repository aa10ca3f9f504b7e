"""mua-view: an avatar in a window, in a browser, or as an image, a video or an animation."""

from pathlib import Path
from typing import Annotated

import typer

from mua.avatar.camera import EYE_DISTANCE
from mua.cli.failure import run_command
from mua.cli.view_options import CLOSE_UP, IN_FILES, IN_WINDOW, Asked, check_fitting, check_inputs, kind_of, look_of
from mua.errors import InputError
from mua.files.write import require_writable
from mua.motion.mapping import read_mapping
from mua.player.source import Source
from mua.player.toggles import Toggles

DEFAULTS = f"{IN_FILES.size}, window {IN_WINDOW.size}"


def _list_devices(wanted: bool) -> None:
    """Print every graphics device and stop, before FILE is asked for."""
    if wanted:
        from mua.gpu import adapters  # here, because --reference needs no device

        for index, adapter in enumerate(adapters()):
            print(f"{index}: {adapter}, {adapter.kind}")
        raise typer.Exit


def view(
    files: Annotated[
        list[Path], typer.Argument(help="Avatar file (.muaavatar); give several to switch between them in the window.")
    ],
    clip: Annotated[str | None, typer.Option(help="Clip to play.", show_default="the first one")] = None,
    frame: Annotated[
        int | None,
        typer.Option(help="Frame to show, counted from 0 at the avatar's frame rate; the window pauses there."),
    ] = None,
    frames: Annotated[str | None, typer.Option(help="Frames of a video, as FIRST:END.", show_default="all")] = None,
    motion: Annotated[Path | None, typer.Option(help="Motion file to play instead of the avatar's own clips.")] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(
            help="JSON or TOML file that gives, for joints of the avatar, the joint of the motion.",
            show_default="matched by name",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Image (.png and others), video (.mp4, .webm) or animation (.gif) to write.",
            show_default="opens a window",
        ),
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(help="Image size per eye in pixels: WIDTHxHEIGHT or one number.", show_default=DEFAULTS),
    ] = None,
    azimuth: Annotated[
        float, typer.Option(help="Camera angle around the figure in degrees, towards its left; 0 is its front.")
    ] = 0,
    elevation: Annotated[float, typer.Option(help="Camera angle above the horizon in degrees.")] = 0,
    zoom: Annotated[
        float | None,
        typer.Option(help="Zoom factor; 1 shows the whole figure.", show_default=f"1; {CLOSE_UP:g} with --look-at"),
    ] = None,
    look_at: Annotated[
        str | None, typer.Option(help="Joint or body part to look at and follow, such as head, hips or 'left hand'.")
    ] = None,
    orbit: Annotated[
        float | None,
        typer.Option(
            help="Degrees per second by which the camera orbits the figure.", show_default="0; 60 with --turntable"
        ),
    ] = None,
    turntable: Annotated[
        bool, typer.Option("--turntable", help="Write a looping video that shows one frame from all sides.")
    ] = False,
    follow: Annotated[
        bool | None,
        typer.Option(
            help="Whether the camera follows the figure.", show_default="follows in the window and with --look-at"
        ),
    ] = None,
    stereo: Annotated[bool, typer.Option("--stereo", help="Show left and right eye side by side.")] = False,
    ipd: Annotated[
        float | None,
        typer.Option(min=0.0, help="Distance between the eyes in metres.", show_default=f"{EYE_DISTANCE:g}"),
    ] = None,
    background: Annotated[
        str | None,
        typer.Option(
            help="Background: a colour name, #rrggbb or transparent.",
            show_default=f"{IN_FILES.background}, window {IN_WINDOW.background}",
        ),
    ] = None,
    device: Annotated[str | None, typer.Option(help="Graphics device: its number or part of its name.")] = None,
    list_devices: Annotated[
        bool,
        typer.Option(
            "--list-devices", is_eager=True, callback=_list_devices, help="List the graphics devices and exit."
        ),
    ] = False,
    show: Annotated[
        str | None,
        typer.Option(
            help="What to draw, separated by commas: splats, geometry, template, skeleton, shadow.",
            show_default=f"{IN_FILES.show}; window {IN_WINDOW.show}",
        ),
    ] = None,
    level: Annotated[
        str | None,
        typer.Option(
            help="Level of detail: full, texels along a side such as 384, or auto: fewer when seen from afar.",
            show_default=f"{IN_FILES.level}, window {IN_WINDOW.level}",
        ),
    ] = None,
    reference: Annotated[
        bool, typer.Option("--reference", help="Compute on the CPU with numpy; needs no graphics device.")
    ] = False,
    web: Annotated[
        bool, typer.Option("--web", help="Show FILES in a browser, served from this machine alone.")
    ] = False,
    no_open: Annotated[bool, typer.Option("--no-open", help="With --web: print the address, open no browser.")] = False,
) -> None:
    """Show FILES in a window or a browser, or write an image, a video or an animation of one with -o."""
    if no_open and not web:
        raise InputError("--no-open: works only with --web, which is not given")
    if web:
        left = {"-o": output, "--frame": frame, "--frames": frames, "--ipd": ipd, "--level": level}
        left |= {"--reference": reference, "--device": device, "--mapping": mapping, "--motion": motion}
        left |= {"--size": size, "--zoom": zoom, "--look-at": look_at, "--follow": follow, "--turntable": turntable}
        from mua.cli.view_web import Where, check_web, serve

        check_web({**left, "--background": background})
        where = Where(azimuth, elevation, orbit, stereo)
        serve(files, where, clip=clip, show=show, opens=not no_open)
        return
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
    asked = Asked(size, azimuth, elevation, zoom, look_at, orbit, follow, stereo, ipd, background, show, level)
    look = look_of(asked, output)
    if reference and look.toggles != Toggles():
        raise InputError(f"--show is {show!r}; --reference draws only splats")
    check_inputs(files, output, motion)
    joints = None if mapping is None else read_mapping(mapping)
    source = Source(tuple(files), motion, joints, clip, frame)
    if output is None:
        from mua.player.window import show as show_window  # here, because files need no window system

        show_window(source, look, device=device)
        return
    require_writable(output)
    from mua.cli.view_files import write  # here, so that a wrong name fails at once

    write(output, kind, source, look, frames=frames, device=device, reference=reference)


def run() -> None:
    """Entry point of the command."""
    run_command(view)


if __name__ == "__main__":
    run()
