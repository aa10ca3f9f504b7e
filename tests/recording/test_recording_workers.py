"""Worker processes record what a single one would, survive kills, and end with their parent."""

import errno
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Container, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from recordings import RATE, FormulaTeacher, content, plan
from synthetic_avatar import synthetic_rig

from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.recording import workers
from mua.recording.parts import divide, is_joined, join_parts, record_share, share
from mua.recording.workers import record_by_workers, waiting_workers
from mua.rig.rig import Rig
from mua.teacher import TeacherFrame

TESTS = Path(__file__).parent


class Disturbed(FormulaTeacher):
    """Calls `disturb` with a flag's path at the last frame of "walk", which two shards come before."""

    def __init__(self, rig: Rig, flag: Path) -> None:
        super().__init__(rig)
        self.flag = flag

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        for index, frame in enumerate(super().frames(clip, wanted)):
            if clip.name == "walk" and index == 22:
                self.disturb()
            yield frame

    def disturb(self) -> None: ...


class Dying(Disturbed):
    """Is killed the first time."""

    def disturb(self) -> None:
        if not self.flag.exists():
            self.flag.touch()
            os.kill(os.getpid(), signal.SIGKILL)


class Refusing(Disturbed):
    def disturb(self) -> None:
        raise InputError("clip 'walk': a texel is not finite")


class Waiting(Disturbed):
    """Writes its process id and waits, the first time."""

    def disturb(self) -> None:
        if not self.flag.exists():
            self.flag.write_text(str(os.getpid()))
            time.sleep(600)


@pytest.fixture(autouse=True)
def _importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers find the teachers of this file."""
    monkeypatch.setenv(
        "PYTHONPATH", os.pathsep.join([str(TESTS), str(TESTS.parent / "fixtures"), os.environ.get("PYTHONPATH", "")])
    )


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The parts of a single process, joined."""
    directory, teacher = tmp_path_factory.mktemp("alone") / "recording", FormulaTeacher(synthetic_rig())
    record_share(teacher, plan(teacher.rig), directory, rank=0, count=1, rate=RATE)
    join_parts(directory, plan(teacher.rig))
    return directory


def run(directory: Path, teacher: type[FormulaTeacher], *arguments: object, **more: object) -> None:
    make, planned = partial(teacher, synthetic_rig(), *arguments), plan(synthetic_rig())
    record_by_workers(make, planned, directory, **({"jobs": 2, "rate": RATE} | more))  # type: ignore[arg-type]


@pytest.mark.parametrize("jobs", [1, 2])
def test_any_number_of_workers_leaves_the_same_files(
    alone: Path, tmp_path: Path, jobs: int, request: pytest.FixtureRequest
) -> None:
    if jobs == 1:
        request.getfixturevalue("forked")  # the others are started as a bake starts them
    heard: list[tuple[int, int]] = []
    run(tmp_path / "r", FormulaTeacher, jobs=jobs, progress=lambda done, working: heard.append((done, working)))
    assert content(tmp_path / "r") == content(alone)
    assert list(tmp_path.iterdir()) == [tmp_path / "r"]
    wanted = sum(len(clip.wanted) for clip in plan(synthetic_rig()))
    assert heard[0] == (0, jobs)
    assert heard[-1] == (wanted, jobs)
    assert sorted(heard) == heard


def test_each_worker_computes_with_one_thread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Several with as many threads as there are cores hinder each other."""
    program = tmp_path / "python"
    program.write_text("#!/bin/sh\nenv\n")
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(program))
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    worker = workers.Worker.start()
    assert worker.process.stdout is not None
    seen = worker.process.stdout.read().decode().splitlines()
    worker.end()
    assert {f"{name}_NUM_THREADS=1" for name in ("OMP", "OPENBLAS", "MKL")} <= set(seen)


@pytest.mark.usefixtures("forked")
def test_everything_is_on_the_disk_once_the_parts_are_joined(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers do not wait for it."""
    fsync, synced = os.fsync, set()

    def syncing(descriptor: int) -> None:
        synced.add(os.fstat(descriptor).st_ino)
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", syncing)
    run(tmp_path / "r", FormulaTeacher, jobs=1)
    assert {path.stat().st_ino for path in (tmp_path, tmp_path / "r", *(tmp_path / "r").rglob("*"))} <= synced


@pytest.mark.usefixtures("forked")
def test_a_killed_worker_is_reported_and_the_next_run_ends_in_the_same_files(alone: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a process that records was ended by signal 9, perhaps for want of memory"):
        run(tmp_path / "r", Dying, tmp_path / "flag")
    assert not is_joined(tmp_path / "r")
    assert not list(tmp_path.rglob(".*.part"))  # leftovers may be what fills the disk
    run(tmp_path / "r", Dying, tmp_path / "flag", jobs=1)
    assert content(tmp_path / "r") == content(alone)


@pytest.mark.usefixtures("forked")
def test_what_a_worker_refuses_is_its_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^clip 'walk': a texel is not finite$"):
        run(tmp_path / "r", Refusing, tmp_path / "flag", jobs=1)


def ended(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().split(")")[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


@pytest.mark.usefixtures("forked")  # the last run; the killed one starts its own
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for the worker in /proc, which Linux has")
def test_workers_end_with_a_killed_parent_and_the_next_run_ends_in_the_same_files(alone: Path, tmp_path: Path) -> None:
    flag = tmp_path / "flag"
    code = (
        "import sys; from pathlib import Path; from test_recording_workers import Waiting, run;"
        "run(Path(sys.argv[1]), Waiting, Path(sys.argv[2]))"
    )
    parent = subprocess.Popen([sys.executable, "-c", code, str(tmp_path / "r"), str(flag)])
    while not (flag.exists() and flag.read_text()):
        assert parent.poll() is None
        time.sleep(0.01)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    while not ended(int(flag.read_text())):
        time.sleep(0.01)
    run(tmp_path / "r", Waiting, flag, jobs=1)
    assert content(tmp_path / "r") == content(alone)


@pytest.mark.usefixtures("forked")
def test_workers_that_have_waited_leave_the_same_files_and_end(alone: Path, tmp_path: Path) -> None:
    with waiting_workers(3, FormulaTeacher) as waiting:
        processes = [worker.process for worker in waiting]
        run(tmp_path / "r", FormulaTeacher, waiting=waiting)
        assert not waiting
        assert all(process.poll() is not None for process in processes)  # also the one that two jobs did not need
    assert content(tmp_path / "r") == content(alone)


@pytest.mark.usefixtures("forked")
def test_workers_whose_job_does_not_come_end() -> None:
    with waiting_workers(2, FormulaTeacher) as waiting:
        processes = [worker.process for worker in waiting]
        assert [process.poll() for process in processes] == [None, None]
    assert all(process.poll() is not None for process in processes)


@pytest.mark.usefixtures("forked")
def test_an_interrupt_ends_all_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    popen, started = workers.subprocess.Popen, []

    def start(*arguments: Any, **more: Any) -> Any:
        started.append(popen(*arguments, **more))
        return started[-1]

    def interrupt(done: int, working: int) -> None:
        if done:
            raise KeyboardInterrupt

    monkeypatch.setattr(workers.subprocess, "Popen", start)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path / "r", Waiting, tmp_path / "flag", progress=interrupt)
    assert len(started) == 2
    assert all(process.poll() is not None for process in started)


@pytest.mark.usefixtures("forked")
@pytest.mark.parametrize("joined", [True, False])
def test_a_damaged_recording_is_reported_and_recorded_again(alone: Path, tmp_path: Path, joined: bool) -> None:
    directory, teacher = tmp_path / "r", FormulaTeacher(synthetic_rig())
    damaged = directory if joined else directory.with_name("r.part-1-of-3")
    if joined:
        shutil.copytree(alone, directory)
    else:
        record_share(teacher, plan(teacher.rig), directory, rank=0, count=1, rate=RATE)
    (damaged / "shards/00000/whole_00000.npy").unlink()
    notes: list[str] = []
    run(directory, FormulaTeacher, jobs=1, note=notes.append)
    (sentence,) = notes
    assert sentence.startswith(f"{damaged / 'shards/00000/whole_00000.npy'} is missing")
    assert sentence.endswith(". It is recorded again.")
    assert content(directory) == content(alone)


@pytest.mark.usefixtures("forked")
def test_what_an_undisturbed_run_left_is_not_recorded_anew(alone: Path, tmp_path: Path) -> None:
    """Its finished parts are handed to no worker: there are only as many workers as parts are left."""
    directory, teacher = tmp_path / "r", FormulaTeacher(synthetic_rig())
    record_share(teacher, plan(teacher.rig), directory, rank=0, count=2, rate=RATE)  # the parts of one of two
    parts = divide(plan(teacher.rig))
    finished = share(parts, 0, 2)
    done = sum(len(clip.wanted) for part in finished for clip in parts[part])
    notes: list[str] = []
    heard: list[tuple[int, int]] = []
    run(directory, FormulaTeacher, jobs=len(parts), note=notes.append, progress=lambda *now: heard.append(now))
    assert heard[0] == (done, len(parts) - len(finished))
    run(directory, FormulaTeacher, note=notes.append)
    assert notes == []
    assert content(directory) == content(alone)


def test_parts_that_find_no_room_to_be_joined_are_kept(
    alone: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    directory, teacher = tmp_path / "r", FormulaTeacher(synthetic_rig())
    record_share(teacher, plan(teacher.rig), directory, rank=0, count=1, rate=RATE)
    parts = sorted(tmp_path.iterdir())

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as small:
        small.setattr("numpy.save", full)
        with pytest.raises(InputError, match=r"r: cannot be written \(No space left on device\); all frames are kept"):
            join_parts(directory, plan(teacher.rig))
    assert sorted(tmp_path.iterdir()) == parts
    join_parts(directory, plan(teacher.rig))
    assert content(directory) == content(alone)


def test_a_finished_recording_starts_no_worker(alone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = content(alone)
    monkeypatch.delattr(workers.subprocess, "Popen")
    run(alone, FormulaTeacher)
    assert content(alone) == before
