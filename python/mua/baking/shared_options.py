"""The options that mua.bake, mua.train and mua.teach have in common."""

from collections.abc import Sequence
from typing import Annotated, Literal

from mua.arguments import PathLike
from mua.asset.tensors import Storage
from mua.channels import COARSE_TEXELS
from mua.option import Option
from mua.student.settings import PRESETS, RECIPES

DeviceName = Literal["auto", "cpu", "cuda"]

OutputOption = Annotated[PathLike, Option("Avatar file to write.", short="-o")]
PresetOption = Annotated[str, Option("Size of the student; paper needs a GPU.", choices=tuple(PRESETS))]
TexelsOption = Annotated[
    int | None,
    Option(
        "Width and height of the texture, in texels.",
        default="set by the preset",
        least=2 * COARSE_TEXELS,  # something must be left of a texture that is halved so many times
        multiple=COARSE_TEXELS,
    ),
]
MflopOption = Annotated[
    float | None,
    Option(
        "Most operations of a frame, in millions: the largest measured size of the student within it is taken.",
        default="set by the preset",
        least=1,
    ),
]
MegabytesOption = Annotated[
    float | None,
    Option(
        "Largest file without its clips, in megabytes as f16 (as f32 with --storage f32); i8 and packed are smaller.",
        default="set by the preset",
        least=0.1,
    ),
]
ClipsOption = Annotated[
    str | int | Sequence[str],
    Option("Clip to store for playback; may be repeated. Also: all, none, or a number of clips."),
]
RecipeOption = Annotated[
    str,
    Option(
        "How to train: closed-form starts from least squares, paper from random weights with a million steps.",
        choices=RECIPES,
    ),
]
StorageOption = Annotated[Storage, Option("Number type of the stored bases and weights; packed is for the network.")]
SeedOption = Annotated[int, Option("Seed of all random numbers.", least=0)]
DeviceOption = Annotated[DeviceName, Option("Where to train the student.")]
