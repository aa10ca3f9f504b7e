"""mua-eval: compares avatars and the systems of the paper's tables on a recording."""

from pathlib import Path
from typing import Annotated

import typer

from mua.cli.choice import choice
from mua.cli.failure import run_command
from mua.compare.names import ALL, SYSTEM_NAMES
from mua.inputs import require_file, require_recording
from mua.student.settings import PRESETS, preset


def evaluate(
    recording_path: Annotated[Path, typer.Argument(metavar="RECORDING", help="Directory of the recording.")],
    avatars: Annotated[list[Path] | None, typer.Argument(help="Avatar files trained on it.")] = None,
    system: Annotated[
        list[str] | None,
        choice((ALL, *SYSTEM_NAMES), "--system", help="System to train and compare; may be repeated", several=True),
    ] = None,
    seconds: Annotated[float, typer.Option(min=0.0, help="Training time of each system, in seconds.")] = 60.0,
    steps: Annotated[
        int | None,
        typer.Option(min=1, help="Training steps of each system, instead of --seconds; makes the result reproducible."),
    ] = None,
    preset_name: Annotated[
        str, choice(tuple(PRESETS), "--preset", help="Preset that sets the sizes of the systems.")
    ] = "preview",
    frames: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Number of training frames, and of held-out frames, to compare.",
            show_default="all whole frames",
        ),
    ] = None,
    views: Annotated[int, typer.Option(help="Number of cameras around the figure.")] = 2,
    size: Annotated[int, typer.Option(help="Width and height of the pictures in pixels.")] = 512,
    own_mesh: Annotated[bool, typer.Option(help="Also draw each avatar file on its own predicted mesh.")] = False,
    lpips_weights: Annotated[
        Path | None, typer.Option(help="Weights of torchvision's AlexNet or VGG16, to measure LPIPS.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of all random numbers.")] = 0,
    device: Annotated[str | None, typer.Option(help="Graphics device: its number or part of its name.")] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="Directory to write to.")] = Path("evaluation"),
) -> None:
    """Compare avatar files and other systems with the teacher of RECORDING, in tables, plots and contact sheets.

    Trained systems are kept in the directory 'work' of the output; the same command does not train them again.
    """
    require_recording(recording_path)
    for file in (*(avatars or ()), *(() if lpips_weights is None else (lpips_weights,))):
        require_file(file)
    preset(preset_name)

    from mua.cli.evaluation import (
        EvaluationOrder,
        compare,
    )  # after the options are checked, because it takes seconds to load

    order = EvaluationOrder(
        recording=recording_path,
        avatars=avatars or [],
        systems=system or [],
        seconds=seconds,
        steps=steps,
        preset=preset_name,
        frames=frames,
        views=views,
        size=size,
        own_mesh=own_mesh,
        lpips_weights=lpips_weights,
        seed=seed,
        device=device,
        output=output,
    )
    compare(order)


def run() -> None:
    """Entry point of the command."""
    run_command(evaluate)
