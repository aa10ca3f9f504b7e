"""mua-eval: the paper's tables on a recording of yours, drawn by the project's player."""

from pathlib import Path
from typing import Annotated

import typer

from mua.cli.failure import refusing
from mua.cli.offered import offered
from mua.compare.names import ALL, SYSTEM_NAMES
from mua.inputs import require_file, require_recording
from mua.student.settings import PRESETS, preset


def evaluate(
    recording_path: Annotated[Path, typer.Argument(metavar="RECORDING", help="Directory of a recording.")],
    avatars: Annotated[list[Path] | None, typer.Argument(help="Avatar files distilled from it.")] = None,
    system: Annotated[
        list[str] | None,
        offered((ALL, *SYSTEM_NAMES), "--system", help="A system to train, may be repeated", several=True),
    ] = None,
    seconds: Annotated[float, typer.Option(min=0.0, help="Training of each system.")] = 60.0,
    steps: Annotated[
        int | None, typer.Option(min=1, help="Of Adam for each system, instead of seconds: the same bytes each time.")
    ] = None,
    preset_name: Annotated[str, offered(tuple(PRESETS), "--preset", help="Whose sizes the systems have.")] = "preview",
    frames: Annotated[int | None, typer.Option(min=1, help="Of each kind, evenly; all kept whole if left out.")] = None,
    views: Annotated[int, typer.Option(help="Cameras about the figure.")] = 2,
    size: Annotated[int, typer.Option(help="Pixels along a side of a picture.")] = 512,
    own_mesh: Annotated[bool, typer.Option(help="Also draw avatars on their own mesh, as a user sees them.")] = False,
    lpips_weights: Annotated[Path | None, typer.Option(help="torchvision's AlexNet or VGG16, for LPIPS.")] = None,
    seed: Annotated[int, typer.Option(help="Of every random choice.")] = 0,
    device: Annotated[str | None, typer.Option(help="Part of the name of a graphics device, or its number.")] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="Directory to write to.")] = Path("evaluation"),
) -> None:
    """Compare avatar files and systems with the teacher of RECORDING: table, plots and contact sheets.

    What was trained is kept in the output's directory work: the same command, given again, does not train it again.
    """
    require_recording(recording_path)
    for file in (*(avatars or ()), *(() if lpips_weights is None else (lpips_weights,))):
        require_file(file)
    preset(preset_name)

    from mua.cli.evaluation import EvaluationOrder, compare  # seconds of loading: only once the options are good

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
    refusing(evaluate)
