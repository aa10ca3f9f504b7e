"""mua-capture: whether a capture is what it should be, before a teacher is trained on it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from mua.cli.console import printer, say
from mua.cli.failure import run_commands
from mua.errors import InputError
from mua.files import replacing, require_writable
from mua.inputs import require_capture

if TYPE_CHECKING:  # takes long to load
    from mua.capture.check import CameraFit, Checked

PICTURES = (".png", ".jpg", ".jpeg")


def check(
    folder: Annotated[Path, typer.Argument(help="Folder of the capture; it holds a capture.json.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Picture to write: the template's outline over some of the views."),
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


def run() -> None:
    """Entry point of the command."""
    run_commands("Captures: pictures of a person by calibrated cameras.", check)


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
