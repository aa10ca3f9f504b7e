"""A bake whose teacher learns, or has learnt, from the pictures of a capture."""

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import torch

from mua.baking.distillation import Baked, Distillation, finish, teach
from mua.baking.lessons import carry_out
from mua.baking.listener import Listener
from mua.baking.order import Order
from mua.baking.plan import HeldOut, plan, split
from mua.baking.playback import choose
from mua.baking.recorded import recorded, recording_key
from mua.baking.report import TAUGHT
from mua.baking.sources import RATE, load_clips
from mua.capture import open_capture
from mua.files import require_writable
from mua.locks import DirectoryLock
from mua.memory import release_memory
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.processes import ALONE
from mua.rig.character import Character
from mua.teaching.folder import load_teacher, teacher_bytes
from mua.teaching.trained import TrainedTeacher


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
    name, training, held = _motion(order, folder, listener)
    planned = plan(training, held, frames=order.settings.frames)
    clips = (*training, *(own.clip for own in held))
    choose(clips, order.clips)  # before hours of work
    key = recording_key(teacher_bytes(folder), planned)
    recording = recorded(partial(TrainedTeacher, folder), key, order, planned, listener)
    release_memory()
    distillation = Distillation(
        output=order.output,
        work=order.work,
        settings=replace(order.settings, texels=recording.rig.texels.size),
        device=device,
        name=name,
        teacher=TAUGHT,
        playback=order.clips,
        storage=order.storage,
    )
    return finish(distillation, teach(distillation, recording, listener), recording, listener)


def _motion(order: Order, folder: Path, listener: Listener) -> tuple[str, list[Clip], list[HeldOut]]:
    """The person's name, and the clips to record for training and to hold out: those given, or the capture's own."""
    model, description = load_teacher(folder)
    if order.character is not None and not order.motions:
        capture = open_capture(order.character)
        own = {clip.name: resample(capture.motion(clip.name), RATE) for clip in capture.clips}
        held_out = [clip.name for clip in capture.clips if clip.held_out]
        return description.name, *split(list(own.values()), order.hold_out or held_out)
    rig = model.rig
    moved = Character(  # what of one motion is put on
        description.name,
        rig.skeleton,
        rig.mesh,
        rig.skin_indices,
        rig.skin_weights,
        base_color=np.zeros((1, 1, 4), np.uint8),
        roles=description.roles,
    )
    clips, notes = load_clips(moved, order.motions, mapping=order.mapping, feet=order.feet)
    for sentence in notes:
        listener.note(sentence)
    return description.name, *split(clips, order.hold_out)
