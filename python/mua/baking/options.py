"""The settings of a bake from its options; wrong ones are refused before anything is loaded, so they cost no time."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from mua.atlas.detail import read_detail
from mua.baking.settings import BakeSettings
from mua.characters.alpha import read_alphas
from mua.characters.expression_file import read_expression_names
from mua.characters.facing import Facing
from mua.characters.figure_size import FigureSize
from mua.characters.formats import require_scene
from mua.errors import InputError
from mua.files.inputs import is_capture, require_file, require_motion, require_teacher
from mua.files.write import missing_directory
from mua.motion.formats import require_face, require_format
from mua.motion.mapping import read_mapping
from mua.student.settings import Budget, Settings, preset, with_recipe
from mua.teachers.trained.settings import teacher_preset

SUFFIX = ".muaavatar"
TEACHER_PRESETS = {"tiny": "tiny", "preview": "small", "paper": "paper"}  # by the preset of the student


def bake_settings(options: Mapping[str, Any]) -> BakeSettings:
    """The settings that the options of `mua.bake` give; raises InputError for options that do not go together."""
    as_given = ("output", "device", "character", "teacher", "hold_out", "feet", "motion_range", "leave_out", "uv")
    settings = BakeSettings(
        **{name: options[name] for name in (*as_given, "face", "smplx", "storage", "clips")},
        work=work_directory(options["output"], options["work"]),
        student=student_settings(options),
        motions=options["motion"],
        mapping=_joints(options["mapping"]),
        expression_names=_expressions(options["expression_names"]),
        alphas=read_alphas(_as_texts(options["alpha"])),
        detail=read_detail(_as_texts(options["detail"]), uv=options["uv"]),
        facing=Facing(options["facing"], options["turn"]),
        size=FigureSize(scale=options["scale"], height=options["height"]),
        jobs=cores() if options["jobs"] is None else options["jobs"],
    )
    if settings.teacher is None and (settings.character is None or not is_capture(settings.character)):
        check_inputs(settings.character, settings.motions)
        _check_budget(settings)
    else:
        settings = _with_trained_teacher(settings, options)
    if settings.face is not None:
        require_face(settings.face)
    if settings.smplx is not None:
        require_file(settings.smplx)
    check_output(settings.output, settings.work)
    _check_motion_options(settings)
    return settings


def student_settings(options: Mapping[str, Any]) -> Settings:
    """The student's preset with the options that override it, where there are such."""
    settings = replace(preset(options["preset"]), seed=options["seed"])
    overrides = {name: options[name] for name in ("frames", "texels") if options.get(name) is not None}
    budget = Budget(mflop=options["budget_mflop"], mb=options["budget_mb"])
    return replace(with_recipe(settings, options["recipe"]), budget=budget, **overrides)


def _check_motion_options(settings: BakeSettings) -> None:
    """Raises InputError for an option that applies to motion files where there are none."""
    for name, given in (("--mapping", settings.mapping is not None), ("--feet plant", settings.feet == "plant")):
        if given and not settings.motions:
            raise InputError(f"{name}: works only with --motion, which is not given")


def _check_budget(settings: BakeSettings) -> None:
    """Raises InputError where no student of any body is so small, before anything is recorded."""
    from mua.student.budget import within_budget  # which reads wavelets: a missing extra is named first
    from mua.student.shapes import Body

    within_budget(settings.student, Body(), settings.storage)


def _with_trained_teacher(settings: BakeSettings, options: Mapping[str, Any]) -> BakeSettings:
    """The settings of a bake whose teacher is, or is going to be, trained on images."""
    for name in (
        *("uv", "detail", "scale", "height", "facing", "turn"),
        *("leave_out", "alpha", "expression_names", "smplx"),
    ):
        if options[name] not in (None, (), {}, "auto", 0.0):
            raise InputError(
                f"--{name.replace('_', '-')}: the capture's own capture.json says it; leave the option out"
            )
    if settings.face is not None:
        raise InputError(f"--face {settings.face}: a filmed person has no expressions (morph targets)")
    check_inputs(None, settings.motions)
    if settings.teacher is None:
        training = teacher_preset(TEACHER_PRESETS[options["preset"]])
        student = settings.student
        return replace(settings, training=replace(training, texels=student.texels, seed=student.seed))
    filmed = settings.character is not None and is_capture(settings.character)
    if settings.character is not None and not filmed:
        raise InputError(f"--teacher {settings.teacher}: has its own character; leave {settings.character} out")
    if options["texels"] is not None:
        raise InputError(
            f"--texels {options['texels']}: the texture is as large as the teacher's; leave the option out"
        )
    require_teacher(settings.teacher)
    if not settings.motions and not filmed:
        raise InputError(f"--teacher {settings.teacher}: give the motion to record with --motion")
    return settings


def work_directory(output: Path, work: Path | None) -> Path:
    """Where unfinished results are kept: beside the output by default."""
    return output.with_suffix(".work") if work is None else work


def _joints(mapping: Path | Mapping[str, str] | None) -> Mapping[str, str] | None:
    """Target joint to source joint, from a mapping or the file that holds one."""
    return read_mapping(mapping) if isinstance(mapping, Path) else mapping


def _expressions(names: Path | Mapping[str, str] | None) -> Mapping[str, str] | None:
    """Names of expressions, or those of the file that holds them."""
    return read_expression_names(names) if isinstance(names, Path) else names


def _as_texts(pairs: Mapping[str, object] | tuple[str, ...]) -> tuple[str, ...]:
    """Values by name as the command line has them: head=2."""
    return tuple(f"{name}={value}" for name, value in pairs.items()) if isinstance(pairs, Mapping) else pairs


def check_inputs(character: Path | None, motions: Sequence[Path]) -> None:
    """Raises InputError for a file that is not there, and for one of a format that is not read."""
    if character is not None:
        require_file(character)
    for motion in motions:
        require_motion(motion)
    for motion in motions:
        require_format(motion)
    if character is not None:
        require_scene(character)


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
