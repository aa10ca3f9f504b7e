"""Part of a bake in a fork of this process, all of whose memory the system takes back when that part ends.

Textures, OpenGL and Warp leave a heap in pieces, which would otherwise stay while a student is distilled. A fork shares
the modules that are loaded; a second interpreter would take seconds to load them again.
"""

import ctypes
import gc
import os
import signal
import sys
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from operator import methodcaller
from typing import Any, Generic, TypeVar

import torch

from mua.baking.listener import Listener
from mua.errors import InputError

R = TypeVar("R")
PARENT_DEATH = 1  # PR_SET_PDEATHSIG of Linux' prctl.h


@dataclass(frozen=True)
class _Result(Generic[R]):
    """The last message of a fork."""

    value: R


def can_fork() -> bool:
    """Whether this system forks, and has no GPU, whose driver does not survive it."""
    return sys.platform == "linux" and not torch.cuda.is_available()


def in_fork(work: Callable[[Listener], R], listener: Listener) -> R:
    """What `work` returns or raises in a fork of this process; `listener` hears of its progress here.

    Nothing may have computed with torch in this process, as its threads do not survive a fork. The fork ends with this
    process, however that one ends. Raises InputError where the fork is killed.
    """
    torch.optim.Adam([torch.zeros(1)])  # the first one loads hundreds of modules: once, for both processes
    gc.freeze()  # the collector writes to what it looks at, and would copy the memory that is shared
    context = get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(work, theirs, ours))
    with ours:
        with theirs, warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of Python 3.12: OpenBLAS has threads, which survive
            try:
                process.start()
            except OSError as error:
                raise InputError(f"a process to record with cannot be started ({error.strerror})") from error
        try:
            while isinstance(message := _received(ours, process), methodcaller):
                message(listener)
            process.join()
        finally:
            process.terminate()  # has no effect on one that has ended
            process.join()
    if isinstance(message, Exception):
        raise message
    return message.value


def _received(ours: Connection, process: BaseProcess) -> Any:
    """The next message of a fork; raises InputError where it ends without one."""
    try:
        return ours.recv()
    except (EOFError, OSError):  # killed between messages or within one
        process.join()
    status = process.exitcode or 0
    how = f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"
    raise InputError(
        f"the process that fits and records {how}, perhaps for want of memory; "
        "the same command goes on from what is stored"
    )


def _work(work: Callable[[Listener], object], theirs: Connection, ours: Connection) -> None:
    """Work in the fork and send what comes of it."""
    ctypes.CDLL(None).prctl(PARENT_DEATH, signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the parent too, which terminates this process
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    ours.close()
    try:
        theirs.send(_Result(work(_Sender(theirs))))
    except Exception as error:
        if not isinstance(error, InputError):
            error.add_note(traceback.format_exc())  # of this process; pickling leaves it out
        theirs.send(error)
    except KeyboardInterrupt:
        os._exit(1)  # nobody listens any more
    os._exit(0)  # what else there is to clear up is the parent's


class _Sender:
    """The listener of a fork."""

    def __init__(self, theirs: Connection) -> None:
        self._theirs = theirs

    def stage(self, name: str) -> None:
        self._theirs.send(methodcaller("stage", name))

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        self._theirs.send(methodcaller("step", done, total, detail=detail))

    def note(self, sentence: str) -> None:
        self._theirs.send(methodcaller("note", sentence))
