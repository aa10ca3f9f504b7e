"""A capture becomes a teacher, in one call."""

from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from mua.arguments import PathLike, as_path, finite_array, one_of, whole_number
from mua.baking.listener import Listener, Log, Nobody
from mua.baking.options import LEAST_TEXELS
from mua.baking.order import DeviceName
from mua.channels import COARSE_TEXELS
from mua.errors import InputError
from mua.extras import naming_extras
from mua.files.inputs import require_capture, require_file
from mua.files.lock import DirectoryLock
from mua.files.write import missing_directory, require_writable
from mua.teachers.trained.settings import Rasteriser, TeacherSettings, teacher_preset

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.training.processes import Processes

MOST_DEGREES = 10.0  # that a pose may be refined by


def teach(
    capture: PathLike,
    *,
    output: PathLike = "teacher",
    preset: str = "tiny",
    steps: int | None = None,
    texels: int | None = None,
    drivable: bool = False,
    colour_correction: bool = True,
    refine: float = 0.0,
    lpips_weights: PathLike | None = None,
    rasteriser: Rasteriser = "mua",
    seed: int = 0,
    device: DeviceName = "auto",
    listener: Listener | None = None,
) -> Path:
    """Train a teacher on the images of a capture, as mua-teach does: minutes to days. Returns the teacher's folder.

    The arguments are the options of mua-teach (docs/training.md) by the same names, and their errors name the options.
    A call that was interrupted goes on where it stopped when the same one is made again. Under torchrun several
    processes train together.

    `listener` hears of stages, steps and notes; without one they go to the log "mua" of Python's logging.

    Errors: InputError for anything that cannot be used; ModuleNotFoundError, with what to install, without the packages
    of the extra `teach`.

    Example:

        mua.teach("captures/anna", output="teachers/anna", preset="small")
    """
    settings = _settings(preset, steps=steps, texels=texels, refine=refine, seed=seed)
    settings = replace(
        settings,
        drivable=drivable,
        colour_correction=colour_correction,
        rasteriser=one_of(rasteriser, "rasteriser", get_args(Rasteriser)),
    )
    if settings.rasteriser == "gsplat" and find_spec("gsplat") is None:
        raise InputError("--rasteriser gsplat: the Python package gsplat is not installed; pip install gsplat")
    output, weights = as_path(output, "output"), None
    if lpips_weights is not None:
        weights = as_path(lpips_weights, "lpips_weights")
        require_file(weights)
    if output.exists() and not output.is_dir():
        raise InputError(f"-o {output}: is a file, expected a folder")
    missing_directory(output, option="-o")
    order = _Order(
        as_path(capture, "capture"), output, settings, one_of(device, "device", get_args(DeviceName)), weights
    )
    require_capture(order.capture)
    with naming_extras("mua.teach"):
        from mua.training.processes import joined

        with joined() as processes:
            _teach(order, processes, listener or Log())
    return output


@dataclass(frozen=True)
class _Order:
    """What a user asks for."""

    capture: Path
    output: Path
    settings: TeacherSettings
    device: DeviceName
    weights: Path | None  # of LPIPS


def _settings(name: str, *, steps: int | None, texels: int | None, refine: float, seed: int) -> TeacherSettings:
    settings = teacher_preset(name)
    if steps is not None:
        if whole_number(steps, "steps") < 1:
            raise InputError(f"--steps {steps}: expected at least 1")
        settings = replace(settings, texture=replace(settings.texture, steps=steps))
    if texels is not None:
        if whole_number(texels, "texels") < LEAST_TEXELS or texels % COARSE_TEXELS:
            raise InputError(f"--texels {texels}: expected a multiple of {COARSE_TEXELS} from {LEAST_TEXELS} on")
        settings = replace(settings, texels=texels, rows=settings.rows * texels // settings.texels)
    if whole_number(seed, "seed") < 0:
        raise InputError(f"--seed {seed}: expected 0 or more")
    degrees = float(finite_array(refine, "refine", ()))
    if not 0 <= degrees <= MOST_DEGREES:
        raise InputError(f"--refine {degrees:g}: expected 0 to {MOST_DEGREES:g} degrees")
    return replace(settings, refine=degrees, seed=seed)


def _teach(order: _Order, processes: "Processes", listener: Listener) -> None:
    from mua.baking.distillation import choose_device  # seconds of loading
    from mua.baking.teacher_stages import carry_out

    device = processes.place(choose_device(order.device))
    if order.settings.rasteriser == "gsplat" and device.type != "cuda":
        raise InputError(f"--rasteriser gsplat: draws on NVIDIA GPUs only, and the device is {device.type}")
    if not processes.first:
        carry_out(order.capture, order.output, order.settings, device, Nobody(), processes, weights=order.weights)
        return
    require_writable(order.output / "teacher.json")
    with DirectoryLock(order.output, name=f"-o {order.output}"):
        carry_out(order.capture, order.output, order.settings, device, listener, processes, weights=order.weights)
