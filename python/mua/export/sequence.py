"""Writes several files together: all of them or none."""

import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path

from mua.errors import InputError
from mua.files.write import refused


def write_all(files: Iterable[tuple[Path, bytes]]) -> None:
    """Write files of one directory, which are put in their places when all of them are there.

    Errors: InputError where the system refuses to write.
    """
    staged: list[Path] = []
    stage: Path | None = None
    target = Path()
    try:
        for target, content in files:
            if stage is None:
                target.parent.mkdir(parents=True, exist_ok=True)
                stage = Path(tempfile.mkdtemp(prefix=".mua-export.", dir=target.parent))
            (stage / target.name).write_bytes(content)
            staged.append(target)
        for target in staged:
            assert stage is not None  # only where something is staged
            (stage / target.name).replace(target)
    except OSError as error:
        raise refused(target, error) from error
    finally:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)


def file_names(output: Path, numbers: range, *, suffix: str) -> list[Path]:
    """The file of each frame: `output` is a name with a place for the number, such as %04d, or a directory.

    Errors: InputError where the name takes no number.
    """
    if output.name.endswith(suffix):
        pattern = output.name
    else:
        output, pattern = output / "frame", f"frame_%04d{suffix}"
    try:
        names = [pattern % number for number in numbers]
    except (TypeError, ValueError):
        names = []
    if len(set(names)) != len(numbers):
        raise InputError(f"-o is {output}; expected one place for the number of the frame, such as out_%04d{suffix}")
    return [output.with_name(name) for name in names]
