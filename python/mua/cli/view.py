"""mua-view: an avatar in a window, in a browser, or as an image, a video or an animation."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any

import typer

from mua.cli.failure import run_command
from mua.cli.listening import listening
from mua.cli.option_values import parse_listen
from mua.cli.options import command_options, lent_by
from mua.cli.view_options import Asked, check_fitting, check_inputs, kind_of, look_of
from mua.errors import InputError
from mua.files.write import require_writable
from mua.motion.mapping import read_mapping
from mua.player.played_files import Source
from mua.player.toggles import Toggles

PANELS = {"Camera and look": [field.name for field in fields(Asked)]}


def _list_devices(wanted: bool) -> None:
    """Print every graphics device and stop, before FILE is asked for."""
    if wanted:
        from mua.gpu import adapters  # here, because --reference needs no device

        for index, adapter in enumerate(adapters()):
            print(f"{index}: {adapter}, {adapter.kind}")
        raise typer.Exit


@lent_by(Asked, command_options(Asked, PANELS))
def view(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILES", help="Avatar file (.muaavatar); give several to switch between them in the window."
        ),
    ],
    clip: Annotated[str | None, typer.Option(help="Clip to play.", show_default="the first one")] = None,
    frame: Annotated[
        int | None,
        typer.Option(help="Frame to show, counted from 0 at the avatar's frame rate; the window pauses there."),
    ] = None,
    frames: Annotated[str | None, typer.Option(help="Frames of a video, as FIRST:END.", show_default="all")] = None,
    listen: Annotated[
        str | None,
        typer.Option(
            metavar="PORT",
            help="Show poses and expressions that another program sends by the VMC protocol to this UDP port of this "
            "machine, usually 39539; ADDRESS:PORT for another address, 0.0.0.0 being all.",
        ),
    ] = None,
    motion: Annotated[Path | None, typer.Option(help="Motion file to play instead of the avatar's own clips.")] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(
            help="JSON or TOML file that gives, for joints of the avatar, the joint of the motion or the bone of VMC.",
            show_default="matched by name",
        ),
    ] = None,
    face: Annotated[
        Path | None,
        typer.Option(
            help="Facial motion beside the body's: a .csv of Live Link Face, a .json of Audio2Face, or a motion file."
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
    turntable: Annotated[
        bool, typer.Option("--turntable", help="Write a looping video that shows one frame from all sides.")
    ] = False,
    device: Annotated[str | None, typer.Option(help="Graphics device: its number or part of its name.")] = None,
    list_devices: Annotated[
        bool,
        typer.Option(
            "--list-devices", is_eager=True, callback=_list_devices, help="List the graphics devices and exit."
        ),
    ] = False,
    reference: Annotated[
        bool, typer.Option("--reference", help="Compute on the CPU with numpy; needs no graphics device.")
    ] = False,
    web: Annotated[
        bool, typer.Option("--web", help="Show FILES in a browser, served from this machine alone.")
    ] = False,
    no_open: Annotated[bool, typer.Option("--no-open", help="With --web: print the address, open no browser.")] = False,
    **seen: Any,  # the fields of Asked
) -> None:
    """Show FILES in a window or a browser, or write an image, a video or an animation of one with -o."""
    if no_open and not web:
        raise InputError("--no-open: works only with --web, which is not given")
    asked = Asked(**seen)
    given = {"--frame": frame, "--frames": frames, "--reference": reference, "--device": device, "--motion": motion}
    given |= {"--face": face, "--mapping": mapping, "--listen": listen, "--clip": clip}
    given |= {f"--{name.replace('_', '-')}": value for name, value in seen.items()}
    if web:
        from mua.cli.view_web import check_web, serve

        check_web({**given, "-o": output, "--turntable": turntable})
        address = None if listen is None else parse_listen(listen)
        serve(files, asked, clip=clip, opens=not no_open, listen=address, mapping=mapping)
        return
    kind = kind_of(output, turntable=turntable)
    check_fitting(kind, output, given)
    look, address = look_of(asked, output), None if listen is None else parse_listen(listen)
    if reference and look.toggles != Toggles():
        raise InputError(f"--show is {asked.show!r}; --reference draws only splats")
    check_inputs(files, output, motion, face)
    joints = None if mapping is None else read_mapping(mapping)
    source = Source(tuple(files), motion, joints, face, clip, frame)
    if output is None:
        from mua.player.window import show as show_window  # here, because files need no window system

        with listening(address) as receiver:
            show_window(replace(source, receiver=receiver), look, device=device)
        return
    require_writable(output)
    from mua.cli.view_files import write  # here, so that a wrong name fails at once

    write(output, kind, source, look, frames=frames, device=device, reference=reference)


def run() -> None:
    """Entry point of the command."""
    run_command(view)


if __name__ == "__main__":
    run()
