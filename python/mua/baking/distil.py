"""A recording becomes a verified `.muaavatar`, in one call."""

import os
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from mua.arguments import PathLike, as_path, describe, one_of
from mua.asset.tensors import Storage
from mua.baking.listener import Listener, Log, Nobody
from mua.baking.options import check_settings, clip_names, work_directory
from mua.baking.order import DeviceName
from mua.errors import InputError
from mua.extras import naming_extras
from mua.files.inputs import require_recording
from mua.files.lock import DirectoryLock
from mua.files.write import require_writable
from mua.student.settings import STAGES, Settings, StageName

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.baking.distillation import Baked, Distillation
    from mua.recording import Recording


def train(
    recording: "PathLike | Recording",
    *,
    output: PathLike = "avatar.muaavatar",
    preset: str = "preview",
    recipe: str = "closed-form",
    stage: StageName | None = None,
    clips: str | int | Sequence[str] = "all",
    storage: Storage = "f16",
    seed: int = 0,
    device: DeviceName = "auto",
    work: PathLike | None = None,
    listener: Listener | None = None,
) -> "Baked | None":
    """Distil a recording into a `.muaavatar`, as mua-train does: minutes to hours.

    The arguments are the options of mua-train (docs/training.md) by the same names, and their errors name the options.
    Texture size and frames are the recording's. A call that was interrupted goes on where it stopped when the same one
    is made again. Under torchrun several processes train together.

    `listener` hears of stages, steps and notes; without one they go to the log "mua" of Python's logging.

    Returns None where a `stage` alone was run, and in all processes under torchrun but the first.

    Errors: InputError for anything that cannot be used; ModuleNotFoundError, with what to install, without the packages
    of the extra `train`.

    Example:

        mua.train("recordings/subject01", output="subject01.muaavatar", storage="i8")
    """
    settings = check_settings(preset, recipe, seed=seed, frames=None, texels=None)
    one_of(stage, "stage", (None, *STAGES))
    order = _Order(
        output=as_path(output, "output"),
        work=work_directory(as_path(output, "output"), work),
        settings=settings,
        stage=stage,
        clips=clip_names(clips),
        storage=one_of(storage, "storage", get_args(Storage)),
        device=one_of(device, "device", get_args(DeviceName)),
    )
    if isinstance(recording, str | os.PathLike):
        recording = as_path(recording, "recording")
        require_recording(recording)
    with naming_extras("mua.train"):
        return _distil(recording, order, listener or Log())


@dataclass(frozen=True)
class _Order:
    """What a user asks for."""

    output: Path
    work: Path
    settings: Settings
    stage: StageName | None
    clips: tuple[str, ...]
    storage: Storage
    device: DeviceName


def _distil(recording: "Path | Recording", order: _Order, listener: Listener) -> "Baked | None":
    from mua.baking.distillation import Distillation, choose_device  # seconds of loading
    from mua.baking.playback import choose, whole_clips
    from mua.baking.report import UNSAID
    from mua.recording import Recording
    from mua.training.processes import joined

    with joined() as processes:
        opened = Recording(recording) if isinstance(recording, Path) else recording
        if not isinstance(opened, Recording):
            raise InputError(f"recording is {describe(recording)}; expected a directory or a mua.Recording")
        choose(whole_clips(opened.clips), order.clips)  # before hours of work
        distillation = Distillation(
            output=order.output,
            work=order.work,
            settings=replace(order.settings, texels=opened.rig.texels.size, frames=opened.count()),
            device=processes.place(choose_device(order.device)),
            name=order.output.stem,
            teacher=UNSAID,
            playback=order.clips,
            storage=order.storage,
            processes=processes,
        )
        with _alone(distillation):
            return _carry_out(distillation, opened, order.stage, listener if processes.first else Nobody())


def _alone(order: "Distillation") -> AbstractContextManager[object]:
    """Keeps others out of the work directory; of processes that train together the first one does."""
    if not order.processes.first:
        return nullcontext()
    require_writable(order.output)
    return DirectoryLock(order.work, name=f"--work {order.work}")


def _carry_out(
    order: "Distillation", recording: "Recording", stage: StageName | None, listener: Listener
) -> "Baked | None":
    from mua.baking.distillation import finish, teach

    student = teach(order, recording, listener, only=stage)
    if stage is not None:
        listener.note(f"checkpoints are in {order.checkpoints}")
        return None
    return finish(order, student, recording, listener) if order.processes.first else None
