"""A bake whose teacher is, or has been, trained on the images of a capture."""

from collections.abc import Mapping
from functools import partial

import torch

from mua.asset.storable import require_names
from mua.baking.capture_motion import filmed_clips, filmed_settings, plan_headings, put_on
from mua.baking.distillation import Baked, Distillation, distil_student, finish
from mua.baking.listener import Listener
from mua.baking.plan import split
from mua.baking.playback import choose
from mua.baking.report import FILMED
from mua.baking.resumed_recording import recorded, recording_key
from mua.baking.settings import BakeSettings
from mua.baking.teacher_stages import carry_out
from mua.capture import open_capture
from mua.files.lock import DirectoryLock
from mua.files.write import require_writable
from mua.motion.load import unique_names
from mua.pose.clip import Clip
from mua.recording import PlannedClip
from mua.rig.rig import Rig
from mua.teachers.trained.folder import load_teacher, teacher_bytes
from mua.teachers.trained.teacher import TrainedTeacher
from mua.training.memory import release_memory
from mua.training.processes import ALONE


def bake_trained_teacher(settings: BakeSettings, device: torch.device, listener: Listener) -> Baked:
    """Train a teacher first where the character is a capture; then record it, distil it and write the avatar."""
    require_writable(settings.output)
    folder = settings.work / "teacher" if settings.teacher is None else settings.teacher
    if settings.training is not None:
        assert settings.character is not None
        with DirectoryLock(folder, name=f"--work {folder}"):
            carry_out(settings.character, folder, settings.training, device, listener, ALONE, weights=None)
        release_memory()
    listener.stage("motion")
    model, description = load_teacher(folder)
    require_names(str(folder), [description.name], model.rig.skeleton.names, ())
    clips, planned = _motion(settings, model.rig, description.roles, listener)
    choose(clips, settings.clips)  # before hours of work
    key = recording_key(teacher_bytes(folder), planned)
    recording = recorded(partial(TrainedTeacher, folder), key, settings, planned, listener)
    release_memory()
    distillation = Distillation(
        output=settings.output,
        work=settings.work,
        settings=filmed_settings(settings.student, recording.rig.texels.size),
        device=device,
        name=description.name,
        teacher=FILMED,
        clips=tuple(clips),
        playback=settings.clips,
        storage=settings.storage,
    )
    return finish(distillation, distil_student(distillation, recording, listener), recording, listener)


def _motion(
    settings: BakeSettings, rig: Rig, roles: Mapping[str, str], listener: Listener
) -> tuple[list[Clip], list[PlannedClip]]:
    """The clips of the capture and of the files given, and what of them is recorded."""
    own: list[Clip] = []
    held_out: list[str] = []
    if settings.character is not None:
        capture = open_capture(settings.character)
        own = filmed_clips(capture)
        require_names(str(capture.file), (), (), [clip.name for clip in own])
        held_out = [clip.name for clip in capture.clips if clip.held_out]
    given, notes = put_on(rig, roles, settings.motions, mapping=settings.mapping, feet=settings.feet)
    for sentence in notes:
        listener.note(sentence)
    clips = unique_names([*own, *given])
    training, held = split(clips, settings.hold_out or held_out)
    filmed = [clip.name for clip in own]
    return clips, plan_headings(rig.skeleton, training, held, filmed=filmed, frames=settings.student.frames)
