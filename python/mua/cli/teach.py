"""mua-teach: the images of a capture become a teacher that mua-bake distils."""

import os
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

from mua.baking.order import DeviceName
from mua.baking.train_teacher import teach
from mua.cli.choice import choice
from mua.cli.console import printer, say
from mua.cli.display import Display
from mua.cli.failure import run_command
from mua.cli.options import lent_by
from mua.teachers.trained.settings import PRESETS, Rasteriser

# Of each argument of mua.teach what a terminal takes, and its help.
OPTIONS = {
    "capture": Annotated[Path, typer.Argument(metavar="CAPTURE", help="Folder of a capture; it holds a capture.json.")],
    "output": Annotated[Path, typer.Option("--output", "-o", help="Folder to write the teacher to.")],
    "preset": Annotated[
        str, choice(tuple(PRESETS), "--preset", help="Size of the teacher; small and paper are meant for a GPU.")
    ],
    "steps": Annotated[int | None, typer.Option(help="Number of training steps.", show_default="set by the preset")],
    "texels": Annotated[
        int | None,
        typer.Option(help="Width and height of the texture, in texels.", show_default="set by the preset"),
    ],
    "drivable": Annotated[
        bool, typer.Option("--drivable", help="Learn first how motion deforms the template, from meshes or masks.")
    ],
    "colour_correction": Annotated[
        bool,
        typer.Option(
            "--colour-correction/--no-colour-correction",
            help="Learn how cameras differ in colour; without, all are taken to show colours alike.",
        ),
    ],
    "refine": Annotated[
        float,
        typer.Option(
            help="Degrees by which each joint, and centimetres by which the root may be moved to fit the images "
            "better; 0 trusts the poses."
        ),
    ],
    "lpips_weights": Annotated[
        Path | None,
        typer.Option(
            help="Weights of torchvision's AlexNet or VGG16, for a perceptual term in the loss.", show_default="none"
        ),
    ],
    "rasteriser": Annotated[
        str,
        choice(get_args(Rasteriser), "--rasteriser", help="Rasteriser to train with; gsplat needs a GPU."),
    ],
    "seed": Annotated[int, typer.Option(help="Seed of all random numbers.")],
    "device": Annotated[DeviceName, typer.Option(help="Where to train.")],
}


@lent_by(teach, OPTIONS)
def main(**options: Any) -> None:
    """Train a teacher on the videos of CAPTURE: how a person's body and clothes look in any motion.

    Images of a camera that is held out are written to the folder 'progress' of the output while it trains. To resume
    an interrupted run, give the same command again. Start it with torchrun to train in several processes.
    """
    first = os.environ.get("RANK", "0") == "0"
    console = printer(quiet=not first)  # of several processes, only the first prints
    with Display(console) as display:
        folder = teach(**options, listener=display)
    say(console, f"{folder}: the teacher; mua-bake --teacher {folder} --motion FILES makes an avatar of it")


def run() -> None:
    """Entry point of the command."""
    run_command(main)


if __name__ == "__main__":
    run()
