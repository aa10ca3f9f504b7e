"""mua-train: a recording becomes a verified `.muaavatar`."""

import os
from pathlib import Path
from typing import Annotated

import typer

from mua.asset.tensors import Storage
from mua.baking.order import DeviceName
from mua.baking.train import train
from mua.cli.choice import choice
from mua.cli.console import printer
from mua.cli.display import Display, show
from mua.cli.failure import run_command
from mua.inputs import require_recording
from mua.student.settings import PRESETS, RECIPES, StageName


def main(
    recording: Annotated[Path, typer.Argument(help="Directory of a recording, as a TeacherWriter writes it.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Avatar file to write.")] = Path("avatar.muaavatar"),
    preset_name: Annotated[
        str, choice(tuple(PRESETS), "--preset", help="Size of the student; paper needs a GPU.")
    ] = "preview",
    recipe: Annotated[
        str,
        choice(
            RECIPES,
            "--recipe",
            help="How to train: closed-form starts from least squares, paper from random weights with a million steps.",
        ),
    ] = "closed-form",
    stage: Annotated[
        StageName | None,
        typer.Option(help="Run only this stage, up to its checkpoint.", show_default="all stages"),
    ] = None,
    clips: Annotated[
        list[str],
        typer.Option(help="Clip to store for playback; may be repeated. Also: all, none, or a number of clips."),
    ] = ["all"],  # noqa: B006 typer copies it
    storage: Annotated[Storage, typer.Option(help="Number type of the stored bases and weights.")] = "f16",
    seed: Annotated[int, typer.Option(help="Seed of all random numbers.")] = 0,
    device: Annotated[DeviceName, typer.Option(help="Where to train the student.")] = "auto",
    work: Annotated[
        Path | None, typer.Option(help="Directory for checkpoints.", show_default="beside the output")
    ] = None,
    check: Annotated[
        bool,
        typer.Option("--check", help="Train nothing; report what the recording holds and draw three of its frames."),
    ] = False,
) -> None:
    """Train an avatar on RECORDING and write it as a .muaavatar file.

    A table of errors and a contact sheet are written beside it. Texture size and frames are those of the recording.
    To resume an interrupted run, give the same command again. Start it with torchrun to train in several processes.
    """
    if check:
        _check(recording, output)
        return
    console = printer(quiet=os.environ.get("RANK", "0") != "0")  # of several processes, only the first prints
    with Display(console) as display:
        baked = train(
            recording,
            output=output,
            preset=preset_name,
            recipe=recipe,
            stage=stage,
            clips=clips,
            storage=storage,
            seed=seed,
            device=device,
            work=work,
            listener=display,
        )
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


if __name__ == "__main__":  # for torchrun -m
    run()
