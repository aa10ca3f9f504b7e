"""mua-capture poses: poses of a template from 3D keypoints."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from mua.arguments import amount
from mua.cli.console import printer, say
from mua.errors import InputError
from mua.files.inputs import require_file
from mua.files.write import require_writable

if TYPE_CHECKING:  # takes long to load
    from mua.capture.keypoint_fit import Fitted

NOTED = 0.1  # relative difference in limb length between template and person that is worth a note


def poses(
    keypoints: Annotated[
        Path,
        typer.Argument(
            metavar="KEYPOINTS",
            help="3D keypoints: a .trc of Pose2Sim, OpenCap or OpenSim, a .csv or .npy of FreeMoCap, or a folder of "
            "EasyMocap or OpenPose with a .json for each frame.",
        ),
    ],
    template: Annotated[Path, typer.Option(help="The person as a rigged character.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="File of poses to write (.npz).")],
    height: Annotated[
        float | None, typer.Option(help="Height of the template in metres.", show_default="as its file says")
    ] = None,
    axes: Annotated[
        str, typer.Option(help="What X, Y and Z of the keypoints are in a world with Y up; X,-Z,Y where their Z is up.")
    ] = "X,Y,Z",
    scale: Annotated[
        float, typer.Option(min=1e-9, help="Metres in one unit of the keypoints; 0.001 for millimetres.")
    ] = 1.0,
    rate: Annotated[
        float | None, typer.Option(min=1, max=1000, help="Frames per second.", show_default="as the file says, or 30")
    ] = None,
) -> None:
    """Pose a template by 3D keypoints, for `describe --motion`; its limbs become as long as the person's."""
    if not keypoints.is_dir():
        require_file(keypoints)
    require_file(template)
    if output.suffix.lower() != ".npz":
        raise InputError(f"--output {output}: the suffix is {output.suffix or 'missing'}, expected .npz")
    require_writable(output)

    from mua.capture.conventions import read_axes
    from mua.capture.keypoint_fit import fit_keypoints
    from mua.capture.readers.keypoints import read_keypoints
    from mua.characters.figure_size import FigureSize
    from mua.characters.read import read_surfaces
    from mua.motion.poses_file import write_poses

    console, surfaces = printer(), read_surfaces(template, size=FigureSize(height=height))
    fitted = fit_keypoints(read_keypoints(keypoints, axes=read_axes(axes), scale=scale, rate=rate), surfaces)
    write_poses(output, surfaces.skeleton, fitted.clip)
    _show(console, fitted)
    say(console, f"{output}: {amount(len(fitted.clip), 'pose')} at {fitted.clip.rate:g} frames per second")


def _show(console: Console, fitted: "Fitted") -> None:
    """How far the poses are from the keypoints."""
    table = Table("keypoint", "joint", "median", "largest", box=SIMPLE_HEAD)
    for target, (median, largest) in zip(fitted.targets, fitted.spread(), strict=True):
        table.add_row(target.name, target.role, f"{100 * median:.1f} cm", f"{100 * largest:.1f} cm")
    console.print(table)
    if abs(fitted.limbs - 1) > NOTED:
        say(console, f"The person's limbs are {fitted.limbs:.2f} times as long as the template's: look at its height.")
