"""The stages of a bake in order; each leaves its result in the work directory and is resumed from there."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Protocol

import torch

from mua import __version__
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.bake import report
from mua.bake.assemble import assemble
from mua.bake.plan import plan, split
from mua.bake.sources import RATE, load_character, load_clips
from mua.contact_sheet import contact_sheet
from mua.evaluate import Errors, evaluate
from mua.files import replacing, write_bytes
from mua.recording import PlannedClip, Recording, TeacherWriter, record
from mua.rig.character import Character
from mua.student.distil import distil
from mua.student.settings import Settings
from mua.teachers.simulated import SimulatedTeacher

SHEET_FRAMES = 6


@dataclass(frozen=True)
class Order:
    """What a user asks for."""

    output: Path
    work: Path
    settings: Settings
    device: torch.device
    character: Path | None = None  # None: the procedural character
    motions: tuple[Path, ...] = ()  # none: the character's own clips
    hold_out: tuple[str, ...] = ()  # names of clips; none: the end of every clip
    mapping: Mapping[str, str] | None = None  # target joint to source joint
    uv: Literal["keep", "unwrap", "auto"] = "auto"
    storage: Storage = "f16"


class Listener(Protocol):
    """Hears what a bake does; the command line shows it."""

    def stage(self, name: str) -> None: ...

    def step(self, done: int, total: int, *, detail: str = "") -> None: ...

    def note(self, sentence: str) -> None: ...


@dataclass(frozen=True)
class Baked:
    """What a bake leaves."""

    errors: Mapping[str, Errors]
    output: Path
    sheet: Path
    figures: Path


def bake(order: Order, listener: Listener) -> Baked:
    """Carry out `order`: record a teacher, distil it, write the avatar, measure it and picture it."""
    listener.stage("character")
    character = load_character(order.character, uv=order.uv, seed=order.settings.seed)
    clips, notes = load_clips(character, order.motions, mapping=order.mapping)
    for sentence in (*character.notes, *notes):
        listener.note(sentence)
    training, held = split(clips, order.hold_out)
    planned = plan(training, held, frames=order.settings.frames)

    recording = _record(order, character, planned, listener)
    student = distil(recording, order.settings, device=order.device, directory=order.work / "student", report=listener)
    listener.stage("avatar")
    avatar = assemble(
        student,
        recording.rig,
        name=character.name,
        encoding=student.encoding,
        clips=[*held, *training],
        notes=report.STAND_IN,
    )
    write(order.output, avatar, storage=order.storage)

    listener.stage("evaluation")
    avatar = read(order.output)  # what a user gets, not what was trained
    errors = evaluate(recording, student, avatar=avatar, progress=listener.step)
    baked = Baked(errors, order.output, _beside(order, "_contact_sheet.png"), _beside(order, "_errors.md"))
    _picture(baked, avatar, recording)
    write_bytes(baked.figures, report.markdown(errors).encode())
    write_bytes(_beside(order, "_errors.json"), report.as_json(errors).encode())
    return baked


def _record(order: Order, character: Character, planned: list[PlannedClip], listener: Listener) -> Recording:
    """The teacher's recording, taken up where an earlier run of the same order left it."""
    directory = order.work / f"recording-{_key(order, character, planned)}"
    listener.stage("teacher")
    teacher = SimulatedTeacher(character, texels=order.settings.texels, seed=order.settings.seed)
    listener.stage("recording")
    total = sum(len(clip.wanted) for clip in planned)
    with TeacherWriter(directory, teacher.rig, rate=RATE) as writer:
        record(teacher, planned, writer, progress=lambda done: listener.step(done, total))
    return Recording(directory)


def _key(order: Order, character: Character, planned: list[PlannedClip]) -> str:
    """Changes with everything that a recording depends on, so that no other order's frames are taken for these."""
    digest = hashlib.sha256(f"{__version__} {order.settings.texels} {order.settings.seed}".encode())
    for array in (character.mesh.vertices, character.mesh.uv, character.skin_weights, character.base_color):
        digest.update(array.tobytes())
    for clip in planned:
        digest.update(f"{clip.clip.name} {clip.held_out} {sorted(clip.wanted)} {sorted(clip.whole or ())}".encode())
        digest.update(clip.clip.rotations.tobytes() + clip.clip.translation.tobytes())
    return digest.hexdigest()[:12]


def _picture(baked: Baked, avatar: Avatar, recording: Recording) -> None:
    """Write the contact sheet, of held-out frames where there are any."""
    frames = list(recording.whole_frames(held_out=True)) or list(recording.whole_frames(held_out=False))
    step = max(len(frames) // SHEET_FRAMES, 1)
    with replacing(baked.sheet) as temporary:
        contact_sheet(avatar, frames[step // 2 :: step][:SHEET_FRAMES]).save(temporary)


def _beside(order: Order, ending: str) -> Path:
    return order.output.with_name(order.output.stem + ending)
