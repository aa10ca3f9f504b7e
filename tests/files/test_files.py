"""Atomic writes: all or nothing, and a sentence where the system refuses."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from mua.errors import InputError
from mua.files.write import missing_directory, remove_leftovers, replacing, require_writable, write_bytes


def test_replaces_the_whole_content_and_leaves_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "new" / "a.txt"
    for content in (b"first", b"no"):
        write_bytes(path, content)
        assert path.read_bytes() == content
    assert list(path.parent.iterdir()) == [path]


def test_the_whole_content_is_on_the_disk_before_it_replaces_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, synced = tmp_path / "a.txt", []

    def fsync(number: int) -> None:
        synced.append((os.fstat(number).st_ino, os.fstat(number).st_size, path.read_bytes()))

    path.write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", fsync)
    write_bytes(path, b"another")
    assert synced == [(path.stat().st_ino, len(b"another"), b"old")]


def write_half(path: Path, error: BaseException) -> None:
    with replacing(path) as temporary:
        temporary.write_bytes(b"half")
        raise error


@pytest.mark.parametrize("kind", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
def test_a_failed_write_keeps_the_old_content(tmp_path: Path, kind: BaseException) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes(b"old")
    with pytest.raises((InputError, KeyboardInterrupt)):
        write_half(path, kind)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_is_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    with pytest.raises(InputError, match=r"a\.txt: cannot be written \(No space left on device\)$"), replacing(path):
        raise OSError(errno.ENOSPC, "No space left on device")


def test_an_error_about_another_file_stays_what_it_is(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), replacing(tmp_path / "a.txt"):
        (tmp_path / "other.txt").read_bytes()


def test_a_file_in_the_place_of_the_directory_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for write in (require_writable, lambda path: write_bytes(path, b"")):
        with pytest.raises(InputError, match=r"file is no directory\)"):
            write(tmp_path / "file" / "a.txt")


def test_asking_whether_a_file_can_be_written_writes_none(tmp_path: Path) -> None:
    path = tmp_path / "new" / "a.txt"
    require_writable(path)
    assert list(path.parent.iterdir()) == []
    path.write_bytes(b"old")
    require_writable(path)
    assert path.read_bytes() == b"old"


def ended() -> int:
    """The id of a process that is no more."""
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        return process.pid


def test_leftovers_of_this_file_alone_are_removed(tmp_path: Path) -> None:
    gone = ended()
    names = ("a[1].txt", f".a1.{gone}.part.txt", f".a[1].{gone}.part.png", f"b.{gone}.part.txt")
    kept = [tmp_path / name for name in names]
    left = [tmp_path / f".a[1].{writer}.part.txt" for writer in (gone, os.getpid(), 10**30, "0x", "")]
    for path in (*kept, *left):
        path.touch()
    remove_leftovers(tmp_path / "a[1].txt")
    assert set(tmp_path.iterdir()) == set(kept)


@pytest.mark.skipif(sys.platform == "win32", reason="needs Linux or macOS: Windows keeps files that are open")
def test_what_another_process_is_writing_is_no_leftover(tmp_path: Path) -> None:
    """Two commands may be given the same output; one that begins must not spoil the end of the other."""
    writing = (
        "import sys; from pathlib import Path; from mua.files.write import replacing\n"
        "with replacing(Path(sys.argv[1])) as temporary:\n"
        "    temporary.write_bytes(b'first half'); print(temporary, flush=True); sys.stdin.read()"
    )
    path = tmp_path / "a.txt"
    command = [sys.executable, "-c", writing, str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        temporary = Path(other.stdout.readline().strip())
        remove_leftovers(path)
        assert temporary.exists()
        other.communicate("")
    assert other.returncode == 0
    assert path.read_bytes() == b"first half"
    assert list(tmp_path.iterdir()) == [path]


def test_the_directory_that_would_be_made_is_the_highest_that_is_missing(tmp_path: Path) -> None:
    assert missing_directory(tmp_path, option="-o") is None
    assert missing_directory(tmp_path / "a" / "b", option="-o") == tmp_path / "a"
    assert list(tmp_path.iterdir()) == []


def test_no_directory_is_made_at_the_root_of_a_disk() -> None:
    with pytest.raises(InputError, match=r"-o /no such/place: there is no directory /no such; create it first"):
        missing_directory(Path("/no such/place"), option="-o")


def test_a_file_is_no_directory_to_write_in(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"--work .*: .*file is no directory"):
        missing_directory(tmp_path / "file" / "a", option="--work")
