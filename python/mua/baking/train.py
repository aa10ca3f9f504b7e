"""mua.train: a recording becomes a verified `.muaavatar`, in one call."""

import os
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mua.arguments import PathLike, describe
from mua.asset.storable import require_names
from mua.asset.tensors import Storage
from mua.baking.listener import Listener, Log, Nobody
from mua.baking.options import student_settings, work_directory
from mua.baking.shared_options import (
    ClipsOption,
    DeviceName,
    DeviceOption,
    MegabytesOption,
    MflopOption,
    OutputOption,
    PresetOption,
    RecipeOption,
    SeedOption,
    StorageOption,
)
from mua.errors import InputError
from mua.extras import naming_extras
from mua.files.inputs import require_recording
from mua.files.lock import DirectoryLock
from mua.files.write import require_writable
from mua.option import Option, read_options
from mua.student.settings import Settings, StageName

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.baking.distillation import Baked, Distillation
    from mua.recording import Recording


def train(
    recording: Annotated[
        "PathLike | Recording", Option("Folder of a recording, as a TeacherWriter writes it.", metavar="RECORDING")
    ],
    *,
    output: OutputOption = "avatar.muaavatar",
    preset: PresetOption = "preview",
    budget_mflop: MflopOption = None,
    budget_mb: MegabytesOption = None,
    recipe: RecipeOption = "closed-form",
    stage: Annotated[
        StageName | None, Option("Run only this stage, up to its checkpoint.", default="all stages")
    ] = None,
    clips: ClipsOption = "all",
    storage: StorageOption = "f16",
    seed: SeedOption = 0,
    device: DeviceOption = "auto",
    work: Annotated[PathLike | None, Option("Folder for checkpoints.", default="beside the output")] = None,
    listener: Listener | None = None,
) -> "Baked | None":
    """Distil a recording into a `.muaavatar`, as mua-train does: minutes to hours.

    The arguments are the options of mua-train (docs/training.md) by the same names, and their errors name the options.
    Texture size and frames are the recording's. A call that was interrupted goes on where it stopped when the same one
    is made again. Under torchrun several processes train together.

    `listener` receives stages, steps and notes; without one they go to the log "mua" of Python's logging.

    Returns None where a `stage` alone was run, and in all processes under torchrun but the first.

    Errors: InputError for anything that cannot be used; ModuleNotFoundError, with what to install, without the packages
    of the extra `train`.

    Example:

        mua.train("recordings/subject01", output="subject01.muaavatar", storage="i8")
    """
    options = read_options(train, locals())
    settings = TrainSettings(
        **{name: options[name] for name in ("output", "stage", "clips", "storage", "device")},
        work=work_directory(options["output"], options["work"]),
        student=student_settings(options),
    )
    if isinstance(recording, str | os.PathLike):
        recording = Path(recording)
        require_recording(recording)
    with naming_extras("mua.train"):
        return _train(recording, settings, listener or Log())


@dataclass(frozen=True)
class TrainSettings:
    """What a recording is distilled to, as the options of mua-train say."""

    output: Path
    work: Path
    student: Settings
    stage: StageName | None
    clips: tuple[str, ...]
    storage: Storage
    device: DeviceName


def _train(recording: "Path | Recording", settings: TrainSettings, listener: Listener) -> "Baked | None":
    from mua.baking.distillation import Distillation, choose_device  # seconds of loading
    from mua.baking.playback import choose, whole_clips
    from mua.baking.report import UNSAID
    from mua.recording import Recording
    from mua.training.processes import joined

    with joined() as processes:
        opened = Recording(recording) if isinstance(recording, Path) else recording
        if not isinstance(opened, Recording):
            raise InputError(f"recording is {describe(recording)}; expected a directory or a mua.Recording")
        choose(whole_clips(opened.clips), settings.clips)  # before hours of work
        names = [clip.name for clip in opened.clips]
        require_names(str(opened.directory), [settings.output.stem], opened.rig.skeleton.names, names)
        distillation = Distillation(
            output=settings.output,
            work=settings.work,
            settings=replace(settings.student, texels=opened.rig.texels.size, frames=opened.count()),
            device=processes.place(choose_device(settings.device)),
            name=settings.output.stem,
            teacher=UNSAID,
            playback=settings.clips,
            storage=settings.storage,
            processes=processes,
        )
        with _alone(distillation):
            return _carry_out(distillation, opened, settings.stage, listener if processes.first else Nobody())


def _alone(distillation: "Distillation") -> AbstractContextManager[object]:
    """Keeps others out of the work directory; of processes that train together the first one does."""
    if not distillation.processes.first:
        return nullcontext()
    require_writable(distillation.output)
    return DirectoryLock(distillation.work, name=f"--work {distillation.work}")


def _carry_out(
    distillation: "Distillation", recording: "Recording", stage: StageName | None, listener: Listener
) -> "Baked | None":
    from mua.baking.distillation import distil_student, finish

    student = distil_student(distillation, recording, listener, only=stage)
    if stage is not None:
        listener.note(f"checkpoints are in {distillation.checkpoints}")
        return None
    return finish(distillation, student, recording, listener) if distillation.processes.first else None
