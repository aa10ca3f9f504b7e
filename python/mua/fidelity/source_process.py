"""Draws a character's file in a process beside this one, while its splats are made, and then faces together with it.

The process is this module as a program: it reads a source, a skeleton and the names of expressions from standard input
and writes images to standard output, then poses and writes theirs, then a still face. It is a process because OpenGL
holds Python's lock while it draws.
"""

import itertools
import os
import pickle
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from typing import IO, Any, Self, TypeVar

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.errors import InputError
from mua.fidelity.canvas import opened
from mua.fidelity.posed_source import Poser
from mua.fidelity.source_faces import Patch, source_faces
from mua.fidelity.source_poses import Sitting, source_poses
from mua.fidelity.splat_faces import SplatFaces, StillFace

FEW = 16  # expressions: fewer, of fewer triangles than these, are drawn sooner than a process starts
SMALL = 10_000
LARGE = 1_000_000  # bytes of a file that, as a rule, has more
T = TypeVar("T")


class SourceProcess:
    """The process, where there is one; it ends with the block."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._thread = ThreadPoolExecutor(1)  # one question after the other
        self._faces: Iterator[Patch] = iter(())
        self._poses: Iterator[Array] = iter(())
        self._splat_faces: SimpleQueue[Any] = SimpleQueue()  # patches; None where the process ends

    def __enter__(self) -> Self:
        return self

    def expect(self, file: Path | None) -> None:
        """Start the process while a character's file is read that probably has much to draw, as large as it is."""
        with suppress(OSError):  # what is wrong with a file, its reader says
            if file is not None and file.stat().st_size > LARGE:
                self._start()

    def begin(self, surfaces: Surfaces) -> None:
        """Begin with the faces, for a character that has so much to draw that it is worth a process."""
        source, names = surfaces.source, () if surfaces.expressions is None else surfaces.expressions.names
        if source is None or (len(names) < FEW and len(surfaces.faces) < SMALL):
            self._end()
            return
        self._start()
        if self._process is not None:
            self._faces = self._answers((source, surfaces.skeleton, names), 1 + len(names) if names else 0)

    def _start(self) -> None:
        command = [sys.executable, "-m", "mua.fidelity.source_process"]
        pipe = subprocess.PIPE
        with suppress(OSError):  # no room for it: all is then drawn here
            self._process = self._process or subprocess.Popen(
                command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL
            )

    def draw_poses(self, sittings: Sequence[Sitting]) -> None:
        """Draw the source in some poses as well, where there is a process."""
        if self._process is not None:
            self._poses = self._answers(sittings, sum(len(sitting.views) for sitting in sittings))

    def draw_faces_of(self, face: StillFace) -> None:
        """Draw the faces of the splats as well, where there is a process; after poses."""
        if self._process is not None:
            self._splat_faces = self._asked(face, 1 + len(face.expressions))

    def faces(self) -> Iterator[Patch]:
        """As of `source_faces`, as soon as they are drawn; none or not all where no process draws them."""
        return self._faces

    def poses(self) -> Iterator[Array]:
        """As of `source_poses`, likewise."""
        return self._poses

    def splat_faces(self, here: SplatFaces) -> list[Patch]:
        """All patches of `here`: the process draws from the first on, this one from the last back, until they meet."""
        last: list[Patch] = []
        while (left := len(here) - len(last)) > self._splat_faces.qsize():
            last.append(here.patch(left - 1))
        first = [self._splat_faces.get() or here.patch(number) for number in range(left)]  # a process may have ended
        self._end()  # what else it draws nobody needs
        return first + last[::-1]

    def _answers(self, job: object, count: int) -> Iterator[Any]:
        return _as_they_come(self._asked(job, count))

    def _asked(self, job: object, count: int) -> "SimpleQueue[Any]":
        assert self._process is not None
        answers: SimpleQueue[Any] = SimpleQueue()
        self._thread.submit(_hear, self._process, job, count, answers)
        return answers

    def __exit__(self, *_: object) -> None:
        self._end()

    def _end(self) -> None:
        if (process := self._process) is None:
            return
        self._process = None
        process.kill()
        process.wait()
        self._thread.shutdown()
        for pipe in (process.stdin, process.stdout):
            with suppress(OSError):  # for what it has not read
                if pipe is not None:
                    pipe.close()


def continued(drawn: Iterable[T], here: Iterator[T]) -> Iterator[T]:
    """What a process has drawn, and from where it stopped on what is drawn here."""
    count = 0
    for patch in drawn:
        count += 1
        yield patch
    yield from itertools.islice(here, count, None)


def _hear(
    process: "subprocess.Popen[bytes]",
    job: object,
    count: int,
    answers: "SimpleQueue[Any]",  # what the process draws; None after the last, or where it ends before
) -> None:
    assert process.stdin is not None
    assert process.stdout is not None
    with suppress(EOFError, OSError, pickle.UnpicklingError):
        pickle.dump(job, process.stdin)
        process.stdin.flush()
        for _ in range(count):
            answers.put(pickle.load(process.stdout))
    answers.put(None)


def _as_they_come(answers: "SimpleQueue[Any]") -> Iterator[Any]:
    while (answer := answers.get()) is not None:
        yield answer


def _answer(images: Iterable[object], answers: IO[bytes]) -> None:
    for image in images:
        pickle.dump(image, answers)
        answers.flush()  # whoever waits counts what has come


def main() -> None:
    """Draw what standard input asks for; nothing where this machine has no OpenGL."""
    questions = sys.stdin.buffer
    source, skeleton, names = pickle.load(questions)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of drivers must not come between the images
    with suppress(InputError, EOFError), opened() as context, answers:
        if names:
            _answer(source_faces(context, source.scene, Poser(source, skeleton).rest(), names), answers)
        _answer(source_poses(context, source.scene, pickle.load(questions)), answers)
        faces = SplatFaces(context, pickle.load(questions))
        _answer(map(faces.patch, range(len(faces))), answers)


if __name__ == "__main__":
    main()
