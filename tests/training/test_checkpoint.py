"""Checkpoints are whole, belong to one run, and are ignored where they are damaged."""

import errno
import io
import pickle
from pathlib import Path
from types import SimpleNamespace
from typing import Any, BinaryIO

import pytest
import torch

from mua.errors import InputError
from mua.training.checkpoint import Checkpoints, run_key


def test_returns_what_was_saved(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path, "a")
    checkpoints.save("stage", {"step": 3, "weight": torch.arange(5)})
    kept = checkpoints.load("stage")
    assert kept is not None
    assert kept["step"] == 3
    assert torch.equal(kept["weight"], torch.arange(5))


def test_nothing_is_kept_of_a_new_stage(tmp_path: Path) -> None:
    assert Checkpoints(tmp_path / "new", "a").load("stage") is None


def test_ignores_the_checkpoint_of_another_run(tmp_path: Path) -> None:
    Checkpoints(tmp_path, "a").save("stage", {"step": 3})
    assert Checkpoints(tmp_path, "b").load("stage") is None


def test_ignores_a_file_truncated_anywhere(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path, "a")
    checkpoints.save("stage", {"step": 3, "weight": torch.arange(5)})
    path = tmp_path / "stage.pt"
    whole = path.read_bytes()
    assert len(whole) > 100
    for length in range(0, len(whole), 7):
        path.write_bytes(whole[:length])
        assert checkpoints.load("stage") is None, length


@pytest.mark.parametrize("content", [b"no archive", b"\x80\x02K\x03.", bytes(100)])
def test_ignores_what_is_no_checkpoint(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "stage.pt").write_bytes(content)
    assert Checkpoints(tmp_path, "a").load("stage") is None


class Hostile:
    """An object that runs a function when it is unpickled carelessly."""

    def __init__(self, made: Path) -> None:
        self.made = made

    def __reduce__(self) -> tuple[object, ...]:
        return Path.mkdir, (self.made,)


@pytest.mark.parametrize("archive", [False, True])
def test_a_checkpoint_runs_no_code(tmp_path: Path, archive: bool) -> None:
    checkpoints, made = Checkpoints(tmp_path, "a"), tmp_path / "made"
    if archive:
        torch.save({"key": "a", "state": Hostile(made)}, tmp_path / "stage.pt")
    else:
        (tmp_path / "stage.pt").write_bytes(pickle.dumps(Hostile(made), protocol=2))
    assert checkpoints.load("stage") is None
    assert not made.exists()


def test_a_stage_is_finished_unless_it_says_otherwise(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path, "a")
    assert not checkpoints.finished("stage")
    for state, finished in (({"step": 3}, True), ({"finished": False}, False), ({"finished": True}, True)):
        checkpoints.save("stage", state)
        assert checkpoints.finished("stage") == finished


class Full(io.RawIOBase):
    """A file on a disk with little room, after which torch complains about where the file stands."""

    def writable(self) -> bool:
        return True

    def write(self, content: Any) -> int:
        if memoryview(content).nbytes > 1000:
            raise OSError(errno.ENOSPC, "No space left on device")
        return memoryview(content).nbytes


def test_a_full_disk_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """torch itself reports only a failure of its archive."""
    checkpoints, save = Checkpoints(tmp_path, "a"), torch.save
    checkpoints.save("stage", {"step": 1})
    monkeypatch.setattr(torch, "save", lambda state, _: save(state, Full()))  # type: ignore[arg-type]
    with pytest.raises(RuntimeError, match="unexpected pos"):
        save({"weight": torch.zeros(100_000)}, Full())  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"stage\.pt.*No space left on device"):
        checkpoints.save("stage", {"weight": torch.zeros(100_000)})
    assert checkpoints.load("stage") == {"step": 1}


def test_ignores_an_archive_of_something_else(tmp_path: Path) -> None:
    torch.save(torch.arange(5), tmp_path / "stage.pt")
    assert Checkpoints(tmp_path, "a").load("stage") is None


def test_a_failed_save_leaves_the_old_state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    checkpoints = Checkpoints(tmp_path, "a")
    checkpoints.save("stage", {"step": 1})

    def half(content: object, file: BinaryIO) -> None:
        file.write(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(torch, "save", half)
    with pytest.raises(KeyboardInterrupt):
        checkpoints.save("stage", {"step": 2})
    monkeypatch.undo()
    assert checkpoints.load("stage") == {"step": 1}
    assert [path.name for path in tmp_path.iterdir()] == ["stage.pt"]


def test_key_depends_on_settings_and_inputs() -> None:
    x = torch.arange(6.0)
    keys = {run_key("a", [x]), run_key("b", [x]), run_key("a", [x + 1])}
    assert len(keys) == 3
    assert run_key("a", [x]) == run_key("a", [x.clone()])


def test_what_another_version_of_mua_trained_is_another_run(monkeypatch: pytest.MonkeyPatch) -> None:
    now = run_key("a", [])
    monkeypatch.setattr("mua.training.checkpoint.__version__", "another")
    assert run_key("a", []) != now


def test_of_several_processes_the_first_alone_writes(tmp_path: Path) -> None:
    others = SimpleNamespace(first=False)
    Checkpoints(tmp_path, "key", others).save("stage", {"step": 1})  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []
