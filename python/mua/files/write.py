"""Atomic writes: a reader sees the old content or the new, never half of either."""

import glob
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from mua.errors import InputError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path` that replaces it when the block ends without an error.

    The temporary keeps the suffix of `path`, because image writers choose their format by it. Raises InputError where
    the system refuses to write: no room, no such place, no permission.
    """
    temporary = _temporary(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        with temporary.open("rb+") as written:
            os.fsync(written.fileno())
        temporary.replace(path)
    except OSError as error:
        if error.strerror is None or not _concerns(error, path, temporary):
            raise
        raise refused(path, error) from error
    finally:
        _remove(temporary)


def write_bytes(path: Path, content: bytes) -> None:
    """Write `content` to `path`, all of it or none."""
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def require_writable(path: Path) -> None:
    """Make the directory of `path`; raises InputError, before hours of work, if nothing could be written there."""
    if path.is_dir():
        raise InputError(f"{path}: is a directory, expected a file to write")
    probe = _temporary(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        probe.touch()
    except OSError as error:
        raise refused(path, error) from error
    finally:
        _remove(probe)


def missing_directory(path: Path, *, option: str) -> Path | None:
    """The highest directory that would have to be made for `path` to be one; None where it is there.

    Makes nothing. Raises InputError where nothing can be written in what there is, and where the directory would be
    made at the root of a disk: that is most often a mistake.
    """
    missing, there = None, path.absolute()
    while not there.exists():
        missing, there = there, there.parent
    if not there.is_dir():
        raise InputError(f"{option} {path}: {there} is no directory")
    if missing is not None and there == Path(there.anchor):
        raise InputError(f"{option} {path}: there is no directory {missing}; create it first if the path is right")
    probe = there / f".mua.{os.getpid()}.part"
    try:
        probe.touch()
    except OSError as error:
        raise InputError(f"{option} {path}: nothing can be written in {there} ({error.strerror})") from error
    finally:
        _remove(probe)
    return missing


def remove_leftovers(path: Path) -> None:
    """Remove what killed writers of `path` left beside it; what another process at work is writing stays."""
    start, end = f".{path.stem}.", f".part{path.suffix}"
    for left in path.parent.glob(f"{glob.escape(start)}*{glob.escape(end)}"):
        writer = left.name[len(start) : -len(end)]
        if not (writer.isdecimal() and _at_work(int(writer))):
            _remove(left)


def refused(path: Path, error: OSError, *, named: str = "") -> InputError:
    """The error for a failed write; `named` is the user's name for the file where that is not its path."""
    if isinstance(error, FileExistsError | NotADirectoryError):
        file = next((above for above in (path, *path.parents) if above.is_file()), error.filename)
        return InputError(f"{named or path}: cannot be written ({file} is no directory)")
    kept = "; the previous file is kept" if path.is_file() else ""
    return InputError(f"{named or path}: cannot be written ({error.strerror}){kept}")


def _concerns(error: OSError, path: Path, temporary: Path) -> bool:
    """Whether an error is about writing `path`: failed writes name no file, others the file or a directory above it."""
    if error.filename is None:
        return True
    named = Path(os.fsdecode(error.filename))
    return named == temporary or named in (path, *path.parents)


def _temporary(path: Path) -> Path:
    """Where this process writes what is to become `path`; named after the process, by which leftovers are known."""
    return path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")


def _at_work(process: int) -> bool:
    """Whether a process other than this one runs under an id; Windows keeps files that are open without being asked."""
    if sys.platform == "win32" or process == os.getpid():
        return False
    try:
        os.kill(process, 0)
    except PermissionError:  # another user's process
        return True
    except (ProcessLookupError, OverflowError):
        return False
    return True


def _remove(path: Path) -> None:
    with suppress(OSError):  # where there is no such directory, nothing was left; a full disk still deletes
        path.unlink()
