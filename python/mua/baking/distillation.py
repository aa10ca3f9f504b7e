"""From a recording to a verified `.muaavatar`: all of mua-train, and the second half of a bake."""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import torch

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.count import stored_bytes
from mua.asset.read import decode_tree, load
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.baking import playback, report
from mua.baking.assemble import assemble
from mua.baking.contact_sheet import contact_sheet
from mua.baking.listener import Listener
from mua.baking.one_sided import with_one_sided
from mua.baking.settings import ALL
from mua.baking.shared_options import DeviceName
from mua.baking.student_errors import Errors, evaluate
from mua.errors import InputError
from mua.files.write import remove_leftovers, replacing, require_writable, write_bytes
from mua.pose.clip import Clip
from mua.recording import Recording
from mua.student.budget import describe_sizes, within_budget
from mua.student.distil import body_of, distil
from mua.student.model import Student
from mua.student.settings import Settings, StageName
from mua.training.memory import release_memory
from mua.training.processes import ALONE, Processes

SHEET_FRAMES = 6


@dataclass(frozen=True, eq=False)
class Distillation:
    """What is to become of a recording."""

    output: Path
    work: Path  # for the checkpoints
    settings: Settings
    device: torch.device
    name: str  # that the avatar gets
    teacher: str  # what the teacher is; stands in the avatar and beside every figure
    clips: tuple[Clip, ...] | None = None  # the character's, whole; None: the recording's, their ends joined
    playback: tuple[str, ...] = (ALL,)  # which of them the file holds, as `choose` reads it
    storage: Storage = "f16"
    compared: Sequence[Array] = ()  # strips for the contact sheet: the character's source beside its splats
    processes: Processes = ALONE  # that train together; the first of them writes

    @property
    def checkpoints(self) -> Path:
        return self.work / "student"

    def beside(self, ending: str) -> Path:
        """A file that lies beside the output and is named after it."""
        return self.output.with_name(self.output.stem + ending)


@dataclass(frozen=True)
class Baked:
    """What a bake or a training leaves."""

    errors: Mapping[str, Errors]  # by group of frames; none where the recording keeps no frame whole
    output: Path
    stored: report.Stored
    teacher: str  # what it is, for whoever reads the errors
    sheet: Path | None = None
    figures: Path | None = None

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Sentences on the held-out clips of which less than nothing is explained."""
        return tuple(report.shortfalls(self.errors))


def choose_device(name: DeviceName) -> torch.device:
    """The device of that name; raises InputError where it is a GPU and there is none."""
    found = torch.cuda.is_available()
    if name == "cuda" and not found:
        raise InputError("--device cuda: torch finds no GPU on this machine")
    return torch.device("cuda" if found and name != "cpu" else "cpu")


def distil_student(
    distillation: Distillation, recording: Recording, listener: Listener, *, only: StageName | None = None
) -> Student:
    """Train a student on `recording`; its stages are kept in the work directory, where the same call resumes.

    With `only` one stage is run up to its checkpoints; the student is then unfinished. Raises InputError where there is
    nothing to train on or to start the stage from, or where checkpoints or the output cannot be written.
    """
    if distillation.processes.first:
        require_writable(distillation.output)
        remove_leftovers(distillation.output)
    settings = distillation.settings
    if settings.budget:
        settings = within_budget(settings, body_of(recording, settings), distillation.storage)
        listener.note(f"The budget gives the student {describe_sizes(settings)}.")
    with _within_memory(distillation):
        return distil(
            recording,
            settings,
            device=distillation.device,
            directory=distillation.checkpoints,
            report=listener,
            processes=distillation.processes,
            only=only,
        )


def finish(distillation: Distillation, student: Student, recording: Recording, listener: Listener) -> Baked:
    """Write the avatar, read it back, measure it and image it."""
    release_memory()
    listener.stage("avatar")
    clips = playback.whole_clips(recording.clips) if distillation.clips is None else distillation.clips
    starts = playback.held_out(recording.clips)
    shown = [*clips, *playback.range_clips(recording.clips, clips)]
    avatar = assemble(
        student,
        recording.rig,
        name=distillation.name,
        encoding=student.encoding,
        clips=clips,
        bounded=shown,
        stored=playback.choose(clips, distillation.playback),
        notes=f"{distillation.teacher}; {playback.held_out_sentence(starts)}",
    )
    avatar = with_one_sided(avatar, shown, progress=listener.step)
    write(distillation.output, avatar, storage=distillation.storage)
    tree = load(distillation.output)
    avatar = decode_tree(tree)  # what a user gets, not what was trained
    stored = _stored(avatar, stored_bytes(tree["clips"]), distillation.output)

    listener.stage("evaluation")
    if not recording.whole_count:
        listener.note("the recording keeps no frame whole, so there are neither errors nor a contact sheet")
        return Baked({}, distillation.output, stored, distillation.teacher)
    errors = evaluate(recording, student, avatar=avatar, progress=listener.step)
    sheet, figures = distillation.beside("_contact_sheet.png"), distillation.beside("_errors.md")
    _picture(sheet, avatar, recording, distillation.compared)
    write_bytes(figures, report.markdown(errors, teacher=distillation.teacher).encode())
    content = report.as_json(errors, teacher=distillation.teacher, held_out=starts)
    write_bytes(distillation.beside("_errors.json"), content.encode())
    return Baked(errors, distillation.output, stored, distillation.teacher, sheet, figures)


def _stored(avatar: Avatar, clip_bytes: int, path: Path) -> report.Stored:
    seconds = sum(len(clip) / clip.rate for clip in avatar.clips)
    return report.Stored(len(avatar.clips), seconds, clip_bytes, path.stat().st_size)


@contextmanager
def _within_memory(distillation: Distillation) -> Iterator[None]:
    """Say in a sentence that a GPU is too small."""
    try:
        yield
    except torch.cuda.OutOfMemoryError as error:
        raise InputError(
            f"--device {distillation.device}: its memory is too small ({str(error).partition('. ')[0]}); what was "
            f"trained is kept in {distillation.checkpoints}, --device cpu goes on from there"
        ) from error


def _picture(path: Path, avatar: Avatar, recording: Recording, compared: Sequence[Array]) -> None:
    """Write the contact sheet, of held-out frames where there are any."""
    unseen = sum(1 for _ in recording.whole_frames(held_out=True))
    step = max((unseen or recording.whole_count) // SHEET_FRAMES, 1)
    frames = recording.whole_frames(held_out=unseen > 0)  # one at a time: hundreds would not fit into memory
    chosen = itertools.islice(frames, step // 2, step // 2 + step * SHEET_FRAMES, step)
    with replacing(path) as temporary:
        contact_sheet(avatar, chosen, compared=compared).save(temporary)
