"""Draws faces in a process beside this one: a file's own while its splats are made, then those of the splats.

The process is this module as a program: it reads a source, a skeleton and the names of expressions from standard input
and writes images to standard output, then reads a still face and writes its images. It is a process because OpenGL
holds Python's lock while it draws.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from queue import SimpleQueue
from typing import IO, Self

from mua.atlas.surfaces import Surfaces
from mua.errors import InputError
from mua.fidelity.canvas import opened
from mua.fidelity.posing import Poser
from mua.fidelity.source_faces import Patch, source_faces
from mua.fidelity.splat_faces import StillFace, splat_faces

FEWEST = 16  # expressions: fewer are drawn sooner than a process starts


class FaceProcess:
    """The process, where there is one; it ends with the block."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._thread = ThreadPoolExecutor(1)  # one question after the other
        self._source: Iterator[Patch] = iter(())
        self._splats: Iterator[Patch] = iter(())

    def __enter__(self) -> Self:
        return self

    def begin(self, surfaces: Surfaces) -> None:
        """Draw the source's faces of a character with so many expressions that they are worth a process."""
        source, expressions = surfaces.source, surfaces.expressions
        if source is None or expressions is None or len(expressions) < FEWEST:
            return
        command = [sys.executable, "-m", "mua.fidelity.face_process"]
        pipe = subprocess.PIPE
        try:
            self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL)
        except OSError:  # no room for it: the faces are then drawn here
            return
        self._source = self._answers((source, surfaces.skeleton, expressions.names), 1 + len(expressions))

    def go_on(self, face: StillFace) -> None:
        """Draw the faces of the splats as well, where there is a process."""
        if self._process is not None:
            self._splats = self._answers(face, 1 + len(face.expressions))

    def source(self) -> Iterator[Patch]:
        """As of `source_faces`, as soon as they are drawn; none or not all where no process draws them."""
        return self._source

    def splats(self) -> Iterator[Patch]:
        """As of `splat_faces`, likewise."""
        return self._splats

    def _answers(self, job: object, count: int) -> Iterator[Patch]:
        assert self._process is not None
        answers: SimpleQueue[Patch | None] = SimpleQueue()
        self._thread.submit(_hear, self._process, job, count, answers)
        return iter(answers.get, None)

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
        self._thread.shutdown()
        if self._process is not None:
            for pipe in (self._process.stdin, self._process.stdout):
                with suppress(OSError):  # for what it has not read
                    if pipe is not None:
                        pipe.close()


def _hear(
    process: "subprocess.Popen[bytes]",
    job: object,
    count: int,
    answers: "SimpleQueue[Patch | None]",  # what the process draws; None after the last, or where it ends before
) -> None:
    assert process.stdin is not None
    assert process.stdout is not None
    with suppress(EOFError, OSError, pickle.UnpicklingError):
        pickle.dump(job, process.stdin)
        process.stdin.flush()
        for _ in range(count):
            answers.put(pickle.load(process.stdout))
    answers.put(None)


def _answer(patches: Iterable[Patch], answers: IO[bytes]) -> None:
    for patch in patches:
        pickle.dump(patch, answers)
    answers.flush()


def main() -> None:
    """Draw what standard input asks for; nothing where this machine has no OpenGL."""
    source, skeleton, names = pickle.load(sys.stdin.buffer)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of drivers must not come between the images
    with suppress(InputError, EOFError), opened() as context, answers:
        _answer(source_faces(context, source.scene, Poser(source, skeleton).rest(), names), answers)
        _answer(splat_faces(context, pickle.load(sys.stdin.buffer)), answers)


if __name__ == "__main__":
    main()
