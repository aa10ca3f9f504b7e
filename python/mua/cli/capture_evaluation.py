"""The comparison that mua-eval makes with the images of a capture, once its options are known to be good."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from mua.arguments import amount
from mua.capture import Capture, open_capture
from mua.capture.store import ViewStore
from mua.cli.console import printer
from mua.cli.display import Display
from mua.errors import InputError
from mua.evaluation import capture_report, capture_scores
from mua.evaluation.settings import EvaluationSettings
from mua.files.lock import DirectoryLock
from mua.files.write import replacing, write_bytes
from mua.splatting.perceptual import Lpips


def compare(settings: EvaluationSettings) -> None:
    """Compare with the images of a capture what the settings name, and write and print the results."""
    capture = open_capture(settings.recording)
    chosen = capture_scores.shots(capture, settings.frames)
    lpips = Lpips(settings.lpips_weights) if settings.lpips_weights is not None else None
    template, work = capture.surfaces.skeleton, settings.output / "work"
    entries = [] if settings.teacher is None else capture_scores.teacher_entries(settings.teacher, template)
    entries += [capture_scores.avatar_entry(path, template) for path in settings.avatars]
    console = printer()
    with DirectoryLock(work, name=f"-o {settings.output}"), Display(console) as display:
        training: list[str] = []
        if settings.system:
            from mua_research.capture_training import system_entries  # because only a checkout has it

            systems, training = system_entries(settings, capture, work, display)
            entries = [*entries, *systems]
        display.stage("images")
        looked_at = _looked_at(settings, capture, chosen, entries, lpips, display)
    judged = [one for one in looked_at if one.scores]
    if not judged:
        raise InputError(f"{capture.file}: nobody is seen in any of the {len(chosen)} views by cameras with held_out")
    about = [f"{amount(len(judged), 'image')} of {capture.name}, inside the box around the mask, over white."]
    about += [*capture_report.nobody_there([one.shot for one in looked_at if not one.scores]), *training]
    found: list[capture_scores.Standing] = []
    plots: dict[str, bytes] = {}
    if any(one.system for one in entries):
        from mua_research import curve, standing

        found = standing.standings(judged, entries)
        about += standing.sentences(found)
        plots["curve.png"] = curve.curve(judged, entries)
    written = _write(settings.output, judged, entries, about, found, plots)
    console.print(capture_report.table(judged, entries))
    for sentence in [*about, f"{settings.output}: {', '.join(written)}"]:
        console.print(sentence, highlight=False, soft_wrap=True, markup=False)


def _looked_at(
    settings: EvaluationSettings,
    capture: Capture,
    chosen: Sequence[capture_scores.Shot],
    entries: Sequence[capture_scores.FilmedEntry],
    lpips: Lpips | None,
    display: Display,
) -> list[capture_scores.Judged]:
    """Every view; only those of the contact sheets keep their images in memory."""
    shown, see = set(capture_report.sheet_shots(chosen)), ViewStore(capture, settings.output / "work" / "views").view
    kept, found = shown if settings.images is None else set(chosen), []
    for one in capture_scores.judge(capture, chosen, entries, see=see, kept=kept, lpips=lpips):
        if settings.images is not None:
            capture_report.write_images(settings.images, one)
        found.append(one if one.shot in shown else replace(one, pictures={}))
        display.step(len(found), len(chosen))
    return found


def _write(
    output: Path,
    judged: Sequence[capture_scores.Judged],
    entries: Sequence[capture_scores.FilmedEntry],
    about: Sequence[str],
    found: Sequence[capture_scores.Standing],
    plots: Mapping[str, bytes],  # by name of their files
) -> list[str]:
    """Write all figures, each file atomically; returns the names of the files."""
    contents = {
        "results.md": capture_report.markdown(judged, entries, about).encode(),
        "results.csv": capture_report.as_csv(judged).encode(),
        "results.json": capture_report.as_json(judged, entries, about, found).encode(),
        **plots,
    }
    for name, content in contents.items():
        write_bytes(output / name, content)
    written = list(contents)
    rivals, student = {one.split: one.rival for one in found}, capture_report.student_of(entries).name
    for split in capture_scores.SPLITS:
        names = capture_report.sheet_names(entries, rivals.get(split))
        sheet = capture_report.contact_sheet(judged, split, names, student)
        if sheet is not None:
            written.append(f"{split.replace(' ', '_')}.png")
            with replacing(output / written[-1]) as temporary:
                sheet.save(temporary)
    return written
