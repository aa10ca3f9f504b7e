"""One process at a time in a directory: a lock that ends with the process that holds it, however that one ends."""

import errno
import os
import sys
import time
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from filelock import FileLock, Timeout

from mua.errors import InputError
from mua.files.write import refused

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
        self._path = directory / NAME
        self._lock: FileLock | None = None
        end = time.monotonic() + TIMEOUT
        while not self._acquire(name, max(end - time.monotonic(), 0)):
            if time.monotonic() > end:
                raise InputError(
                    f"{name}: process {_holder(self._path)} is using it; "
                    "wait until that has ended, or choose another directory"
                )
            time.sleep(PAUSE)

    def release(self) -> None:
        """Let go, and remove the file, and the directory where nothing else is in it."""
        if self._lock is None:
            return
        if sys.platform != "win32":  # which removes no open file
            _remove(self._path)
        self._lock.release()
        self._lock = None
        if sys.platform == "win32":
            _remove(self._path)

    def __enter__(self) -> "DirectoryLock":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def _acquire(self, name: str, seconds: float) -> bool:
        """Whether the directory is now held, by a lock on the file that is there and not on one that was removed."""
        directory = self._path.parent
        lock = FileLock(self._path, timeout=seconds, mode=0o666, is_singleton=False)
        try:
            directory.mkdir(parents=True, exist_ok=True)
            lock.acquire()
        except Timeout:
            return False
        except OSError as error:
            if error.errno in WITHOUT_LOCKS:
                return True
            if not self._removed_meanwhile(error):
                raise refused(directory, error, named=name) from error
            return False
        if not _same(lock, self._path):
            lock.release()
            return False
        self._lock = lock
        with suppress(OSError):  # on a full disk, and on Windows, the sentence names no process
            self._path.write_text(str(os.getpid()))
        return True

    def _removed_meanwhile(self, error: OSError) -> bool:
        """Whether what failed is that the last holder has just removed the directory."""
        directory = self._path.parent
        if isinstance(error, FileExistsError):
            return directory.is_dir() or not os.path.lexists(directory)
        return isinstance(error, FileNotFoundError)


def _holder(path: Path) -> str:
    try:
        return path.read_text(errors="replace").strip() or "(unknown)"
    except OSError:
        return "(unknown)"


def _same(lock: FileLock, path: Path) -> bool:
    """Whether the locked file is the one at `path`."""
    opened = lock._context.lock_file_fd  # the library has no public name for it
    try:
        return opened is not None and os.path.samestat(os.fstat(opened), path.stat())
    except FileNotFoundError:
        return False


def _remove(path: Path) -> None:
    with suppress(OSError):  # others may hold it by now, and most directories hold more
        path.unlink()
        path.parent.rmdir()
