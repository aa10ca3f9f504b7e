"""Draws the faces of a character's file in a process beside this one, while the character's splats are made.

The process is this module as a program: it reads a source, a skeleton and the names of expressions from standard input
and writes images to standard output. It is a process because OpenGL holds Python's lock while it draws.
"""

import os
import pickle
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from typing import Self

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.errors import InputError
from mua.fidelity.canvas import opened
from mua.fidelity.source_faces import source_faces
from mua.fidelity.source_pose import Poser
from mua.pose.skeleton import Skeleton
from mua.scene import Source

FEWEST = 16  # expressions: fewer are drawn sooner than a process starts


class SourceProcess:
    """The process, where there is one; it ends with the block."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._images: Future[list[Array] | None] | None = None

    def __enter__(self) -> Self:
        return self

    def begin(self, surfaces: Surfaces) -> None:
        """Draw the faces of a character with so many expressions that they are worth a process."""
        source, expressions = surfaces.source, surfaces.expressions
        if source is None or expressions is None or len(expressions) < FEWEST:
            return
        command = [sys.executable, "-m", "mua.fidelity.source_process"]
        pipe = subprocess.PIPE
        try:
            self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL)
        except OSError:  # no room for it: the faces are then drawn here
            return
        pool = ThreadPoolExecutor(1)
        self._images = pool.submit(_heard, self._process, (source, surfaces.skeleton, expressions.names))
        pool.shutdown(wait=False)

    def images(self) -> list[Array] | None:
        """Images [H, W, 4] as of `source_faces`; None where no process has drawn them."""
        return None if self._images is None else self._images.result()

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            for pipe in (self._process.stdin, self._process.stdout):
                with suppress(OSError):  # for what it has not read
                    if pipe is not None:
                        pipe.close()


def _heard(process: "subprocess.Popen[bytes]", job: tuple[Source, Skeleton, tuple[str, ...]]) -> list[Array] | None:
    """What a process draws; None where it ends before that."""
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        pickle.dump(job, process.stdin)
        process.stdin.flush()
        return [pickle.load(process.stdout) for _ in (0, *job[2])]
    except (EOFError, OSError, pickle.UnpicklingError):
        return None


def main() -> None:
    """Draw what standard input asks for; nothing where this machine has no OpenGL."""
    source, skeleton, names = pickle.load(sys.stdin.buffer)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of drivers must not come between the images
    with suppress(InputError), opened() as context, answers:
        for image in source_faces(context, source.scene, Poser(source, skeleton).rest(), names):
            pickle.dump(image, answers)


if __name__ == "__main__":
    main()
