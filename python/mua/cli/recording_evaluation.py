"""The comparison that mua-eval makes with a teacher's recording, once its options are known to be good."""

from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

from mua.cli.console import printer
from mua.cli.display import Display
from mua.errors import InputError
from mua.evaluation import entries, plots, report, scores
from mua.evaluation.images import Studio
from mua.evaluation.settings import EvaluationSettings
from mua.files.lock import DirectoryLock
from mua.files.write import replacing, write_bytes
from mua.gpu import Device, open_device
from mua.recording import Recording
from mua.splatting.perceptual import Lpips


def compare(settings: EvaluationSettings) -> None:
    """Compare what the settings name, and write and print the results."""
    recording = Recording(settings.recording)
    chosen = scores.choose_frames(recording, settings.frames)
    if not chosen:
        raise InputError(
            f"recording {settings.recording}: no frame is kept whole, expected at least one to compare with"
        )
    lpips = Lpips(settings.lpips_weights) if settings.lpips_weights is not None else None
    console = printer()
    output, size = settings.output, settings.size
    with closing(open_device(settings.device)) as opened, Display(console) as display:
        studio = Studio(opened, recording.rig, chosen, views=settings.views, size=size)
        rows = [entries.mean_entry(recording)]
        rows += _avatars(opened, settings.avatars, recording, size=size, own_mesh=settings.own_mesh, display=display)
        if settings.system:
            from mua_research.recorded_systems import system_entries  # because only a checkout has it

            with DirectoryLock(output / "work", name=f"-o {output}"):
                rows += system_entries(settings, recording, output / "work", display)
        display.stage("images")
        results = scores.score(studio, chosen, rows, lpips=lpips, progress=display.step)
        setting = report.Setting(
            recording=settings.recording.name,
            device=str(opened.adapter),
            frames={kind: sum(f.clip.held_out == held for f in chosen) for kind, held in scores.KINDS.items()},
            views=settings.views,
            size=size,
            seconds=settings.seconds if settings.steps is None else None,
            steps=settings.steps,
            preset=settings.preset,
            lpips=None if lpips is None else lpips.network,
            covered=sum(s.covered for s in results[0].samples) / max(len(results[0].samples), 1),
        )
        written = _write(output, results, setting)
        display.stage("contact sheets")
        for kind, held_out in scores.KINDS.items():
            picked = plots.sheet_frames(chosen, results, held_out=held_out)
            if picked:
                written.append(f"{kind.replace(' ', '_')}.png")
                with replacing(output / written[-1]) as temporary:
                    plots.contact_sheet(studio, picked, results).save(temporary)
    console.print(report.tables(results, setting))
    console.print(f"{output}: {', '.join(written)}", highlight=False, soft_wrap=True, markup=False)


def _avatars(
    device: Device, paths: Sequence[Path], recording: Recording, *, size: int, own_mesh: bool, display: Display
) -> list[entries.Entry]:
    """The rows of the files; what is wrong with one ends the command, before anything is trained."""
    rows: list[entries.Entry] = []
    for path in paths:
        display.stage(path.name)
        rows += entries.avatar_entries(device, path, recording.rig, size=size, played=own_mesh)
    return rows


def _write(output: Path, results: list[scores.Result], setting: report.Setting) -> list[str]:
    """Write all figures, each file atomically; returns the names of the files."""
    contents = {
        "results.md": report.markdown(results, setting).encode(),
        "results.csv": report.as_csv(results).encode(),
        "results.json": report.as_json(results, setting).encode(),
        "error_by_frame.png": plots.error_by_frame(results),
        "rate_distortion.png": plots.rate_distortion(results),
    }
    for name, content in contents.items():
        write_bytes(output / name, content)
    return list(contents)
