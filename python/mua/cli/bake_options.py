"""What the options of mua-bake may be; asked before anything is loaded, so that a wrong one costs no time."""

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mua.cli.inputs import require_file, require_motion
from mua.errors import InputError
from mua.files import missing_directory
from mua.student.settings import Settings, preset, with_recipe

SUFFIX = ".muaavatar"
STEP, LEAST_TEXELS = 16, 32  # a texture is halved four times, and something must be left


def check_settings(name: str, recipe: str, *, seed: int, frames: int | None, texels: int | None) -> Settings:
    """The preset of that name with what overrides it; raises InputError for a value that no bake can have."""
    settings = with_recipe(replace(preset(name), seed=seed), recipe)
    if frames is not None and frames < 1:
        raise InputError(f"--frames {frames}: expected at least 1")
    if texels is not None and (texels < LEAST_TEXELS or texels % STEP):
        raise InputError(f"--texels {texels}: expected a multiple of {STEP} from {LEAST_TEXELS} on")
    if seed < 0:
        raise InputError(f"--seed {seed}: expected 0 or more")
    settings = replace(settings, frames=settings.frames if frames is None else frames)
    return replace(settings, texels=settings.texels if texels is None else texels)


def check_inputs(character: Path | None, motions: Sequence[Path]) -> None:
    """Raises InputError for a file that is not there."""
    if character is not None:
        require_file(character)
    for motion in motions:
        require_motion(motion)


def check_jobs(jobs: int | None) -> int:
    """How many processes; raises InputError where it is none."""
    if jobs is not None and jobs < 1:
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
