"""A bake whose teacher learns, or has learnt, from the images of a capture."""

from collections.abc import Mapping
from functools import partial

import torch

from mua.baking.distillation import Baked, Distillation, finish, teach
from mua.baking.filmed_motion import filmed_clips, plan_headings, put_on, taught_settings
from mua.baking.listener import Listener
from mua.baking.order import Order
from mua.baking.plan import split
from mua.baking.playback import choose
from mua.baking.recorded import recorded, recording_key
from mua.baking.report import TAUGHT
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


def bake_taught(order: Order, device: torch.device, listener: Listener) -> Baked:
    """Teach first where the order names a capture; then record the teacher, distil it and write the avatar."""
    require_writable(order.output)
    folder = order.work / "teacher" if order.teacher is None else order.teacher
    if order.lessons is not None:
        assert order.character is not None
        with DirectoryLock(folder, name=f"--work {folder}"):
            carry_out(order.character, folder, order.lessons, device, listener, ALONE, weights=None)
        release_memory()
    listener.stage("motion")
    model, description = load_teacher(folder)
    clips, planned = _motion(order, model.rig, description.roles, listener)
    choose(clips, order.clips)  # before hours of work
    key = recording_key(teacher_bytes(folder), planned)
    recording = recorded(partial(TrainedTeacher, folder), key, order, planned, listener)
    release_memory()
    distillation = Distillation(
        output=order.output,
        work=order.work,
        settings=taught_settings(order.settings, recording.rig.texels.size),
        device=device,
        name=description.name,
        teacher=TAUGHT,
        clips=tuple(clips),
        playback=order.clips,
        storage=order.storage,
    )
    return finish(distillation, teach(distillation, recording, listener), recording, listener)


def _motion(
    order: Order, rig: Rig, roles: Mapping[str, str], listener: Listener
) -> tuple[list[Clip], list[PlannedClip]]:
    """The clips of the capture and of the files given, and what of them is recorded."""
    own: list[Clip] = []
    held_out: list[str] = []
    if order.character is not None:
        capture = open_capture(order.character)
        own = filmed_clips(capture)
        held_out = [clip.name for clip in capture.clips if clip.held_out]
    given, notes = put_on(rig, roles, order.motions, mapping=order.mapping, feet=order.feet)
    for sentence in notes:
        listener.note(sentence)
    clips = unique_names([*own, *given])
    training, held = split(clips, order.hold_out or held_out)
    filmed = [clip.name for clip in own]
    return clips, plan_headings(rig.skeleton, training, held, filmed=filmed, frames=order.settings.frames)
