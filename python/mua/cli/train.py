"""mua-train: a recording becomes a verified `.muaavatar`."""

from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from mua.asset.tensors import Storage
from mua.cli.console import printer
from mua.cli.display import Display, choose_device, show
from mua.cli.failure import refusing
from mua.cli.inputs import require_recording
from mua.cli.offered import offered
from mua.files import require_writable
from mua.locks import DirectoryLock
from mua.student.settings import PRESETS, RECIPES, StageName, preset, with_recipe

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.baking.distillation import Distillation
    from mua.processes import Processes
    from mua.recording import Recording


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
    device: Annotated[Literal["auto", "cpu", "cuda"], typer.Option(help="Where the student is trained.")] = "auto",
    work: Annotated[Path | None, typer.Option(help="For checkpoints; beside the output if left out.")] = None,
) -> None:
    """Distil RECORDING into a .muaavatar, with a table of errors and a contact sheet beside it.

    Texture size and frames are the recording's. A run that was interrupted goes on where it stopped when the same
    command is given again. Under torchrun several processes train together.
    """
    settings = with_recipe(replace(preset(preset_name), seed=seed), recipe)
    require_recording(recording)

    from mua.baking.distillation import Distillation  # seconds of loading: only once the options are known to be good
    from mua.baking.playback import choose, whole_clips
    from mua.baking.report import UNSAID
    from mua.processes import joined
    from mua.recording import Recording

    with joined() as processes:
        opened = Recording(recording)
        choose(whole_clips(opened.clips), clips)  # before hours of work
        order = Distillation(
            output=output,
            work=output.with_suffix(".work") if work is None else work,
            settings=replace(settings, texels=opened.rig.texels.size, frames=opened.count()),
            device=processes.place(choose_device(device)),
            name=output.stem,
            teacher=UNSAID,
            playback=tuple(clips),
            storage=storage,
            processes=processes,
        )
        with _alone(order):
            _carry_out(order, opened, stage, processes)


def run() -> None:
    """Entry point of the command."""
    refusing(main)


def _alone(order: "Distillation") -> AbstractContextManager[object]:
    """Keeps other commands out of the work directory; of processes that train together the first one does."""
    if not order.processes.first:
        return nullcontext()
    require_writable(order.output)
    return DirectoryLock(order.work, name=f"--work {order.work}")


def _carry_out(order: "Distillation", recording: "Recording", stage: StageName | None, processes: "Processes") -> None:
    from mua.baking.distillation import finish, teach, teach_stage

    console = printer(quiet=not processes.first)
    with Display(console) as display:
        if stage is not None:
            teach_stage(order, stage, recording, display)
            console.print(f"checkpoints are in {order.checkpoints}", highlight=False, soft_wrap=True)
            return
        student = teach(order, recording, display)
        if not processes.first:
            return
        baked = finish(order, student, recording, display)
    show(console, baked, teacher=order.teacher)


if __name__ == "__main__":  # for torchrun -m
    run()
