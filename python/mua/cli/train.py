"""mua-train: a recording becomes a verified `.muaavatar`."""

import os
from pathlib import Path
from typing import Annotated

import typer

from mua.asset.tensors import Storage
from mua.baking.order import DeviceName
from mua.baking.train import train
from mua.cli.console import printer
from mua.cli.display import Display, show
from mua.cli.failure import refusing
from mua.cli.offered import offered
from mua.inputs import require_recording
from mua.student.settings import PRESETS, RECIPES, StageName


def main(
    recording: Annotated[Path, typer.Argument(help="Directory that a TeacherWriter has written.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")] = Path("avatar.muaavatar"),
    preset_name: Annotated[
        str, offered(tuple(PRESETS), "--preset", help="How large the student is; paper wants a GPU.")
    ] = "preview",
    recipe: Annotated[
        str,
        offered(
            RECIPES,
            "--recipe",
            help="How the student is trained; paper: a random start and a million steps, for comparison.",
        ),
    ] = "closed-form",
    stage: Annotated[
        StageName | None, typer.Option(help="Run this stage alone, up to its checkpoint; all if left out.")
    ] = None,
    clips: Annotated[
        list[str],
        typer.Option(help="Clip that the file holds for playback, may be repeated; or all, none, or how many."),
    ] = ["all"],  # noqa: B006 typer copies it
    storage: Annotated[Storage, typer.Option(help="Element type of bases, static offset and weights.")] = "f16",
    seed: Annotated[int, typer.Option(help="Of every random choice.")] = 0,
    device: Annotated[DeviceName, typer.Option(help="Where the student is trained.")] = "auto",
    work: Annotated[Path | None, typer.Option(help="For checkpoints; beside the output if left out.")] = None,
    check: Annotated[
        bool,
        typer.Option("--check", help="Say what the recording holds, picture three of its frames, and train nothing."),
    ] = False,
) -> None:
    """Distil RECORDING into a .muaavatar, with a table of errors and a contact sheet beside it.

    Texture size and frames are the recording's. A run that was interrupted goes on where it stopped when the same
    command is given again. Under torchrun several processes train together.
    """
    if check:
        _check(recording, output)
        return
    console = printer(quiet=os.environ.get("RANK", "0") != "0")  # of several processes the first one reports
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
    require_recording(recording)  # before seconds of loading
    from mua.cli.check_recording import check_recording
    from mua.recording import Recording

    check_recording(Recording(recording), output.with_name(output.stem + "_check.png"))


def run() -> None:
    """Entry point of the command."""
    refusing(main)


if __name__ == "__main__":  # for torchrun -m
    run()
