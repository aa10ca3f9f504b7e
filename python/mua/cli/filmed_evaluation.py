"""The comparison that mua-eval makes with the images of a capture, once its options are known to be good."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import torch

from mua.baking.filmed_motion import filmed_clips, plan_headings, taught_settings
from mua.baking.recorded import recording_key
from mua.capture import Capture, open_capture
from mua.capture.store import ViewStore
from mua.cli.console import printer
from mua.cli.display import Display
from mua.compare import filmed, filmed_report, standing
from mua.compare.curve import curve
from mua.compare.filmed_systems import sized, trained_entries
from mua.compare.motion import training_frames
from mua.compare.order import ALL, SYSTEM_NAMES, EvaluationOrder
from mua.compare.system import Budget
from mua.errors import InputError
from mua.files.lock import DirectoryLock
from mua.files.write import replacing, write_bytes
from mua.pose.encoding import RATE
from mua.recording import Recording
from mua.recording.workers import record_by_workers
from mua.splatting.perceptual import Lpips
from mua.student.settings import preset
from mua.teachers.trained.folder import teacher_bytes
from mua.teachers.trained.teacher import TrainedTeacher
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress, Run


def compare(order: EvaluationOrder) -> None:
    """Carry out an order whose recording is the folder of a capture, and write and print what comes of it."""
    capture = open_capture(order.recording)
    chosen = filmed.shots(capture, order.frames)
    lpips = Lpips(order.lpips_weights) if order.lpips_weights is not None else None
    template, work = capture.surfaces.skeleton, order.output / "work"
    entries = [] if order.teacher is None else filmed.teacher_entries(order.teacher, template)
    entries += [filmed.avatar_entry(path, template) for path in order.avatars]
    console = printer()
    with DirectoryLock(work, name=f"-o {order.output}"), Display(console) as display:
        said: list[str] = []
        if order.system:
            systems, said = _systems(order, capture, work, display)
            entries = [*entries, *systems]
        display.stage("images")
        looked_at = _looked_at(order, capture, chosen, entries, lpips, display)
    judged = [one for one in looked_at if one.scores]
    if not judged:
        raise InputError(f"{capture.file}: nobody is seen in any of the {len(chosen)} views by cameras with held_out")
    about = [f"{len(judged)} images of {capture.name}, inside the box around the mask, over white."]
    about += [*filmed_report.nobody_there([one.shot for one in looked_at if not one.scores]), *said]
    found = standing.standings(judged, entries)
    about += standing.sentences(found)
    written = _write(order.output, judged, entries, about, found)
    console.print(filmed_report.table(judged, entries))
    for sentence in [*about, f"{order.output}: {', '.join(written)}"]:
        console.print(sentence, highlight=False, soft_wrap=True, markup=False)


def _looked_at(
    order: EvaluationOrder,
    capture: Capture,
    chosen: Sequence[filmed.Shot],
    entries: Sequence[filmed.FilmedEntry],
    lpips: Lpips | None,
    display: Display,
) -> list[filmed.Judged]:
    """Every view; only those of the contact sheets keep their images in memory."""
    shown, see = set(filmed_report.sheet_shots(chosen)), ViewStore(capture, order.output / "work" / "views").view
    kept, found = shown if order.images is None else set(chosen), []
    for one in filmed.judge(capture, chosen, entries, see=see, kept=kept, lpips=lpips):
        if order.images is not None:
            filmed_report.write_images(order.images, one)
        found.append(one if one.shot in shown else replace(one, pictures={}))
        display.step(len(found), len(chosen))
    return found


def _systems(
    order: EvaluationOrder, capture: Capture, work: Path, display: Display
) -> tuple[list[filmed.FilmedEntry], list[str]]:
    """The systems at their sizes, trained on what the teacher shows of the training poses, and what is said of them."""
    assert order.teacher is not None
    settings = replace(preset(order.preset), seed=order.seed)
    if order.train_on is None:
        recording = _record(order.teacher, capture, settings.frames, work, display)
    else:
        recording = Recording(order.train_on)
        filmed.require_skeleton(f"--train-on {order.train_on}", recording.rig.skeleton, capture.surfaces.skeleton)
    settings = taught_settings(settings, recording.rig.texels.size)
    budget = Budget(seconds=order.seconds) if order.steps is None else Budget(steps=order.steps)
    checkpoints = Checkpoints(work, run_key((settings, recording.fingerprint(), budget.seconds, budget.steps), []))
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    generator = torch.Generator().manual_seed(settings.seed)

    def step(progress: Progress) -> None:
        display.step(progress.step, progress.steps, detail="" if progress.loss is None else f"loss {progress.loss:.4f}")

    display.stage("coarse mesh")
    frames = training_frames(recording, settings, run=Run(generator, checkpoints, step, device))
    names = list(SYSTEM_NAMES) if ALL in order.system else list(dict.fromkeys(order.system))
    failures: list[str] = []
    trained = trained_entries(
        sized(names, order.scale or (1.0,), frames.sizes),
        frames,
        budget=budget,
        checkpoints=checkpoints,
        begin=display.stage,
        report=step,
        failed=failures.append,
    )
    length = f"{budget.seconds:g} s" if budget.steps is None else f"{budget.steps} steps"
    said = [
        f"Systems were trained for {length} each on {len(frames)} frames of the teacher at {settings.texels} texels, "
        f"at sizes relative to preset {order.preset}, and at the largest that cost at most as much as ours.",
        "M parameters and MFLOP: of what turns a pose into a texture and a mesh; posing and drawing are left out.",
    ]
    return list(trained), [*said, *(f"Failed: {sentence}" for sentence in failures)]


def _record(teacher: Path, capture: Capture, frames: int, work: Path, display: Display) -> Recording:
    """What the teacher shows of the capture's training poses, at most so many."""
    names = [clip.name for clip in capture.clips if not clip.held_out]
    own = [clip for clip in filmed_clips(capture) if clip.name in names]
    planned = plan_headings(capture.surfaces.skeleton, own, [], filmed=names, frames=frames)
    planned = [replace(clip, whole=frozenset()) for clip in planned]
    key = recording_key(teacher_bytes(teacher), planned)
    directory = work / f"recording-{key}"
    total = sum(len(clip.wanted) for clip in planned)
    display.stage("recording")
    record_by_workers(
        partial(TrainedTeacher, teacher),
        planned,
        directory,
        jobs=1,
        rate=RATE,
        progress=lambda done, _: display.step(done, total),
        note=display.note,
    )
    return Recording(directory)


def _write(
    output: Path,
    judged: Sequence[filmed.Judged],
    entries: Sequence[filmed.FilmedEntry],
    about: Sequence[str],
    found: Sequence[standing.Standing],
) -> list[str]:
    """All figures, each file whole or as it was; the names of the files."""
    contents = {
        "results.md": filmed_report.markdown(judged, entries, about).encode(),
        "results.csv": filmed_report.as_csv(judged).encode(),
        "results.json": filmed_report.as_json(judged, entries, about, found).encode(),
    }
    if any(one.system for one in entries):
        contents["curve.png"] = curve(judged, entries)
    for name, content in contents.items():
        write_bytes(output / name, content)
    written = list(contents)
    rivals, student = {one.split: one.rival for one in found}, filmed_report.student_of(entries).name
    for split in filmed.SPLITS:
        names = filmed_report.sheet_names(entries, rivals.get(split))
        sheet = filmed_report.contact_sheet(judged, split, names, student)
        if sheet is not None:
            written.append(f"{split.replace(' ', '_')}.png")
            with replacing(output / written[-1]) as temporary:
                sheet.save(temporary)
    return written
