"""The options that mua-bake and mua-train both have."""

from pathlib import Path
from typing import Annotated

import typer

from mua.asset.tensors import Storage
from mua.baking.order import DeviceName
from mua.cli.choice import choice
from mua.student.settings import PRESETS, RECIPES

BOTH = {
    "output": Annotated[Path, typer.Option("--output", "-o", help="Avatar file to write.")],
    "preset": Annotated[str, choice(tuple(PRESETS), "--preset", help="Size of the student; paper needs a GPU.")],
    "clips": Annotated[
        list[str],
        typer.Option(help="Clip to store for playback; may be repeated. Also: all, none, or a number of clips."),
    ],
    "recipe": Annotated[
        str,
        choice(
            RECIPES,
            "--recipe",
            help="How to train: closed-form starts from least squares, paper from random weights with a million steps.",
        ),
    ],
    "storage": Annotated[
        Storage, typer.Option(help="Number type of the stored bases and weights; packed is for the network.")
    ],
    "seed": Annotated[int, typer.Option(help="Seed of all random numbers.")],
    "device": Annotated[DeviceName, typer.Option(help="Where to train the student.")],
}
