"""The systems of a comparison with images, trained on what its teacher shows of a capture's training poses."""

from dataclasses import replace
from functools import partial
from pathlib import Path

from mua.baking.capture_motion import filmed_clips, filmed_settings, plan_headings
from mua.baking.resumed_recording import recording_key
from mua.capture import Capture
from mua.cli.display import Display
from mua.evaluation.capture_scores import FilmedEntry, require_skeleton
from mua.evaluation.settings import ALL, SYSTEM_NAMES, EvaluationSettings
from mua.pose.encoding import RATE
from mua.recording import Recording
from mua.recording.workers import record_by_workers
from mua.student.settings import preset
from mua.teachers.trained.folder import teacher_bytes
from mua.teachers.trained.teacher import TrainedTeacher
from mua_research.capture_systems import sized, trained_entries
from mua_research.training import prepare


def system_entries(
    evaluation: EvaluationSettings, capture: Capture, work: Path, display: Display
) -> tuple[list[FilmedEntry], list[str]]:
    """The systems at their sizes, and sentences about their training.

    Errors: InputError where the recording to train on is of another character than the capture's.
    """
    assert evaluation.teacher is not None
    settings = replace(preset(evaluation.preset), seed=evaluation.seed)
    if evaluation.train_on is None:
        recording = _record(evaluation.teacher, capture, settings.frames, work, display)
    else:
        recording = Recording(evaluation.train_on)
        require_skeleton(f"--train-on {evaluation.train_on}", recording.rig.skeleton, capture.surfaces.skeleton)
    settings = filmed_settings(settings, recording.rig.texels.size)
    training = prepare(evaluation, recording, settings, work, display)
    names = SYSTEM_NAMES if ALL in evaluation.system else tuple(dict.fromkeys(evaluation.system))
    failures: list[str] = []
    trained = trained_entries(
        sized(names, evaluation.scale or (1.0,), training.frames.sizes),
        training,
        begin=display.stage,
        failed=failures.append,
    )
    entries = list(trained)
    length = f"{evaluation.seconds:g} s" if evaluation.steps is None else f"{evaluation.steps} steps"
    sentences = [
        f"Systems were trained for {length} each on {len(training.frames)} frames of the teacher at {settings.texels} "
        f"texels, at sizes relative to preset {evaluation.preset}, and at the largest that cost no more than ours.",
        "M parameters and MFLOP: of what turns a pose into a texture and a mesh; posing and drawing are left out.",
    ]
    return entries, [*sentences, *(f"Failed: {sentence}" for sentence in failures)]


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
