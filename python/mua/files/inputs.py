"""Checks that a command's inputs exist before anything is loaded, so that a wrong name costs no time."""

from pathlib import Path

from mua.errors import InputError

TEACHER = "teacher.json"
HEADER = "recording.json"  # as mua.recording, which takes torch to load, calls it
CAPTURE = "capture.json"


def require_file(path: Path) -> None:
    """Raise InputError where there is no file of that name."""
    if not path.is_file():
        problem = "is a directory, expected a file" if path.is_dir() else "there is no such file"
        raise InputError(f"{path}: {problem}")


def require_motion(path: Path) -> None:
    """Raise InputError where there is neither a file nor a directory of that name."""
    if not path.exists():
        raise InputError(f"--motion {path}: there is no such file or directory")


def is_capture(path: Path) -> bool:
    """Whether a directory is a capture."""
    return (path / CAPTURE).is_file()


def require_teacher(path: Path) -> None:
    """Raise InputError where there is no directory of that name, or none that mua-teach wrote."""
    if not (path / TEACHER).is_file():
        problem = f"it holds no {TEACHER}" if path.is_dir() else "there is no such directory"
        raise InputError(f"--teacher {path}: {problem}; expected the folder that mua-teach wrote")


def require_recording(path: Path) -> None:
    """Raise InputError where there is no directory of that name, or one that is no recording."""
    if not path.is_dir():
        problem = "is a file, expected the directory of a recording" if path.is_file() else "there is no such directory"
        raise InputError(f"{path}: {problem}")
    if not (path / HEADER).is_file():
        raise InputError(f"{path}: not a recording, it holds no {HEADER}")


def require_folder(path: Path) -> None:
    """Raise InputError where there is no directory of that name."""
    if not path.is_dir():
        problem = "is a file, expected the folder of a capture" if path.is_file() else "there is no such directory"
        raise InputError(f"{path}: {problem}")


def require_capture(path: Path) -> None:
    """Raise InputError where there is no directory of that name, or one that is no capture."""
    require_folder(path)
    if not (path / CAPTURE).is_file():
        raise InputError(f"{path}: not a capture, it holds no {CAPTURE}, which mua-capture describe writes")
