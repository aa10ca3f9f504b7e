"""mua-bake: a rigged character and its motion become a verified `.muaavatar`."""

from pathlib import Path
from typing import Annotated

import typer

from mua.asset.tensors import Storage
from mua.baking.options import read_order
from mua.baking.order import DeviceName
from mua.cli.console import printer
from mua.cli.failure import refusing
from mua.cli.offered import offered
from mua.errors import InputError
from mua.motion.planted_feet import Feet
from mua.rig.detail import UvMode
from mua.student.settings import PRESETS, RECIPES


def main(
    character: Annotated[
        Path | None,
        typer.Argument(help="Rigged character: .glb, .gltf, .vrm, .usd* or .usdz; none: the procedural one."),
    ] = None,
    motion: Annotated[
        list[Path], typer.Option(help="Motion file or directory, may be repeated; none: the character's own clips.")
    ] = [],  # noqa: B006 typer copies it
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")] = Path("avatar.muaavatar"),
    preset_name: Annotated[
        str, offered(tuple(PRESETS), "--preset", help="How large the student is; paper wants a GPU.")
    ] = "preview",
    frames: Annotated[
        int | None,
        typer.Option(help="Training frames to record, and a quarter as many held-out ones; the preset's if left out."),
    ] = None,
    texels: Annotated[int | None, typer.Option(help="Texels along a side; the preset's if left out.")] = None,
    hold_out: Annotated[
        list[str], typer.Option(help="Clip to keep from training, may be repeated; none: the end of every clip.")
    ] = [],  # noqa: B006 typer copies it
    clips: Annotated[
        list[str],
        typer.Option(help="Clip that the file holds for playback, may be repeated; or all, none, or how many."),
    ] = ["all"],  # noqa: B006 typer copies it
    leave_out: Annotated[
        list[str],
        typer.Option(help="Mesh, node or material of the file that is no part of the character, may be repeated."),
    ] = [],  # noqa: B006 typer copies it
    mapping: Annotated[Path | None, typer.Option(help="JSON or TOML: target joint to source joint.")] = None,
    feet: Annotated[
        Feet,
        typer.Option(help="Hold feet where the motion's feet stand: where they would slide, never, or always."),
    ] = "auto",
    uv: Annotated[UvMode, typer.Option(help="What becomes of the character's UVs.")] = "auto",
    detail: Annotated[
        list[str],
        typer.Option(
            help="How much finer to draw a part, as head=2; may be repeated: head, hands, arms, body, legs or feet."
        ),
    ] = [],  # noqa: B006 typer copies it
    scale: Annotated[float | None, typer.Option(help="Multiplies the units of the character's file.")] = None,
    height: Annotated[float | None, typer.Option(help="Metres that the character is made high.")] = None,
    recipe: Annotated[
        str,
        offered(
            RECIPES,
            "--recipe",
            help="How the student is trained; paper: a random start and a million steps, for comparison.",
        ),
    ] = "closed-form",
    storage: Annotated[Storage, typer.Option(help="Element type of bases, static offset and weights.")] = "f16",
    seed: Annotated[int, typer.Option(help="Of every random choice.")] = 0,
    device: Annotated[DeviceName, typer.Option(help="Where the student is trained.")] = "auto",
    jobs: Annotated[
        int | None, typer.Option(help="Processes that record side by side; as many as there are cores if left out.")
    ] = None,
    work: Annotated[Path | None, typer.Option(help="Work directory; beside the output if left out.")] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Only compare splats and motion with their sources, in seconds.")
    ] = False,
    json: Annotated[Path | None, typer.Option(help="With --check: file for every figure.")] = None,
) -> None:
    """Record a teacher, distil it and write a .muaavatar, with a table of errors and a contact sheet beside it.

    A run that was interrupted goes on where it stopped when the same command is given again.
    """
    if json is not None and not check:
        raise InputError("--json: is written by --check alone")
    order = read_order(
        character,
        motion=motion,
        output=output,
        preset=preset_name,
        frames=frames,
        texels=texels,
        hold_out=hold_out,
        clips=clips,
        leave_out=leave_out,
        mapping=mapping,
        feet=feet,
        uv=uv,
        detail=detail,
        scale=scale,
        height=height,
        recipe=recipe,
        storage=storage,
        seed=seed,
        device=device,
        jobs=jobs,
        work=work,
    )
    if check:
        from mua.cli.check import check_and_show

        check_and_show(order, json)
        return

    from mua.baking.pipeline import bake  # seconds of loading: only once the options are known to be good
    from mua.cli.display import Display, show

    console = printer()
    with Display(console) as display:
        baked = bake(order, display)
    show(console, baked)


def run() -> None:
    """Entry point of the command."""
    refusing(main)
