"""What the options of a bake may be; asked before anything is loaded, so that a wrong one costs no time."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

from mua.arguments import PathLike, as_names, as_path, as_paths, finite_array, one_of, whole_number
from mua.asset.tensors import Storage
from mua.atlas.detail import UvMode, read_detail
from mua.baking.order import DeviceName, MotionRange, Order
from mua.channels import COARSE_TEXELS
from mua.characters.figure_size import FigureSize
from mua.errors import InputError
from mua.files.inputs import is_capture, require_file, require_motion, require_teacher
from mua.files.write import missing_directory
from mua.motion.formats import require_format
from mua.motion.mapping import read_mapping
from mua.motion.planted_feet import Feet
from mua.student.settings import Settings, preset, with_recipe
from mua.teachers.trained.settings import teacher_preset

SUFFIX = ".muaavatar"
LESSONS = {"tiny": "tiny", "preview": "small", "paper": "paper"}  # the teacher's preset by the student's
LEAST_TEXELS = 2 * COARSE_TEXELS  # something must be left of a texture that is halved so many times


def read_order(options: Mapping[str, Any]) -> Order:
    """The order of the options of `mua.bake`, all of them by name; raises InputError for what no bake can have."""
    written, uv = as_path(options["output"], "output"), one_of(options["uv"], "uv", get_args(UvMode))
    character = None if options["character"] is None else as_path(options["character"], "character")
    order = Order(
        output=written,
        work=work_directory(written, options["work"]),
        settings=check_settings(
            options["preset"],
            options["recipe"],
            seed=options["seed"],
            frames=options["frames"],
            texels=options["texels"],
        ),
        device=one_of(options["device"], "device", get_args(DeviceName)),
        character=character,
        teacher=None if options["teacher"] is None else as_path(options["teacher"], "teacher"),
        motions=as_paths(options["motion"], "motion"),
        hold_out=as_names(options["hold_out"], "hold_out"),
        mapping=_joints(options["mapping"]),
        feet=one_of(options["feet"], "feet", get_args(Feet)),
        motion_range=one_of(options["motion_range"], "motion_range", get_args(MotionRange)),
        leave_out=as_names(options["leave_out"], "leave_out"),
        uv=uv,
        detail=read_detail(_written(options["detail"]), uv=uv),
        size=FigureSize(scale=_number(options["scale"], "scale"), height=_number(options["height"], "height")),
        storage=one_of(options["storage"], "storage", get_args(Storage)),
        jobs=check_jobs(options["jobs"]),
        clips=clip_names(options["clips"]),
    )
    if order.teacher is None and (character is None or not is_capture(character)):
        check_inputs(character, order.motions)
    else:
        order = _taught(order, options)
    check_output(order.output, order.work)
    _check_of_motion(order)
    return order


def _check_of_motion(order: Order) -> None:
    """Raises InputError for an option that says what becomes of motion files where there are none."""
    for name, given in (("--mapping", order.mapping is not None), ("--feet plant", order.feet == "plant")):
        if given and not order.motions:
            raise InputError(f"{name}: works only with --motion, which is not given")


def _taught(order: Order, options: Mapping[str, Any]) -> Order:
    """The order of a bake whose teacher learns, or has learnt, from images."""
    for name in ("uv", "detail", "scale", "height", "leave_out"):
        if options[name] not in (None, (), [], {}, "auto"):
            raise InputError(
                f"--{name.replace('_', '-')}: the capture's own capture.json says it; leave the option out"
            )
    check_inputs(None, order.motions)
    if order.teacher is None:
        lessons = replace(
            teacher_preset(LESSONS[options["preset"]]), texels=order.settings.texels, seed=order.settings.seed
        )
        return replace(order, lessons=lessons)
    filmed = order.character is not None and is_capture(order.character)
    if order.character is not None and not filmed:
        raise InputError(f"--teacher {order.teacher}: has its own character; leave {order.character} out")
    if options["texels"] is not None:
        raise InputError(
            f"--texels {options['texels']}: the texture is as large as the teacher's; leave the option out"
        )
    require_teacher(order.teacher)
    if not order.motions and not filmed:
        raise InputError(f"--teacher {order.teacher}: give the motion to record with --motion")
    return order


def work_directory(output: Path, work: PathLike | None) -> Path:
    """Where what is not finished yet is kept: beside the output where nothing else is said."""
    return output.with_suffix(".work") if work is None else as_path(work, "work")


def clip_names(clips: str | int | Sequence[str]) -> tuple[str, ...]:
    """The clips to store, as `mua.baking.playback.choose` reads them: names, or "all", "none" or a number."""
    return (str(clips),) if isinstance(clips, int) and not isinstance(clips, bool) else as_names(clips, "clips")  # type: ignore[arg-type]


def _joints(mapping: PathLike | Mapping[str, str] | None) -> Mapping[str, str] | None:
    """Target joint to source joint, from a mapping or the file that holds one."""
    if mapping is None or isinstance(mapping, Mapping):
        return mapping
    return read_mapping(as_path(mapping, "mapping"))


def _written(detail: Mapping[str, float] | Sequence[str]) -> tuple[str, ...]:
    """Factors by part as the command line has them: head=2."""
    if isinstance(detail, Mapping):
        return tuple(f"{part}={factor}" for part, factor in detail.items())
    return as_names(detail, "detail")


def _number(value: float | None, name: str) -> float | None:
    return None if value is None else float(finite_array(value, name, ()))


def check_settings(name: str, recipe: str, *, seed: int, frames: int | None, texels: int | None) -> Settings:
    """The preset of that name with what overrides it; raises InputError for a value that no bake can have."""
    settings = with_recipe(replace(preset(name), seed=seed), recipe)
    if frames is not None and whole_number(frames, "frames") < 1:
        raise InputError(f"--frames {frames}: expected at least 1")
    if texels is not None and (whole_number(texels, "texels") < LEAST_TEXELS or texels % COARSE_TEXELS):
        raise InputError(f"--texels {texels}: expected a multiple of {COARSE_TEXELS} from {LEAST_TEXELS} on")
    if whole_number(seed, "seed") < 0:
        raise InputError(f"--seed {seed}: expected 0 or more")
    settings = replace(settings, frames=settings.frames if frames is None else frames)
    return replace(settings, texels=settings.texels if texels is None else texels)


def check_inputs(character: Path | None, motions: Sequence[Path]) -> None:
    """Raises InputError for a file that is not there, and for motion of a format that is not read."""
    if character is not None:
        require_file(character)
    for motion in motions:
        require_motion(motion)
    for motion in motions:
        require_format(motion)


def check_jobs(jobs: int | None) -> int:
    """How many processes; raises InputError where it is none."""
    if jobs is not None and whole_number(jobs, "jobs") < 1:
        raise InputError(f"--jobs {jobs}: expected at least 1")
    return cores() if jobs is None else jobs


def cores() -> int:
    """How many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):  # not on macOS and Windows
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def check_output(output: Path, work: Path) -> list[Path]:
    """The directories that are going to be made; raises InputError where output or work cannot be written."""
    if output.suffix != SUFFIX:
        raise InputError(f"-o {output}: expected a name that ends in {SUFFIX}")
    if output.is_dir():
        raise InputError(f"{output}: is a directory, expected a file to write")
    if work.exists() and not work.is_dir():
        raise InputError(f"--work {work}: is a file, expected a directory")
    named = (("-o", output.parent), ("--work", work if work.exists() else work.parent))
    missing = [missing_directory(directory, option=option) for option, directory in named]
    return list(dict.fromkeys(directory for directory in missing if directory is not None))
