"""mua-eval: compares avatars and the systems of the paper's tables on a recording."""

from pathlib import Path
from typing import Annotated, Any

import typer

from mua.cli.choice import choice
from mua.cli.failure import run_command
from mua.cli.options import lent_by
from mua.compare.order import ALL, SYSTEM_NAMES, EvaluationOrder
from mua.inputs import require_file, require_recording
from mua.student.settings import PRESETS, preset

# Of each field of an order what a terminal takes, and its help.
OPTIONS = {
    "recording": Annotated[Path, typer.Argument(metavar="RECORDING", help="Directory of the recording.")],
    "avatars": Annotated[list[Path], typer.Argument(help="Avatar files trained on it.")],
    "system": Annotated[
        list[str],
        choice((ALL, *SYSTEM_NAMES), "--system", help="System to train and compare; may be repeated", several=True),
    ],
    "seconds": Annotated[float, typer.Option(min=0.0, help="Training time of each system, in seconds.")],
    "steps": Annotated[
        int | None,
        typer.Option(min=1, help="Training steps of each system, instead of --seconds; makes the result reproducible."),
    ],
    "preset": Annotated[str, choice(tuple(PRESETS), "--preset", help="Preset that sets the sizes of the systems.")],
    "frames": Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Number of training frames, and of held-out frames, to compare.",
            show_default="all whole frames",
        ),
    ],
    "views": Annotated[int, typer.Option(help="Number of cameras around the figure.")],
    "size": Annotated[int, typer.Option(help="Width and height of the pictures in pixels.")],
    "own_mesh": Annotated[bool, typer.Option(help="Also draw each avatar file on its own predicted mesh.")],
    "lpips_weights": Annotated[
        Path | None, typer.Option(help="Weights of torchvision's AlexNet or VGG16, to measure LPIPS.")
    ],
    "seed": Annotated[int, typer.Option(help="Seed of all random numbers.")],
    "device": Annotated[str | None, typer.Option(help="Graphics device: its number or part of its name.")],
    "output": Annotated[Path, typer.Option("--output", "-o", help="Directory to write to.")],
}


@lent_by(EvaluationOrder, OPTIONS)
def evaluate(**options: Any) -> None:
    """Compare avatar files and other systems with the teacher of RECORDING, in tables, plots and contact sheets.

    Trained systems are kept in the directory 'work' of the output; the same command does not train them again.
    """
    order = EvaluationOrder(**options)
    require_recording(order.recording)
    for file in (*order.avatars, *(() if order.lpips_weights is None else (order.lpips_weights,))):
        require_file(file)
    preset(order.preset)

    from mua.cli.evaluation import compare  # after the options are checked, because it takes seconds to load

    compare(order)


def run() -> None:
    """Entry point of the command."""
    run_command(evaluate)
