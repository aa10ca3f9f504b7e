"""One process at a time in a directory: a lock that ends with the process that holds it, however that one ends."""

import errno
import os
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from filelock import FileLock, Timeout

from mua.errors import InputError
from mua.files.write import refused

NAME = ".lock"  # holds the id of the process at work, for the sentence that others are refused with
TIMEOUT = 2.0  # seconds; the children of a killed process take a moment to end
WITHOUT_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.ENOSYS)  # errors of network file systems without locks


class DirectoryLock:
    """Holds a directory, which is made where it is missing, until `release`; use it as a context manager.

    The system lets go of the lock when the process ends, so that nothing is left to clear up after a kill. The empty
    file `.lock` stays: whoever waits for it waits for the same file.
    """

    def __init__(
        self,
        directory: Path,
        *,
        name: str,  # the directory's name in error messages
    ) -> None:
        """Raise InputError where any process holds the directory, this one too, or nothing can be written in it."""
        self._path = directory / NAME
        self._lock: FileLock | None = None
        lock = FileLock(self._path, timeout=TIMEOUT, mode=0o666, is_singleton=False)
        try:
            directory.mkdir(parents=True, exist_ok=True)
            lock.acquire()
        except Timeout:
            raise InputError(
                f"{name}: process {_holder(self._path)} is using it; "
                "wait until that has ended, or choose another directory"
            ) from None
        except OSError as error:
            if error.errno not in WITHOUT_LOCKS:
                raise refused(directory, error, named=name) from error
            return
        self._lock = lock
        self._note(str(os.getpid()))

    def release(self) -> None:
        """Release the lock; does nothing the second time."""
        if self._lock is not None:
            self._note("")
            self._lock.release()
            self._lock = None

    def __enter__(self) -> "DirectoryLock":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def _note(self, holder: str) -> None:
        with suppress(OSError):  # a full disk, or Windows, where nobody else writes a locked file: no process is named
            self._path.write_text(holder)


def _holder(path: Path) -> str:
    try:
        return path.read_text(errors="replace").strip() or "(unknown)"
    except OSError:
        return "(unknown)"
