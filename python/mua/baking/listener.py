"""Progress callbacks of a bake or a training, and two listeners: one logs, one does nothing."""

import logging
from typing import Protocol


class Listener(Protocol):
    """Progress callbacks of a bake or a training; the command line shows them."""

    def stage(self, name: str) -> None: ...

    def step(self, done: int, total: int, *, detail: str = "") -> None: ...

    def note(self, sentence: str) -> None: ...


class Log:
    """A listener that writes stages and notes to Python's log, under the name mua."""

    def __init__(self) -> None:
        self._log = logging.getLogger("mua")
        self._begun: set[str] = set()  # two stages may take turns: each is logged once

    def stage(self, name: str) -> None:
        if name not in self._begun:
            self._begun.add(name)
            self._log.info("%s", name)

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        self._log.debug("%d of %d%s%s", done, total, ", " if detail else "", detail)

    def note(self, sentence: str) -> None:
        self._log.info("%s", sentence)


class Nobody:
    """A listener that does nothing."""

    def stage(self, name: str) -> None: ...

    def step(self, done: int, total: int, *, detail: str = "") -> None: ...

    def note(self, sentence: str) -> None: ...
