"""A process that records parts of a plan for the one that started it (mua.recording.workers).

It reads a job and then numbers of parts from standard input, and says on standard output what it has done. What comes
before the job is only loaded.
"""

import os
import pickle
import queue
import signal
import threading
from functools import cache
from typing import IO, Any

import torch

from mua.errors import InputError
from mua.recording.parts import divide, first_texture, part_directory, record_part
from mua.recording.workers import ENDED, FAILED, RECORDED, Job


def main() -> None:
    """Record requested parts until standard input ends or says that no part is left."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the parent too, which ends this process
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of libraries must not come between the answers
    torch.set_num_threads(1)
    asked: queue.Queue[Any] = queue.Queue()
    threading.Thread(target=_listen, args=(os.fdopen(os.dup(0), "rb"), asked), daemon=True).start()
    try:
        _record(asked, answers)
    except InputError as error:
        _send(answers, FAILED, str(error))
    except MemoryError:
        _send(answers, FAILED, "a process that records has too little memory; --jobs 1 needs the least")
    os._exit(0)  # without waiting for the thread that still listens


def _record(asked: "queue.Queue[Any]", answers: IO[bytes]) -> None:
    while not isinstance(job := asked.get(), Job):
        pass
    teacher, parts = job.teacher(), divide(job.plan)
    reference = cache(lambda: first_texture(teacher, job.plan))
    _send(answers, ENDED, None)
    while (part := asked.get()) is not None:
        record_part(
            teacher,
            parts[part],
            part_directory(job.directory, part, len(parts)),
            reference=reference,
            rate=job.rate,
            durable=False,
            progress=lambda done: _send(answers, RECORDED, done),
        )
        _send(answers, ENDED, part)


def _listen(requests: IO[bytes], asked: "queue.Queue[Any]") -> None:
    """Queue requests; end when the parent has ended, because its next run writes the same files."""
    try:
        while True:
            asked.put(pickle.load(requests))
    except (EOFError, OSError, pickle.UnpicklingError):
        os._exit(1)


def _send(answers: IO[bytes], kind: str, value: object) -> None:
    pickle.dump((kind, value), answers)
    answers.flush()


if __name__ == "__main__":
    main()
