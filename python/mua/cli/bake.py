"""mua-bake: a rigged character and its motion become a verified `.muaavatar`."""

from pathlib import Path
from typing import Annotated, Any

import typer

from mua.atlas.detail import UvMode
from mua.baking.bake import bake as mua_bake
from mua.baking.options import read_order
from mua.baking.order import MotionRange
from mua.cli.console import printer
from mua.cli.failure import run_command
from mua.cli.options import in_panels, lent_by
from mua.cli.training_options import BOTH
from mua.errors import InputError
from mua.motion.planted_feet import Feet

# Of each argument of mua.bake what a terminal takes, and its help; names and defaults are those of mua.bake.
OPTIONS = {
    "character": Annotated[
        Path | None,
        typer.Argument(
            help="Rigged character: .glb, .gltf, .vrm, .usd, .usda, .usdc, .usdz or .character; "
            "or the folder of a capture.",
            show_default="a built-in procedural character",
        ),
    ],
    "teacher": Annotated[
        Path | None,
        typer.Option(help="Folder that mua-teach wrote, to distil instead of a character.", show_default="none"),
    ],
    "motion": Annotated[
        list[Path],
        typer.Option(
            help="Motion file, or directory of motion files; may be repeated. Where a capture is given, its own motion "
            "is recorded too.",
            show_default="the character's own clips",
        ),
    ],
    "output": BOTH["output"],
    "preset": BOTH["preset"],
    "frames": Annotated[
        int | None,
        typer.Option(
            help="Number of training frames to record; a quarter as many held-out frames are added.",
            show_default="set by the preset",
        ),
    ],
    "texels": Annotated[
        int | None,
        typer.Option(help="Width and height of the texture, in texels.", show_default="set by the preset"),
    ],
    "hold_out": Annotated[
        list[str],
        typer.Option(
            help="Clip to keep out of training, to measure errors on; may be repeated.",
            show_default="the end of every clip",
        ),
    ],
    "clips": BOTH["clips"],
    "leave_out": Annotated[
        list[str],
        typer.Option(help="Mesh, node or material of the character file to leave out; may be repeated."),
    ],
    "mapping": Annotated[
        Path | None,
        typer.Option(
            help="JSON or TOML file that gives, for joints of the character, the joint of the motion.",
            show_default="matched by name",
        ),
    ],
    "feet": Annotated[
        Feet,
        typer.Option(
            help="Whether standing feet are held in place: auto (if they would slide), keep (never) or plant (always)."
        ),
    ],
    "motion_range": Annotated[
        MotionRange,
        typer.Option(
            help="Whether a built-in range of motion is trained on beside the character's motion: full or none."
        ),
    ],
    "uv": Annotated[UvMode, typer.Option(help="Keep the character's UVs, unwrap new ones, or choose automatically.")],
    "detail": Annotated[
        list[str],
        typer.Option(
            help="Resolution of a body part relative to the others, such as head=2; may be repeated. "
            "Parts: head, hands, arms, body, legs, feet."
        ),
    ],
    "scale": Annotated[float | None, typer.Option(help="Factor by which to multiply the size in the character file.")],
    "height": Annotated[float | None, typer.Option(help="Height to scale the character to, in metres.")],
    "recipe": BOTH["recipe"],
    "storage": BOTH["storage"],
    "seed": BOTH["seed"],
    "device": BOTH["device"],
    "jobs": Annotated[
        int | None, typer.Option(help="Number of processes that record.", show_default="one per CPU core")
    ],
    "work": Annotated[
        Path | None,
        typer.Option(help="Directory for the recording and checkpoints.", show_default="beside the output"),
    ],
}
PANELS = {
    "Character": ("scale", "height", "leave_out", "uv", "detail"),
    "Motion": ("mapping", "feet", "motion_range", "hold_out", "clips"),
    "Training": ("frames", "texels", "recipe", "storage", "seed", "device", "jobs", "work"),
}


@lent_by(mua_bake, in_panels(OPTIONS, PANELS))
def main(
    *,
    check: Annotated[
        bool, typer.Option("--check", help="Train nothing; in seconds, compare splats and motion with their sources.")
    ] = False,
    json: Annotated[Path | None, typer.Option(help="With --check: JSON file to write all figures to.")] = None,
    **options: Any,
) -> None:
    """Bake a rigged character and its motion into a .muaavatar file.

    A table of errors and a contact sheet are written beside it. To resume an interrupted run, give the same command
    again.
    """
    if json is not None and not check:
        raise InputError("--json: only --check writes it; expected --check too")
    order = read_order(options)
    if check and (order.teacher or order.lessons):
        raise InputError("--check: compares a character with its file; look at a capture with mua-capture check")
    if check:
        from mua.cli.check import check_and_show

        check_and_show(order, json)
        return

    from mua.baking.pipeline import bake  # after the options are checked, because it takes seconds to load
    from mua.cli.display import Display, show

    console = printer()
    with Display(console) as display:
        baked = bake(order, display)
    show(console, baked)


def run() -> None:
    """Entry point of the command."""
    run_command(main)


if __name__ == "__main__":
    run()
