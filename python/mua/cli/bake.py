"""mua-bake: a rigged character and its motion become a verified `.muaavatar`."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from mua.cli.bake_options import check_inputs, check_jobs, check_output, check_settings
from mua.cli.console import printer
from mua.cli.failure import refusing
from mua.cli.offered import offered
from mua.errors import InputError
from mua.motion.mapping import read_mapping
from mua.rig.detail import read_detail
from mua.rig.figure_size import FigureSize
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
        Literal["auto", "keep", "plant"],
        typer.Option(help="Hold feet where the motion's feet stand: where they would slide, never, or always."),
    ] = "auto",
    uv: Annotated[
        Literal["keep", "unwrap", "auto"], typer.Option(help="What becomes of the character's UVs.")
    ] = "auto",
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
    storage: Annotated[
        Literal["f32", "f16", "i8"], typer.Option(help="Element type of bases, static offset and weights.")
    ] = "f16",
    seed: Annotated[int, typer.Option(help="Of every random choice.")] = 0,
    device: Annotated[Literal["auto", "cpu", "cuda"], typer.Option(help="Where the student is trained.")] = "auto",
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
    settings = check_settings(preset_name, recipe, seed=seed, frames=frames, texels=texels)
    work = output.with_suffix(".work") if work is None else work
    finer = read_detail(detail, uv=uv)
    check_inputs(character, motion)
    jobs = check_jobs(jobs)
    made = check_output(output, work)
    if json is not None and not check:
        raise InputError("--json: is written by --check alone")
    joints = None if mapping is None else read_mapping(mapping)
    size = FigureSize(scale=scale, height=height)

    if check:
        from mua.baking.check import CheckOrder
        from mua.cli.check import check_and_show

        looked_at = CheckOrder(
            output, settings.texels, seed, character, tuple(motion), joints, uv, finer, size, tuple(leave_out), feet
        )
        check_and_show(looked_at, json)
        return

    from mua.baking.pipeline import Order, bake  # seconds of loading: only once the options are known to be good
    from mua.baking.report import STAND_IN
    from mua.cli.display import Display, choose_device, show

    order = Order(
        output=output,
        work=work,
        settings=settings,
        character=character,
        motions=tuple(motion),
        hold_out=tuple(hold_out),
        clips=tuple(clips),
        mapping=joints,
        feet=feet,
        leave_out=tuple(leave_out),
        uv=uv,
        detail=finer,
        size=size,
        storage=storage,
        jobs=jobs,
        device=choose_device(device),
    )
    console = printer()
    with Display(console) as display:
        for directory in made:
            display.note(f"There is no directory {directory}: it is made.")
        baked = bake(order, display)
    show(console, baked, teacher=STAND_IN)


def run() -> None:
    """Entry point of the command."""
    refusing(main)
