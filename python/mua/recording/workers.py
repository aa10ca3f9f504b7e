"""A recording by worker processes on this machine: each takes the next part of the plan until none is left.

Workers are processes of their own and not forks: neither Warp nor torch survives one. Each computes with one thread,
so that the bytes do not depend on how many work side by side, and ends when its standard input does: with its parent.
"""

import os
import pickle
import queue
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mua.arguments import PathLike, as_path
from mua.errors import InputError
from mua.recording import damage
from mua.recording.layout import HEADER, SHARDS
from mua.recording.parts import divide, is_joined, join_parts, longest_first, part_directory, recorded, remove_leftovers
from mua.recording.record import PlannedClip
from mua.teacher import Teacher

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
ENDED, FAILED, RECORDED = "ended", "failed", "recorded"  # kinds of messages from a worker


@dataclass(frozen=True)
class Job:
    """A worker's first message."""

    teacher: Callable[[], Teacher]  # makes one; pickles
    plan: Sequence[PlannedClip]
    directory: Path  # directory of the joined recording
    rate: float


@dataclass
class Worker:
    """A process that records."""

    process: "subprocess.Popen[bytes]"
    listener: threading.Thread | None = None
    part: int | None = None  # the part that it is recording
    idle: bool = False  # whether it knows that no part is left

    @classmethod
    def start(cls) -> "Worker":
        """Start a process; raises InputError where the machine has no room for it."""
        environment = os.environ | dict.fromkeys(THREADS, "1")
        command = [sys.executable, "-m", "mua.recording.worker"]
        try:
            process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
        except OSError as error:
            raise InputError(f"a process to record with cannot be started ({error.strerror})") from error
        return cls(process)

    def send(self, message: object) -> None:
        assert self.process.stdin is not None
        with suppress(OSError):  # it has ended; the thread that listens reports that
            pickle.dump(message, self.process.stdin)
            self.process.stdin.flush()

    def end(self) -> None:
        """Kill the process."""
        self.process.kill()
        self.process.wait()
        if self.listener is not None:
            self.listener.join()  # it ends with the pipe that it reads
        for pipe in (self.process.stdin, self.process.stdout):
            with suppress(OSError):  # for messages that it never read
                if pipe is not None:
                    pipe.close()


@dataclass
class _Crew:
    """The workers, their messages and the progress of each part."""

    job: Job
    waiting: list[Worker]
    heard: "queue.Queue[tuple[Worker, Any]]" = field(default_factory=queue.Queue)
    workers: list[Worker] = field(default_factory=list)
    done: dict[int, int] = field(default_factory=dict)  # recorded frames of each part

    def hire(self) -> None:
        """Take a worker that waits, else start one; raises InputError where the machine has no room for it."""
        worker = self.waiting.pop() if self.waiting else Worker.start()
        self.workers.append(worker)
        worker.listener = threading.Thread(target=self._listen, args=(worker,), daemon=True)
        worker.listener.start()

    def dismiss(self) -> None:
        """End all workers, at once: what they have not stored is recorded again by the next run."""
        for worker in (*self.workers, *self.waiting):
            worker.end()
        self.waiting.clear()

    def _listen(self, worker: Worker) -> None:
        """Give a worker its job, then queue its messages; in a thread, as it reads the job once it has loaded all."""
        assert worker.process.stdout is not None
        worker.send(self.job)
        try:
            while True:
                self.heard.put((worker, pickle.load(worker.process.stdout)))
        except (EOFError, OSError, pickle.UnpicklingError):
            self.heard.put((worker, None))


@contextmanager
def waiting_workers(count: int, needed: object) -> Iterator[list[Worker]]:
    """Workers that load the modules of `needed`, which pickles by its name, while their job is still being prepared.

    Those that no recording has taken end with the block. Raises InputError where the machine has no room for them.
    """
    waiting: list[Worker] = []
    try:
        for _ in range(count):
            waiting.append(Worker.start())
            waiting[-1].send(needed)
        yield waiting
    finally:
        for worker in waiting:
            worker.end()


def record_by_workers(
    teacher: Callable[[], Teacher],  # makes one; pickles
    plan: Sequence[PlannedClip],
    directory: PathLike,
    *,
    jobs: int,  # processes at most
    rate: float,
    waiting: list[Worker] | None = None,  # of waiting_workers; it is empty then
    progress: Callable[[int, int], None] = lambda done, workers: None,
    note: Callable[[str], None] = lambda sentence: None,
) -> None:
    """Record a plan by processes side by side, going on where an earlier run stopped, and join its parts.

    Damaged parts of an earlier run are removed and recorded again; `note` is called with a sentence about each.
    `progress` is called with how many of all wanted frames are recorded, and by how many processes. Raises InputError
    as `TeacherWriter`, `record` and `join_parts` do, and where a worker ends before its work does.
    """
    directory = as_path(directory, "directory")
    parts = divide(plan)
    _remove_damaged(directory, plan, rate=rate, whole=True, note=note)
    for part, clips in enumerate(parts):
        _remove_damaged(part_directory(directory, part, len(parts)), clips, rate=rate, whole=False, note=note)
    if not is_joined(directory):
        directory.parent.mkdir(parents=True, exist_ok=True)
        crew = _Crew(Job(teacher, plan, directory, rate), [] if waiting is None else waiting)
        left = [part for part in longest_first(parts) if not _finished(crew, parts, part)]
        try:
            for _ in range(min(jobs, len(left))):
                crew.hire()
            _work_off(crew, left, progress)
        finally:
            crew.dismiss()
            remove_leftovers(directory, len(parts))
    join_parts(directory, plan)


def _remove_damaged(
    directory: Path, plan: Sequence[PlannedClip], *, rate: float, whole: bool, note: Callable[[str], None]
) -> None:
    """Remove a recording that differs from what was written."""
    if not any((directory / name).exists() for name in (HEADER, SHARDS)):
        return
    try:
        damage.check(directory, plan, rate=rate, whole=whole)
    except InputError as error:
        note(f"{error}. It is recorded again.")
        shutil.rmtree(directory)


def _finished(crew: _Crew, parts: Sequence[Sequence[PlannedClip]], part: int) -> bool:
    frames, finished = recorded(parts[part], part_directory(crew.job.directory, part, len(parts)))
    crew.done[part] = frames
    return finished


def _work_off(crew: _Crew, left: list[int], progress: Callable[[int, int], None]) -> None:
    """Hand out parts until all have ended."""
    progress(sum(crew.done.values()), len(crew.workers))
    waiting, running = list(left), len(left)
    while running:
        worker, message = crew.heard.get()
        if message is None and worker.idle:
            continue
        if message is None:
            raise InputError(_lost(worker))
        kind, value = message
        if kind == FAILED:
            raise InputError(value)
        if kind == RECORDED and worker.part is not None:
            crew.done[worker.part] = value
            progress(sum(crew.done.values()), len(crew.workers))
        if kind == ENDED:  # also sent once when a worker is ready
            running -= worker.part is not None
            worker.part = waiting.pop(0) if waiting else None
            worker.idle = worker.part is None
            worker.send(worker.part)


def _lost(worker: Worker) -> str:
    status = worker.process.wait()
    how = f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"
    return (
        f"a process that records {how}, perhaps for want of memory; the same command goes on from what is stored, "
        "--jobs 1 takes the least memory"
    )
