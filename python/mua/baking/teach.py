"""mua.teach: a capture becomes a teacher, in one call."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

from mua.arguments import PathLike
from mua.baking.listener import Listener, Log, Nobody
from mua.baking.shared_options import DeviceName, SeedOption, TexelsOption
from mua.errors import InputError
from mua.extras import naming_extras
from mua.files.inputs import require_capture, require_file
from mua.files.lock import DirectoryLock
from mua.files.write import missing_directory, require_writable
from mua.option import Option, read_options
from mua.teachers.trained.settings import PRESETS, Rasteriser, TeacherSettings, teacher_preset

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.training.processes import Processes


def teach(
    capture: Annotated[PathLike, Option("Folder of a capture; it holds a capture.json.", metavar="CAPTURE")],
    *,
    output: Annotated[PathLike, Option("Folder to write the teacher to.", short="-o")] = "teacher",
    preset: Annotated[
        str, Option("Size of the teacher; small and paper are meant for a GPU.", choices=tuple(PRESETS))
    ] = "tiny",
    steps: Annotated[int | None, Option("Number of training steps.", default="set by the preset", least=1)] = None,
    texels: TexelsOption = None,
    drivable: Annotated[
        bool | None,
        Option("Fit first how motion deforms the template, to meshes or masks.", default="where there are meshes"),
    ] = None,
    colour_correction: Annotated[
        bool, Option("Fit how cameras differ in colour; without, all are taken to show colours alike.")
    ] = True,
    refine: Annotated[
        float,
        Option(
            "Degrees by which each joint, and centimetres by which the root may be moved to fit the images "
            "better; 0 trusts the poses.",
            least=0,
            most=10,
            unit="degrees",
        ),
    ] = 0.0,
    lpips_weights: Annotated[
        PathLike | None,
        Option("Weights of torchvision's AlexNet or VGG16, for a perceptual term in the loss.", default="none"),
    ] = None,
    rasteriser: Annotated[
        Rasteriser, Option("Rasteriser to train with; gsplat needs a GPU.", choices=get_args(Rasteriser))
    ] = "mua",
    seed: SeedOption = 0,
    device: Annotated[DeviceName, Option("Where to train.")] = "auto",
    listener: Listener | None = None,
) -> Path:
    """Train a teacher on the images of a capture, as mua-teach does: minutes to days. Returns the teacher's folder.

    The arguments are the options of mua-teach (docs/training.md) by the same names, and their errors name the options.
    A call that was interrupted goes on where it stopped when the same one is made again. Under torchrun several
    processes train together.

    `listener` receives stages, steps and notes; without one they go to the log "mua" of Python's logging.

    Errors: InputError for anything that cannot be used; ModuleNotFoundError, with what to install, without the packages
    of the extra `teach`.

    Example:

        mua.teach("captures/anna", output="teachers/anna", preset="small")
    """
    settings = _read_settings(read_options(teach, locals()))
    with naming_extras("mua.teach"):
        from mua.training.processes import joined

        with joined() as processes:
            _train(settings, processes, listener or Log())
    return settings.output


@dataclass(frozen=True)
class TrainTeacherSettings:
    """What a teacher is trained on and how, as the options of mua-teach say."""

    capture: Path
    output: Path
    teacher: TeacherSettings
    device: DeviceName
    lpips_weights: Path | None


def _read_settings(options: Mapping[str, Any]) -> TrainTeacherSettings:
    """Raises InputError for what cannot be trained with, on or to."""
    teacher, output, weights = _teacher_settings(options), options["output"], options["lpips_weights"]
    if teacher.rasteriser == "gsplat" and find_spec("gsplat") is None:
        raise InputError("--rasteriser gsplat: the Python package gsplat is not installed; pip install gsplat")
    if weights is not None:
        require_file(weights)
    if output.exists() and not output.is_dir():
        raise InputError(f"-o {output}: is a file, expected a folder")
    missing_directory(output, option="-o")
    require_capture(options["capture"])
    return TrainTeacherSettings(options["capture"], output, teacher, options["device"], weights)


def _teacher_settings(options: Mapping[str, Any]) -> TeacherSettings:
    """The teacher's preset with the options that override it."""
    same = ("drivable", "colour_correction", "refine", "rasteriser", "seed")
    settings = replace(teacher_preset(options["preset"]), **{name: options[name] for name in same})
    if options["steps"] is not None:
        settings = replace(settings, texture=replace(settings.texture, steps=options["steps"]))
    texels = options["texels"]
    if texels is not None:
        settings = replace(settings, texels=texels, rows=settings.rows * texels // settings.texels)
    return settings


def _train(settings: TrainTeacherSettings, processes: "Processes", listener: Listener) -> None:
    from mua.baking.distillation import choose_device  # seconds of loading
    from mua.baking.teacher_stages import carry_out

    output, device = settings.output, processes.place(choose_device(settings.device))
    if settings.teacher.rasteriser == "gsplat" and device.type != "cuda":
        raise InputError(f"--rasteriser gsplat: draws on NVIDIA GPUs only, and the device is {device.type}")
    stages = partial(carry_out, settings.capture, output, settings.teacher, device, weights=settings.lpips_weights)
    if not processes.first:
        stages(Nobody(), processes)
        return
    require_writable(output / "teacher.json")
    with DirectoryLock(output, name=f"-o {output}"):
        stages(listener, processes)
