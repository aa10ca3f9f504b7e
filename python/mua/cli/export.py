"""mua-export: an avatar in files that other programs open."""

from pathlib import Path
from typing import Annotated

import typer

from mua.arguments import listed
from mua.cli.failure import run_command
from mua.cli.options import choice
from mua.errors import InputError
from mua.export.kinds import ENDINGS, SPLATS, WHATS, is_directory, kind_of
from mua.files.inputs import require_file, require_motion
from mua.files.write import require_writable

AXES = ("y-up", "y-down")


def export(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Avatar file (.muaavatar).")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="File to write; its ending says which format. A name with %04d, or a folder, for a file per frame.",
            show_default=False,
        ),
    ] = None,
    clip: Annotated[
        list[str] | None, typer.Option(help="Clip to export.", show_default="the first one", metavar="<str>")
    ] = None,
    frames: Annotated[
        str | None,
        typer.Option(
            help="Frames, counted from 0 at the avatar's frame rate: NUMBER, or FIRST:END with :STEP to skip some.",
            show_default="all; 0 where a file holds one frame",
        ),
    ] = None,
    what: Annotated[
        str | None, choice(WHATS, "--what", help="What to export.", default="the first that the format holds")
    ] = None,
    motion: Annotated[Path | None, typer.Option(help="Motion file to use instead of the avatar's own clips.")] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(
            help="JSON or TOML file that gives, for joints of the avatar, the joint of the motion.",
            show_default="matched by name",
        ),
    ] = None,
    axes: Annotated[
        str | None,
        choice(AXES, "--axes", help="Upward axis of splats.", default="what most viewers of the format expect"),
    ] = None,
) -> None:
    """Export frames of FILE for other programs.

    Splats as .ply, .compressed.ply, .spz, .usd, or .glb (by KHR_gaussian_splatting); the posed mesh and the
    skeleton with its motion as .glb or .usd; the detailed geometry likewise; motion as .bvh.
    """
    require_file(file)
    if motion is not None:
        require_motion(motion)
    if output is None:
        raise InputError(f"-o is not given; expected a directory or a name that ends in {listed(ENDINGS)}")
    kind = kind_of(output, what)
    if axes is not None and axes not in AXES:
        raise InputError(f"--axes is {axes!r}; expected {' or '.join(AXES)}")
    if axes is not None and (kind.what != SPLATS or kind.clip):
        raise InputError(f"--axes: works only with splats in .ply, .compressed.ply or .spz; -o is {output}")
    if clip and len(clip) > 1:
        raise InputError(f"--clip is given {len(clip)} times; a file holds one clip, expected a run for each")
    if mapping is not None and motion is None:
        raise InputError("--mapping: works only with --motion, which is not given")
    if not is_directory(output):
        require_writable(output)

    from mua.cli.export_files import Source, write  # after the options are checked, because it takes time to load

    write(output, kind, Source(file, motion, mapping, clip[0] if clip else None), frames=frames, axes=axes)


def run() -> None:
    """Entry point of the command."""
    run_command(export)


if __name__ == "__main__":
    run()
