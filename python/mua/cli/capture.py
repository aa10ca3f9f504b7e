"""mua-capture: whether a capture is what it should be, before a teacher is trained on it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from mua.arguments import amount
from mua.cli.capture_poses import poses
from mua.cli.console import printer, say
from mua.cli.failure import run_commands
from mua.errors import InputError
from mua.files.inputs import CAPTURE, require_capture, require_file, require_folder
from mua.files.write import replacing, require_writable

if TYPE_CHECKING:  # takes long to load
    from mua.capture import Capture
    from mua.capture.check import CameraFit, Checked

PICTURES = (".png", ".jpg", ".jpeg")


def check(
    folder: Annotated[Path, typer.Argument(metavar="CAPTURE", help="Folder of the capture; it holds a capture.json.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Image to write: the template's outline over some of the views."),
    ] = None,
    frames: Annotated[
        int | None,
        typer.Option(min=0, help="Frames of each clip to look at; 0 looks at all.", show_default="a few"),
    ] = None,
) -> None:
    """Say what a capture is understood to be, how well the posed template fits the masks, and what cannot be right.

    The exit status is 1 where something cannot be right.
    """
    require_capture(folder)
    if output is not None:
        _require_picture(output)

    from mua.capture import open_capture  # here, so that a wrong name fails at once
    from mua.capture.check import check_capture, summary

    console, capture = printer(), open_capture(folder)
    for line in summary(capture):
        say(console, line)
    checked = check_capture(capture, frames=frames)
    _show(console, checked)
    if output is not None:
        from mua.capture.sheet import check_sheet

        with replacing(output) as temporary:
            check_sheet(checked).save(temporary)
        say(console, str(output))
    if checked.problems:
        raise typer.Exit(1)


def describe(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="IMAGES",
            help="Folder with images: in the layout of AvatarReX, THuman4 or UMA, or with --calibration in images/ "
            "or videos/ and masks/.",
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder to write capture.json and the poses to.")],
    template: Annotated[
        Path | None,
        typer.Option(
            help="The person as a rigged character, for AvatarReX and THuman4 on SMPL-X.",
            show_default="UMA: the .character with the videos",
        ),
    ] = None,
    motion: Annotated[
        Path | None,
        typer.Option(help="Poses, one for each frame.", show_default="UMA: those with the .character"),
    ] = None,
    calibration: Annotated[
        Path | None,
        typer.Option(
            help="Cameras: a .toml of Pose2Sim, Caliscope or anipose, calibration.csv of ActorsHQ, transforms.json of "
            "Nerfstudio, or a folder with EasyMocap's intri.yml and extri.yml or with COLMAP's cameras and images."
        ),
    ] = None,
    axes: Annotated[
        str,
        typer.Option(help="What X, Y and Z of the calibration are in a world with Y up; X,-Z,Y where its Z is up."),
    ] = "X,Y,Z",
    scale: Annotated[
        float, typer.Option(min=1e-9, help="Metres in one unit of the calibration; 0.001 for millimetres.")
    ] = 1.0,
    rate: Annotated[
        float | None, typer.Option(min=1, max=1000, help="Frames per second.", show_default="the videos', or 30")
    ] = None,
    height: Annotated[
        float | None, typer.Option(help="Height of the template in metres.", show_default="as its file says")
    ] = None,
    leave_out: Annotated[
        list[str] | None,
        typer.Option(
            metavar="<str>", help="Mesh, node or material of the template that nobody filmed; may be repeated."
        ),
    ] = None,
) -> None:
    """Write a capture.json for images in another layout; the images are not copied."""
    require_folder(source)
    for given in (template, motion):
        if given is not None:
            require_file(given)
    if calibration is None and (axes != "X,Y,Z" or scale != 1):
        raise InputError("--axes and --scale apply to a --calibration, and none is given; add it or leave them out")
    require_writable(output / CAPTURE)

    from mua.capture import open_capture, write_capture

    beside = _Given(template, motion, rate, height, tuple(leave_out or ()))
    if calibration is None:
        capture = _described(source, output, beside)
    else:
        capture = _calibrated(source, output, calibration, beside, axes=axes, scale=scale)
    written = write_capture(capture)
    open_capture(output)  # which refuses what cannot be
    frames = sum(clip.frames for clip in capture.clips)
    filmed = f"{amount(frames, 'frame')} in {amount(len(capture.clips), 'clip')}"
    say(printer(), f"{written}: {amount(len(capture.cameras), 'camera')}, {filmed}")


def run() -> None:
    """Entry point of the command."""
    run_commands("Captures: images of a person from calibrated cameras.", check, describe, poses)


class _Given(NamedTuple):
    """What every layout may be given beside its folder."""

    template: Path | None
    motion: Path | None
    rate: float | None
    height: float | None
    leave_out: tuple[str, ...]


def _described(source: Path, folder: Path, given: _Given) -> "Capture":
    """The capture that a folder of another layout is."""
    from mua.capture.readers.avatarrex import RATE, is_avatarrex, read_avatarrex
    from mua.capture.readers.calibrations import calibration_in
    from mua.capture.readers.calibrations.refused import refuse_others
    from mua.capture.readers.streams import is_streams, read_streams

    if is_avatarrex(source):
        if given.motion is not None:
            raise InputError(f"--motion {given.motion}: {source} has poses of its own; leave the option out")
        if given.template is None:
            raise InputError(f"{source}: holds no rigged character; give one on SMPL-X with --template")
        return read_avatarrex(
            source,
            folder,
            template=given.template,
            rate=given.rate or RATE,
            height=given.height,
            leave_out=given.leave_out,
        )
    if not is_streams(source):
        if found := calibration_in(source):
            raise InputError(
                f"{source}: give its cameras with --calibration {found}, the person with --template, and the poses "
                "with --motion"
            )
        refuse_others(source)
        raise InputError(
            f"{source}: its layout is not known; expected calibration_full.json or calibration.json with "
            "smpl_params.npz, or videos stream*.mp4 with cameras.calib or a .calibration file"
        )
    return read_streams(source, folder, **given._asdict())


def _calibrated(source: Path, folder: Path, calibration: Path, given: _Given, *, axes: str, scale: float) -> "Capture":
    """The capture of a folder whose cameras a public tool calibrated."""
    from mua.capture.conventions import read_axes
    from mua.capture.readers.calibrated_folder import read_calibrated

    if given.template is None or given.motion is None:
        raise InputError(f"--calibration {calibration}: expected --template and --motion with it")
    axes_of = read_axes(axes)
    return read_calibrated(source, folder, calibration=calibration, axes=axes_of, scale=scale, **given._asdict())


def _require_picture(output: Path) -> None:
    if output.suffix.lower() not in PICTURES:
        raise InputError(f"--output {output}: the suffix is {output.suffix or 'missing'}, expected .png or .jpg")
    require_writable(output)


def _show(console: Console, checked: "Checked") -> None:
    table = Table("camera", "size", "field of view", "distance", "overlap", "least", "", box=SIMPLE_HEAD)
    for fit in checked.cameras:
        table.add_row(*_row(fit))
    console.print(table)
    for note in checked.notes:
        say(console, note)
    for problem in checked.problems:
        say(console, f"problem: {problem}")
    if not checked.problems:
        say(console, "Nothing was found that cannot be right.")
    for remark in checked.remarks:
        say(console, f"remark: {remark}")


def _row(fit: "CameraFit") -> tuple[str, ...]:
    camera, least = fit.camera, fit.least
    return (
        camera.name,
        f"{camera.size[0]} x {camera.size[1]}",
        f"{camera.field_of_view:.0f}°",
        "" if fit.distance is None else f"{fit.distance:.2f} m",
        "" if fit.mean is None else f"{fit.mean:.0%}",
        "" if least is None else f"{least.overlap:.0%} ({least.clip}, frame {least.frame})",
        "held out" if camera.held_out else "",
    )


if __name__ == "__main__":
    run()
