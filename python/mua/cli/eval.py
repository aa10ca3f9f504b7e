"""mua-eval: compares avatars and the systems of the paper's tables on a recording."""

from typing import Any

from mua.cli.failure import run_command
from mua.cli.options import command_options, lent_by
from mua.errors import InputError
from mua.evaluation.settings import EvaluationSettings
from mua.extras import require_research
from mua.files.inputs import is_capture, require_file, require_recording, require_teacher
from mua.option import read_options
from mua.student.settings import preset


@lent_by(EvaluationSettings, command_options(EvaluationSettings))
def evaluate(**options: Any) -> None:
    """Compare avatar files and other systems with the teacher of RECORDING, in tables, plots and contact sheets.

    Where RECORDING is the folder of a capture, a --teacher, avatar files and systems trained on that teacher are
    compared with its images instead, by the cameras and in the clips that are held out. Every system is also trained
    at the largest size that costs at most as much as ours.

    Trained systems are kept in the folder 'work' of the output; the same command does not train them again.
    """
    settings = EvaluationSettings(**read_options(EvaluationSettings, options))
    filmed = is_capture(settings.recording)
    (_check_filmed if filmed else _check_recorded)(settings)
    for file in (*settings.avatars, *([settings.lpips_weights] if settings.lpips_weights else [])):
        require_file(file)
    preset(settings.preset)
    if settings.system:
        require_research(f"--system {settings.system[0]}")
    # after the options are checked, because these take seconds to load
    if filmed:
        from mua.cli.capture_evaluation import compare
    else:
        from mua.cli.recording_evaluation import compare
    compare(settings)


def _check_recorded(settings: EvaluationSettings) -> None:
    """Raises InputError for what applies to a capture alone."""
    require_recording(settings.recording)
    scale = f"{settings.scale[0]:g}" if settings.scale else None
    for name, value in (("scale", scale), ("train-on", settings.train_on), ("images", settings.images)):
        if value is not None:
            raise InputError(f"--{name} {value}: only applies to a comparison with the images of a capture")
    if settings.teacher is not None:
        raise InputError(
            f"--teacher {settings.teacher}: can only be compared with the images of a capture, not with a recording"
        )


def _check_filmed(settings: EvaluationSettings) -> None:
    """Raises InputError for what cannot be compared with images."""
    if settings.system and settings.teacher is None:
        raise InputError(f"--system {settings.system[0]}: learns from a teacher; give its folder with --teacher")
    if settings.scale and not settings.system:
        raise InputError(f"--scale {settings.scale[0]:g}: is the size of a --system, and none is given")
    if settings.train_on is not None:
        if not settings.system:
            raise InputError(f"--train-on {settings.train_on}: is what a --system is trained on, and none is given")
        require_recording(settings.train_on)
    if settings.teacher is None and not settings.avatars:
        raise InputError("give a --teacher or avatar files to compare with the images of the capture")
    if settings.teacher is not None:
        require_teacher(settings.teacher)


def run() -> None:
    """Entry point of the command."""
    run_command(evaluate)


if __name__ == "__main__":
    run()
