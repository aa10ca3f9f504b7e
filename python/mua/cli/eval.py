"""mua-eval: compares avatars and the systems of the paper's tables on a recording."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from mua.cli.choice import choice
from mua.cli.failure import run_command
from mua.cli.options import lent_by
from mua.errors import InputError
from mua.evaluation.order import ALL, SYSTEM_NAMES, EvaluationOrder
from mua.extras import require_research
from mua.files.inputs import is_capture, require_file, require_recording, require_teacher
from mua.student.settings import PRESETS, preset

# Of each field of an order what a terminal takes, and its help.
OPTIONS = {
    "recording": Annotated[Path, typer.Argument(metavar="RECORDING", help="Directory of a recording or a capture.")],
    "avatars": Annotated[list[Path], typer.Argument(help="Avatar files trained on it.")],
    "teacher": Annotated[
        Path | None,
        typer.Option(help="Folder that mua-teach wrote, where RECORDING is a capture.", show_default="none"),
    ],
    "train_on": Annotated[
        Path | None,
        typer.Option(
            help="Recording of the teacher to train systems on, as mua-bake leaves it in its work directory.",
            show_default="made of the capture's own poses",
        ),
    ],
    "system": Annotated[
        list[str],
        choice((ALL, *SYSTEM_NAMES), "--system", help="System to train and compare; may be repeated", several=True),
    ],
    "scale": Annotated[
        list[float],
        typer.Option(
            min=0.01,
            max=100.0,
            help="Size of the systems relative to the preset's, where RECORDING is a capture; may be repeated, for a "
            "curve of quality against cost.",
            show_default="1",
        ),
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
    "size": Annotated[int, typer.Option(help="Width and height of the rendered images, in pixels.")],
    "own_mesh": Annotated[bool, typer.Option(help="Also draw each avatar file on its own predicted mesh.")],
    "lpips_weights": Annotated[
        Path | None, typer.Option(help="Weights of torchvision's AlexNet or VGG16, to measure LPIPS.")
    ],
    "seed": Annotated[int, typer.Option(help="Seed of all random numbers.")],
    "device": Annotated[str | None, typer.Option(help="Graphics device: its number or part of its name.")],
    "output": Annotated[Path, typer.Option("--output", "-o", help="Directory to write to.")],
    "images": Annotated[
        Path | None,
        typer.Option(
            help="Folder to write every image that was measured to: the captured one, the teacher's and the avatars', "
            "as clip/camera/frame_name.png; where RECORDING is a capture.",
            show_default="none",
        ),
    ],
}


@lent_by(EvaluationOrder, OPTIONS)
def evaluate(**options: Any) -> None:
    """Compare avatar files and other systems with the teacher of RECORDING, in tables, plots and contact sheets.

    Where RECORDING is the folder of a capture, a --teacher, avatar files and systems trained on that teacher are
    compared with its images instead, by the cameras and in the clips that are held out. Every system is also trained
    at the largest size that costs at most as much as ours.

    Trained systems are kept in the directory 'work' of the output; the same command does not train them again.
    """
    order = EvaluationOrder(**options)
    _check_names(order.system)
    filmed = is_capture(order.recording)
    if filmed:
        _check_filmed(order)
    else:
        require_recording(order.recording)
        if order.scale:
            raise InputError(f"--scale {order.scale[0]:g}: only applies to a comparison with the images of a capture")
        if order.train_on is not None:
            raise InputError(f"--train-on {order.train_on}: only applies to a comparison with the images of a capture")
        if order.images is not None:
            raise InputError(f"--images {order.images}: only applies to a comparison with the images of a capture")
        if order.teacher is not None:
            raise InputError(
                f"--teacher {order.teacher}: can only be compared with the images of a capture, not with a recording"
            )
    for file in (*order.avatars, *(() if order.lpips_weights is None else (order.lpips_weights,))):
        require_file(file)
    preset(order.preset)
    if order.system:
        require_research(f"--system {order.system[0]}")
    if filmed:
        from mua.cli.filmed_evaluation import compare as compare_filmed

        compare_filmed(order)
        return

    from mua.cli.evaluation import compare  # after the options are checked, because it takes seconds to load

    compare(order)


def _check_names(systems: Sequence[str]) -> None:
    """Raises InputError for a name that is no system's."""
    for name in systems:
        if name not in (ALL, *SYSTEM_NAMES):
            raise InputError(f"--system {name}: expected one of {', '.join((ALL, *SYSTEM_NAMES))}")


def _check_filmed(order: EvaluationOrder) -> None:
    """Raises InputError for what cannot be compared with images."""
    if order.system and order.teacher is None:
        raise InputError(f"--system {order.system[0]}: learns from a teacher; give its folder with --teacher")
    if order.scale and not order.system:
        raise InputError(f"--scale {order.scale[0]:g}: is the size of a --system, and none is given")
    if order.train_on is not None:
        if not order.system:
            raise InputError(f"--train-on {order.train_on}: is what a --system is trained on, and none is given")
        require_recording(order.train_on)
    if order.teacher is None and not order.avatars:
        raise InputError("give a --teacher or avatar files to compare with the images of the capture")
    if order.teacher is not None:
        require_teacher(order.teacher)


def run() -> None:
    """Entry point of the command."""
    run_command(evaluate)


if __name__ == "__main__":
    run()
