"""mua-train: a recording becomes a verified `.muaavatar`."""

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from mua.baking.train import train
from mua.cli.console import printer
from mua.cli.display import Display, show
from mua.cli.failure import run_command
from mua.cli.options import command_options, lent_by
from mua.files.inputs import require_recording


@lent_by(train, command_options(train))
def main(
    *,
    check: Annotated[
        bool,
        typer.Option("--check", help="Train nothing; report what the recording holds and draw three of its frames."),
    ] = False,
    **options: Any,
) -> None:
    """Train an avatar on RECORDING and write it as a .muaavatar file.

    A table of errors and a contact sheet are written beside it. Texture size and frames are those of the recording.
    To resume an interrupted run, give the same command again. Start it with torchrun to train in several processes.
    """
    if check:
        _check(options["recording"], options["output"])
        return
    console = printer(quiet=os.environ.get("RANK", "0") != "0")  # of several processes, only the first prints
    with Display(console) as display:
        baked = train(**options, listener=display)
    if baked is not None:
        show(console, baked)


def _check(recording: Path, output: Path) -> None:
    require_recording(recording)  # first, because loading takes seconds
    from mua.cli.check_recording import check_recording
    from mua.recording import Recording

    check_recording(Recording(recording), output.with_name(output.stem + "_check.png"))


def run() -> None:
    """Entry point of the command."""
    run_command(main)


if __name__ == "__main__":
    run()
