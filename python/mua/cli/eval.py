"""mua-eval: the paper's tables on a recording of yours, drawn by the project's player."""

from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import torch
import typer
from rich.console import Console

from mua.cli.display import Display
from mua.cli.failure import refusing
from mua.errors import InputError
from mua.files import replacing, write_bytes
from mua.gpu import Device, open_device
from mua.locks import DirectoryLock
from mua.recording import Recording
from mua.student.checkpoint import Checkpoints, run_key
from mua.student.optimise import Progress, Run
from mua.student.settings import Settings, preset

try:
    from mua.compare import entries, judge, plots, report
    from mua.compare.images import Studio
    from mua.compare.metrics import Lpips
    from mua.compare.system import Budget
except ModuleNotFoundError as missing:  # pragma: no cover
    raise SystemExit(f"error: mua-eval needs {missing.name}: pip install 'mua[eval]'") from missing


def evaluate(
    recording_path: Annotated[Path, typer.Argument(metavar="RECORDING", help="Directory of a recording.")],
    avatars: Annotated[list[Path] | None, typer.Argument(help="Avatar files distilled from it.")] = None,
    system: Annotated[
        list[str] | None, typer.Option(help="A system of the paper's tables to train, may be repeated; or all.")
    ] = None,
    seconds: Annotated[float, typer.Option(min=0.0, help="Training of each system.")] = 60.0,
    steps: Annotated[
        int | None, typer.Option(min=1, help="Of Adam for each system, instead of seconds: the same bytes each time.")
    ] = None,
    preset_name: Annotated[str, typer.Option("--preset", help="Whose sizes the systems have.")] = "preview",
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
    recording = Recording(recording_path)
    chosen = judge.choose_frames(recording, frames)
    if not chosen:
        raise InputError(f"recording {recording_path}: no frame is kept whole, expected at least one to compare with")
    names = list(entries.SYSTEMS) if system == ["all"] else list(dict.fromkeys(system or []))
    entries.check_systems(names)
    settings = replace(preset(preset_name), texels=recording.rig.texels.size, seed=seed)
    budget = Budget(seconds=seconds) if steps is None else Budget(steps=steps)
    lpips = Lpips(lpips_weights) if lpips_weights is not None else None
    console = Console()
    with closing(open_device(device)) as opened, Display(console) as display:
        studio = Studio(opened, recording.rig, chosen, views=views, size=size)
        rows = [entries.mean_entry(recording)]
        rows += _avatars(opened, avatars or [], recording, size=size, own_mesh=own_mesh, display=display)
        if names:
            with DirectoryLock(output / "work", name=f"-o {output}"):
                rows += _systems(names, recording, settings, budget=budget, work=output / "work", display=display)
        display.stage("pictures")
        results = judge.judge(studio, chosen, rows, lpips=lpips, progress=display.step)
        setting = report.Setting(
            recording=recording_path.name,
            device=str(opened.adapter),
            frames={kind: sum(f.clip.held_out == held for f in chosen) for kind, held in judge.KINDS.items()},
            views=views,
            size=size,
            seconds=budget.seconds,
            steps=budget.steps,
            preset=preset_name,
            lpips=None if lpips is None else lpips.network,
            covered=sum(s.covered for s in results[0].samples) / max(len(results[0].samples), 1),
        )
        _write(output, results, setting)
        display.stage("contact sheets")
        for kind, held_out in judge.KINDS.items():
            picked = plots.sheet_frames(chosen, results, held_out=held_out)
            if picked:
                with replacing(output / f"{kind.replace(' ', '_')}.png") as temporary:
                    plots.contact_sheet(studio, picked, results).save(temporary)
    console.print(report.table(results, setting))
    console.print(output, highlight=False)


def run() -> None:
    """Entry point of the command."""
    refusing(evaluate)


def _avatars(
    device: Device, paths: list[Path], recording: Recording, *, size: int, own_mesh: bool, display: Display
) -> list[entries.Entry]:
    """The rows of the files; what is wrong with one ends the command, before anything is trained."""
    rows: list[entries.Entry] = []
    for path in paths:
        display.stage(path.name)
        rows += entries.avatar_entries(device, path, recording.rig, size=size, played=own_mesh)
    return rows


def _systems(
    names: list[str], recording: Recording, settings: Settings, *, budget: Budget, work: Path, display: Display
) -> list[entries.Entry]:
    """Train one system after the other; those that the work directory holds are taken from there."""
    generator = torch.Generator().manual_seed(settings.seed)
    checkpoints = Checkpoints(work, run_key((settings, recording.fingerprint(), budget.seconds, budget.steps), []))
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")

    def step(progress: Progress) -> None:
        loss = "" if progress.loss is None else f"loss {progress.loss:.4f}"
        display.step(progress.step, progress.steps, detail=loss)

    display.stage("coarse mesh")
    frames = entries.prepare_systems(recording, settings, run=Run(generator, checkpoints, step, device))
    rows = []
    for name in names:
        display.stage(name)
        rows.append(entries.system_entry(name, recording, frames, budget=budget, checkpoints=checkpoints, report=step))
        if rows[-1].failure:
            display.note(f"{name}: {rows[-1].failure}")
    return rows


def _write(output: Path, results: list[judge.Result], setting: report.Setting) -> None:
    """All figures, each file whole or as it was."""
    contents = {
        "results.md": report.markdown(results, setting).encode(),
        "results.csv": report.as_csv(results).encode(),
        "results.json": report.as_json(results, setting).encode(),
        "error_by_frame.png": plots.error_by_frame(results),
        "rate_distortion.png": plots.rate_distortion(results),
    }
    for name, content in contents.items():
        write_bytes(output / name, content)
