"""Notes what a test meets: Python functions that are entered, C# and HLSL that is read, in child processes too.

Lines of context, path and, in Python, function; each once in a context, which is a test, a fixture that tests share, or
nothing while modules are imported. A line without a path tells seconds of CPU time, or a fixture that a test is given.
"""

import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

SUFFIXES = (".cs", ".hlsl", ".compute", ".shader")


class Watcher:
    """What stands below `MUTANTS_ROOT` and is met is appended to the file `MUTANTS_SEEN`."""

    def __init__(self) -> None:
        self._root, out = os.environ["MUTANTS_ROOT"], os.environ["MUTANTS_SEEN"]
        self._out = os.open(out, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
        self._context = os.environ.setdefault("MUTANTS_CONTEXT", "")  # child processes go on in that of their parent
        self._seen: dict[object, object] = {}
        self._told = 0.0  # seconds
        self._held = b""
        sys.addaudithook(self._opened)
        sys.settrace(self._entered)
        threading.settrace(self._entered)

    def _note(self, *words: str) -> None:
        self._held += ("\t".join((self._context, *words)) + "\n").encode()
        with suppress(OSError):  # a test may let no file grow: what it meets is written after it
            os.write(self._out, self._held)
            self._held = b""

    def _entered(self, frame: FrameType, event: str, argument: object) -> None:
        code = frame.f_code
        if id(code) not in self._seen:
            self._seen[id(code)] = code
            if code.co_filename.startswith(self._root):
                is_function = code.co_flags & 1  # not the body of a module or class, which an import runs
                name = code.co_qualname.split(".<locals>")[0] if is_function else "<module>"
                self._note(code.co_filename[len(self._root) :], name)

    def _opened(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event == "open" and isinstance(arguments[0], str | os.PathLike):
            path = os.path.abspath(os.fsdecode(arguments[0]))  # noqa: PTH100 links are not followed
            if path.endswith(SUFFIXES) and path.startswith(self._root) and path not in self._seen:
                self._seen[path] = path
                self._note(path[len(self._root) :])

    @contextmanager
    def within(self, context: str, *given: str) -> Iterator[None]:
        """What is met meanwhile belongs to `context`, which is given those fixtures."""
        outer, start = self._context, sum(os.times()[:4]) - self._told
        self._enter(context)
        for fixture in given:
            self._note("", fixture)
        yield
        seconds = sum(os.times()[:4]) - self._told - start
        self._told += seconds
        self._note("", f"{seconds:.2f}")
        self._enter(outer)

    def _enter(self, context: str) -> None:
        self._context = os.environ["MUTANTS_CONTEXT"] = context
        self._seen.clear()
