"""One process at a time in a directory, whatever happened to earlier ones."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from mua.errors import InputError
from mua.files import lock as locks
from mua.files.lock import DirectoryLock

HOLD = (
    "import sys, time; from pathlib import Path; from mua.files.lock import DirectoryLock;"
    "lock = DirectoryLock(Path(sys.argv[1]), name='it'); print('held', flush=True); time.sleep(600)"
)
# Ten times: wait for the directory, and find no mark of another process in it.
TAKE_TURNS = """
import sys, time
from pathlib import Path
from mua.files import lock as locks
from mua.files.lock import DirectoryLock
locks.TIMEOUT = 600
directory = Path(sys.argv[1])
for _ in range(10):
    with DirectoryLock(directory, name="it"):
        mark = directory / "mark"
        mark.open("x").close()
        time.sleep(0.001)
        mark.unlink()
"""


def program(code: str, *arguments: object) -> "subprocess.Popen[str]":
    return subprocess.Popen([sys.executable, "-c", code, *map(str, arguments)], stdout=subprocess.PIPE, text=True)


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(locks, "TIMEOUT", 0.1)


def test_a_second_process_is_refused_until_the_first_is_killed(tmp_path: Path) -> None:
    with program(HOLD, tmp_path) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "held\n"
        with pytest.raises(InputError, match=f"^--work w: process {other.pid} is using it; wait until that has"):
            DirectoryLock(tmp_path, name="--work w")
        other.kill()
    with DirectoryLock(tmp_path, name="--work w"):
        assert (tmp_path / locks.NAME).read_text() == str(os.getpid())


@pytest.mark.parametrize("left", [b"", b"1", b"999999", b"\xff no number"])
def test_the_file_of_a_process_that_is_gone_locks_nobody_out(tmp_path: Path, left: bytes) -> None:
    (tmp_path / locks.NAME).write_bytes(left)
    with DirectoryLock(tmp_path, name="it"):
        assert (tmp_path / locks.NAME).read_text() == str(os.getpid())


def test_nothing_but_what_was_there_before_is_left(tmp_path: Path) -> None:
    with DirectoryLock(tmp_path / "new" / "work", name="it"):
        assert (tmp_path / "new" / "work" / locks.NAME).exists()
    assert list(tmp_path.iterdir()) == [tmp_path / "new"]
    assert list((tmp_path / "new").iterdir()) == []
    (tmp_path / "file").touch()
    with DirectoryLock(tmp_path, name="it"):
        pass
    assert sorted(tmp_path.iterdir()) == [tmp_path / "file", tmp_path / "new"]


def test_processes_that_come_and_go_are_never_there_together(tmp_path: Path) -> None:
    everyone = [program(TAKE_TURNS, tmp_path / "work") for _ in range(4)]
    for process in everyone:
        process.communicate()
    assert [process.returncode for process in everyone] == [0] * 4
    assert not (tmp_path / "work").exists()


def test_a_lock_is_let_go_with_its_holder(tmp_path: Path) -> None:
    DirectoryLock(tmp_path, name="it")  # nobody keeps it
    DirectoryLock(tmp_path, name="it").release()


def test_a_directory_below_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for directory in (tmp_path / "file", tmp_path / "file" / "work", tmp_path / "file" / "a" / "work"):
        with pytest.raises(InputError, match=rf"^--work w: cannot be written \({tmp_path / 'file'} is no directory\)$"):
            DirectoryLock(directory, name="--work w")


def test_a_place_where_nothing_can_be_written_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def read_only(path: Path, *_: object) -> int:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    monkeypatch.setattr(os, "open", read_only)
    with pytest.raises(InputError, match=r"^--work w: cannot be written \(Read-only file system\)$"):
        DirectoryLock(tmp_path, name="--work w")


def test_a_file_system_without_locks_is_used_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fcntl = pytest.importorskip("fcntl", reason="needs fcntl: Linux or macOS; Windows locks otherwise")

    def without(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(fcntl, "flock", without)
    with DirectoryLock(tmp_path, name="it"):
        pass
