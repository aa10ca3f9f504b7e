"""Readers in other languages, as programs that stay: given file after file, they answer each in a line."""

import os
import select
import signal
import struct
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Self

SECONDS = 60.0  # for one small file, which takes milliseconds: beyond them a reader hangs


class Hangs(Exception):
    """Nothing came within the time."""


class Reader:
    """A program that reads files from its standard input, each after its length as four bytes."""

    def __init__(self, command: Sequence[object], *, seconds: float = SECONDS) -> None:
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  open as long as the program runs
        line = [str(part) for part in command]
        self._process = subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said)
        self._seconds = seconds
        self._came = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._process.kill()
        self._process.communicate()
        self._said.close()

    def give(self, content: bytes) -> None:
        """Hand a file over; the answer to the one before must have been taken."""
        assert self._process.stdin
        try:
            self._process.stdin.write(struct.pack("<I", len(content)) + content)
            self._process.stdin.flush()
        except BrokenPipeError:
            pass  # the answer says why

    def answer(self) -> str:
        """What it says of the file. Errors: Hangs; ChildProcessError with the words of a program that has ended."""
        assert self._process.stdout
        until = time.monotonic() + self._seconds
        while b"\n" not in self._came:
            if not select.select([self._process.stdout], [], [], max(until - time.monotonic(), 0))[0]:
                raise Hangs(f"no answer within {self._seconds:g} s")
            part = os.read(self._process.stdout.fileno(), 1 << 16)
            if not part:
                raise ChildProcessError(self._last_words())
            self._came += part
        line, self._came = self._came.split(b"\n", 1)
        return line.decode()

    def _last_words(self) -> str:
        ended = self._process.wait()
        self._said.seek(0)
        return f"the program has ended with {ended}: {self._said.read()[-4000:].decode(errors='replace')}"


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """What this process does in the block is broken off by Hangs after so many seconds."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise Hangs(f"no answer within {seconds:g} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
