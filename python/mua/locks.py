"""One process at a time in a directory: a lock that ends with the process that holds it, however that one ends."""

import errno
import os
import sys
import time
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from mua.errors import InputError
from mua.files import refused

NAME = ".lock"  # holds the id of the process at work, for the sentence that others are refused with
TIMEOUT = 2.0  # seconds: those that a killed process has started take a moment to end
PAUSE = 0.02  # seconds
WITHOUT_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.ENOSYS)  # what some network file systems say


class DirectoryLock:
    """Holds a directory, which is made where it is missing, until `release`; use it as a context manager.

    The system lets go of the lock when the process ends, so that nothing is left to clear up after a kill.
    """

    def __init__(
        self,
        directory: Path,
        *,
        name: str,  # of the directory, in sentences
    ) -> None:
        """Raises InputError where any process holds the directory, this one too, or nothing can be written in it."""
        self._file: int | None = None
        self._path = directory / NAME
        end = time.monotonic() + TIMEOUT
        while not self._acquire(name):
            if time.monotonic() > end:
                raise InputError(
                    f"{name}: process {_holder(self._path)} is using it; "
                    "wait until that has ended, or choose another directory"
                )
            time.sleep(PAUSE)

    def release(self) -> None:
        """Let go, and remove the file, and the directory where nothing else is in it."""
        if self._file is None:
            return
        if sys.platform != "win32":  # which removes no open file
            _remove(self._path)
        self._close()
        if sys.platform == "win32":
            _remove(self._path)

    def __enter__(self) -> "DirectoryLock":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def __del__(self) -> None:
        self._close()

    def _acquire(self, name: str) -> bool:
        """Whether the lock is now held, under a file that is still the directory's."""
        directory = self._path.parent
        try:
            directory.mkdir(parents=True, exist_ok=True)
            self._file = os.open(str(self._path), os.O_RDWR | os.O_CREAT, 0o666)
        except OSError as error:
            if not self._removed_meanwhile(error):
                raise refused(directory, error, named=name) from error
            return False
        if _locked(self._file) and _same(self._file, self._path):
            with suppress(OSError):  # on a full disk the sentence names no process
                os.ftruncate(self._file, 0)
                os.write(self._file, str(os.getpid()).encode())
            return True
        self._close()
        return False

    def _removed_meanwhile(self, error: OSError) -> bool:
        """Whether what failed is that the last holder has just removed the directory."""
        directory = self._path.parent
        if isinstance(error, FileExistsError):
            return directory.is_dir() or not os.path.lexists(directory)
        return isinstance(error, FileNotFoundError) and error.filename == str(self._path)

    def _close(self) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None


def _holder(path: Path) -> str:
    try:
        return path.read_text(errors="replace").strip() or "(unknown)"
    except OSError:
        return "(unknown)"


def _same(file: int, path: Path) -> bool:
    """Whether an open file is the one at `path`, and not one that its holder has since removed."""
    try:
        return os.path.samestat(os.fstat(file), path.stat())
    except FileNotFoundError:
        return False


def _remove(path: Path) -> None:
    with suppress(OSError):  # others may hold it by now, and most directories hold more
        path.unlink()
        path.parent.rmdir()


if sys.platform == "win32":
    import msvcrt

    AT = 1 << 20  # the byte that is locked: beyond the process id, which others read

    def _locked(file: int) -> bool:
        os.lseek(file, AT, os.SEEK_SET)
        try:
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        finally:
            os.lseek(file, 0, os.SEEK_SET)
        return True

else:
    import fcntl

    def _locked(file: int) -> bool:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            return error.errno in WITHOUT_LOCKS  # as it was before there were locks
        return True
