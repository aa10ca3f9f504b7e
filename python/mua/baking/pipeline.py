"""The stages of a bake in order; each leaves its result in the work directory and is resumed from there."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import torch

from mua.atlas.texel_density import describe_texels
from mua.baking.check import fidelity_of
from mua.baking.distillation import Baked, Distillation, choose_device, finish, teach
from mua.baking.filmed import bake_taught
from mua.baking.listener import Listener
from mua.baking.options import check_output
from mua.baking.order import Order
from mua.baking.plan import plan, split
from mua.baking.playback import choose
from mua.baking.ranges import clips_of, planned_range, settings_for
from mua.baking.recorded import recorded, recording_key
from mua.baking.report import STAND_IN
from mua.baking.sources import ordered_character
from mua.fidelity import report
from mua.fidelity.compare import Fidelity
from mua.files.lock import DirectoryLock
from mua.files.write import require_writable
from mua.pose.clip import Clip
from mua.recording import PlannedClip, Recording
from mua.rig.character import Character
from mua.rig.template import make_template
from mua.rig.texel_binding import bind_texels
from mua.teachers.simulated.teacher import SimulatedTeacher
from mua.training.memory import release_memory


def bake(order: Order, listener: Listener) -> Baked:
    """Carry out `order`: record a teacher, distil it, write the avatar, measure it and image it.

    Raises InputError for anything that cannot be used, and where another process is at work in the work directory.
    """
    device = choose_device(order.device)
    for directory in check_output(order.output, order.work):
        listener.note(f"There is no directory {directory}; it is created.")
    with DirectoryLock(order.work, name=f"--work {order.work}"):
        if order.teacher is not None or order.lessons is not None:
            return bake_taught(order, device, listener)
        return _bake(order, device, listener)


def _bake(order: Order, device: torch.device, listener: Listener) -> Baked:
    listener.stage("character")
    character = ordered_character(order)
    clips, notes = clips_of(order, character)
    for sentence in (*character.notes, describe_texels(character, order.settings.texels), *notes):
        listener.note(sentence)
    settings = settings_for(order, character)
    training, held = split(clips, order.hold_out)
    planned = plan(training, held, frames=order.settings.frames)
    choose(clips, order.clips)  # before hours of work
    recorded_frames = sum(len(clip.wanted) for clip in planned if not clip.held_out)
    planned += planned_range(order, character, clips, recorded_frames)

    require_writable(order.output)
    fidelity = _fidelity(character, clips, order.settings.texels, listener)
    character = replace(character, source=None)  # its textures may be large
    release_memory()
    recording = _record(order, character, planned, listener)
    release_memory()
    distillation = Distillation(
        output=order.output,
        work=order.work,
        settings=settings,
        device=device,
        name=character.name,
        teacher=STAND_IN,
        clips=tuple(clips),
        playback=order.clips,
        storage=order.storage,
        fidelity=fidelity,
    )
    student = teach(distillation, recording, listener)
    return finish(distillation, student, recording, listener)


def _fidelity(character: Character, clips: list[Clip], texels: int, listener: Listener) -> Fidelity | None:
    """Compare splats and source and note the result; None if there is no source or no OpenGL."""
    if character.source is None:
        return None
    listener.stage("comparison with source")
    fidelity, warnings = fidelity_of(character, clips, texels=texels)
    for sentence in (*([] if fidelity is None else [report.summary(fidelity)]), *warnings):
        listener.note(sentence)
    return fidelity


def _record(order: Order, character: Character, planned: list[PlannedClip], listener: Listener) -> Recording:
    """The stand-in teacher's recording."""
    texels, seed = order.settings.texels, order.settings.seed
    for sentence in bind_texels(character, make_template(character), size=texels).notes:
        listener.note(sentence)
    teacher = partial(SimulatedTeacher, replace(character, clips=()), texels=texels, seed=seed)
    return recorded(teacher, recording_key(parts(order, character), planned), order, planned, listener)


def parts(order: Order, character: Character) -> Iterator[bytes]:
    """What the stand-in teacher's frames depend on, besides the motion."""
    skeleton, mesh = character.skeleton, character.mesh
    yield f"in parts {order.settings.texels} {order.settings.seed} {skeleton.names} {skeleton.root}".encode()
    for array in (
        *(skeleton.parents, skeleton.bind_rotations, skeleton.bind_translations),
        *(mesh.vertices, mesh.faces, mesh.uv, mesh.uv_faces, character.base_color),
        *(character.skin_indices, character.skin_weights, character.looseness),
    ):
        yield b"none" if array is None else f"{array.shape}".encode() + array.tobytes()
