"""The stages of a bake in order; each leaves its result in the work directory and is resumed from there."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from functools import cache, partial

import numpy as np
import torch
from threadpoolctl import threadpool_limits

from mua.arrays import Array
from mua.atlas.texel_density import describe_texels
from mua.baking.capture_bake import bake_trained_teacher
from mua.baking.check import fidelity_of
from mua.baking.contact_sheet import CELL
from mua.baking.distillation import Baked, Distillation, choose_device, distil_student, finish
from mua.baking.forked import can_fork, in_fork
from mua.baking.listener import Listener
from mua.baking.options import check_output
from mua.baking.plan import describe_plan, plan, split, usual_poses
from mua.baking.playback import choose
from mua.baking.ranges import planned_range, settings_for
from mua.baking.report import STAND_IN
from mua.baking.resumed_recording import recorded, recording_key
from mua.baking.settings import BakeSettings
from mua.baking.sources import clips_of, faced, load_baked_character
from mua.errors import InputError
from mua.fidelity import fitting, report
from mua.fidelity.compare import Fidelity
from mua.fidelity.sheet import worst_strips
from mua.files.lock import DirectoryLock
from mua.files.write import replacing, require_writable
from mua.pose.clip import Clip
from mua.recording import PlannedClip, Recording
from mua.recording.workers import Worker, waiting_workers
from mua.rig.character import Character
from mua.rig.template import make_template
from mua.rig.texel_binding import bind_texels
from mua.teachers.simulated.still import StillTeacher
from mua.teachers.simulated.teacher import SimulatedTeacher
from mua.teachers.simulated.texels import SurfaceTexels
from mua.training.memory import release_memory, return_large_blocks

# Steps of the fit, and training frames for each further one: less than a tenth of the time of a bake.
FEWEST_STEPS, FRAMES_OF_A_STEP = 120, 6
FRAMES = "frames 7"  # raised where the stand-in teacher or the fit changes what it makes of the same input
FITTED = b"fitted"  # part of the key of a fit and of the recording that it corrects, which have one name


def bake(settings: BakeSettings, listener: Listener, *, alone: bool = False) -> Baked:
    """Carry out `settings`: record a teacher, distil it, write the avatar, measure it and image it.

    `alone` says that nothing has computed with torch in this process: a fork of it then records a character and ends,
    which takes less memory. Raises InputError for anything that cannot be used, and where another process is at work in
    the work directory.
    """
    return_large_blocks()
    device = choose_device(settings.device)
    for directory in check_output(settings.output, settings.work):
        listener.note(f"There is no directory {directory}; it is created.")
    with DirectoryLock(settings.work, name=f"--work {settings.work}"):
        if settings.teacher is not None or settings.training is not None:
            return bake_trained_teacher(settings, device, listener)
        # numpy's matrix products are small, and threads of OpenBLAS wait for the next one with their cores busy
        with threadpool_limits(1, user_api="blas"):
            prepare = partial(_prepare, settings, device)
            distillation, recording = in_fork(prepare, listener) if alone and can_fork() else prepare(listener)
            student = distil_student(distillation, recording, listener)
            return finish(distillation, student, recording, listener)


def _prepare(settings: BakeSettings, device: torch.device, listener: Listener) -> tuple[Distillation, Recording]:
    """The recording of a character, and what is to become of it."""
    with ExitStack() as processes:
        return _prepare_by(processes, settings, device, listener)


def _prepare_by(
    processes: ExitStack, settings: BakeSettings, device: torch.device, listener: Listener
) -> tuple[Distillation, Recording]:
    waiting: list[Worker] = []

    def start(_: object = None) -> None:
        """Let processes load while the character is laid out, unless a run before left a recording."""
        nonlocal waiting
        if not any(settings.work.glob("recording-*")):
            waiting = processes.enter_context(waiting_workers(settings.jobs, SimulatedTeacher))

    listener.stage("character")
    if settings.character is None:  # else once its file is known to be sound
        start()
    character = load_baked_character(settings, read=start)
    clips, notes = clips_of(settings, character)
    clips, of_face = faced(character, clips, settings.face)
    for sentence in (*character.notes, describe_texels(character, settings.student.texels), *notes, *of_face):
        listener.note(sentence)
    student_settings = settings_for(settings, character)
    bodies = [replace(clip, expressions=None) for clip in clips]  # a face is not learnt: it follows from the mesh
    training, held = split(bodies, settings.hold_out)
    planned = plan(training, held, frames=settings.student.frames)
    choose(clips, settings.clips)  # before hours of work
    recorded_frames = sum(len(clip.wanted) for clip in planned if not clip.held_out)
    ranges = planned_range(settings, character, bodies, recorded_frames)
    listener.note(describe_plan(planned, ranges, asked=settings.student.frames))
    planned += ranges

    require_writable(settings.output)
    still = cache(partial(StillTeacher, character, texels=settings.student.texels))
    corrections = _fitted(settings, character, still, planned, listener)
    laid, fidelity = _compared(settings, character, clips, still, corrections, listener)
    compared = [] if fidelity is None else worst_strips(fidelity, CELL)
    del still, fidelity
    character = replace(character, source=None)  # its textures may be large
    release_memory()
    recording = _record(settings, character, laid, planned, listener, fitted=corrections is not None, waiting=waiting)
    del laid
    release_memory()
    distillation = Distillation(
        output=settings.output,
        work=settings.work,
        settings=student_settings,
        device=device,
        name=character.name,
        teacher=STAND_IN,
        clips=tuple(clips),
        playback=settings.clips,
        storage=settings.storage,
        compared=compared,
    )
    return distillation, recording


def _fitted(
    settings: BakeSettings,
    character: Character,
    still: Callable[[], StillTeacher],
    planned: list[PlannedClip],
    listener: Listener,
) -> Array | None:
    """Corrections of the splats by images of the source, kept in the work directory; None without source or OpenGL."""
    if character.source is None:
        return None
    file = settings.work / f"fit-{recording_key([*parts(settings, character), FITTED], planned)}.npy"
    if file.exists():
        return np.asarray(np.load(file))
    listener.stage("fitting to the source")
    steps = min(FEWEST_STEPS + settings.student.frames // FRAMES_OF_A_STEP, fitting.STEPS)
    try:
        corrections = fitting.fit(
            character,
            [one.clip for one in planned if not one.held_out],
            teacher=still(),
            source=character.source,
            steps=steps,
            progress=lambda done: listener.step(done, steps),
        )
    except InputError as error:
        listener.note(f"The splats were not fitted to the source: {error}.")
        return None
    with replacing(file) as temporary, temporary.open("wb") as out:
        np.save(out, corrections)
    return corrections


def _compared(
    settings: BakeSettings,
    character: Character,
    clips: list[Clip],
    still: Callable[[], StillTeacher],
    corrections: Array | None,
    listener: Listener,
) -> tuple[SurfaceTexels | None, Fidelity | None]:
    """The splats as they are fitted, and the comparison with the source, which is noted.

    None without a source; no comparison without OpenGL.
    """
    if character.source is None:
        return None, None
    listener.stage("comparison with source")
    teacher = still() if corrections is None else still().corrected(corrections)
    fidelity, warnings = fidelity_of(character, clips, texels=settings.student.texels, teacher=teacher)
    for sentence in (*([] if fidelity is None else [report.summary(fidelity)]), *warnings):
        listener.note(sentence)
    return teacher.laid, fidelity


def _record(
    settings: BakeSettings,
    character: Character,
    laid: SurfaceTexels | None,  # None: each process that records lays them
    planned: list[PlannedClip],
    listener: Listener,
    *,
    fitted: bool,  # whether the splats were corrected by images of the source
    waiting: list[Worker],
) -> Recording:
    """The stand-in teacher's recording."""
    texels, seed = settings.student.texels, settings.student.seed
    for sentence in bind_texels(character, make_template(character), size=texels).notes:
        listener.note(sentence)
    bare = replace(character, clips=())
    if laid is not None:  # which have their colours: processes need no texture of perhaps 100 MB
        bare = replace(bare, base_color=character.base_color[:1, :1])
    lit_in = usual_poses(planned)
    teacher = partial(SimulatedTeacher, bare, texels=texels, laid=laid, lit_in=lit_in, seed=seed)
    key = recording_key([*parts(settings, character), *([FITTED] if fitted else [])], planned)
    return recorded(teacher, key, settings, planned, listener, waiting)


def parts(settings: BakeSettings, character: Character) -> Iterator[bytes]:
    """What the stand-in teacher's frames depend on, besides the motion."""
    skeleton, mesh, face = character.skeleton, character.mesh, character.expressions
    yield f"{FRAMES} {settings.student.texels} {settings.student.seed} {skeleton.names} {skeleton.root}".encode()
    yield str(() if face is None else face.names).encode()
    for array in (
        *(skeleton.parents, skeleton.bind_rotations, skeleton.bind_translations),
        *(mesh.vertices, mesh.faces, mesh.uv, mesh.uv_faces, character.base_color),
        *(character.skin_indices, character.skin_weights, character.looseness),
        *(() if face is None else (face.starts, face.vertices, face.offsets, face.rules)),
    ):
        yield b"none" if array is None else f"{array.shape}".encode() + array.tobytes()
