"""What a long job shows while it runs: bars on a terminal, lines of text anywhere else."""

import sys
import time
from typing import TYPE_CHECKING

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, Task, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from mua.cli.console import brief, say

if TYPE_CHECKING:  # torch takes seconds to load, and a check needs none of it
    from mua.baking.distillation import Baked

UNEXPLAINED = 3  # exit status where an avatar is written that explains less than nothing of some frames
LINE_SECONDS = 30.0  # between two lines of one stage where there is no terminal


class Display:
    """Shows the stages of a job; use it as a context manager."""

    def __init__(self, console: Console, *, verbose: bool = False) -> None:
        self.console, self._verbose = console, verbose
        columns = (TextColumn("{task.description:<23}"), BarColumn(12), TextColumn("{task.fields[detail]:<26}"))
        self.progress = Progress(
            *columns, TimeElapsedColumn(), TimeRemainingColumn(), console=console, disable=not console.is_terminal
        )
        self._open: dict[str, tuple[TaskID, float]] = {}  # stages that have not ended, and when each began
        self._stage = ""  # that steps belong to
        self._last_line = 0.0
        self._spoken = ""  # the stage that the last line was about
        self._notes: dict[str, int] = {}  # notes of this stage, and how often each came

    def __enter__(self) -> "Display":
        self.progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._say_notes()
        self.progress.stop()
        for name in tuple(self._open):
            self._end(name)

    def stage(self, name: str) -> None:
        """Begin a stage, or go on with one; of those before it only one whose last step is still to come stays open."""
        self._say_notes()
        self._stage = name
        if name in self._open:
            return
        for other in tuple(self._open):
            task = self._task(other)
            if task.total is None or task.finished:
                self._end(other)
        self._open[name] = self.progress.add_task(name, total=None, detail=""), time.monotonic()
        if self.progress.disable:
            self._say(name)
            self._spoken = name

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        """Say how far the stage is."""
        self._say_notes()
        name = self._stage
        if name not in self._open:
            return
        self.progress.update(self._open[name][0], completed=done, total=total, detail=detail)
        if self.progress.disable and time.monotonic() - self._last_line >= LINE_SECONDS:
            left = self._task(name).time_remaining
            ending = "" if left is None else f", {left / 60:.0f} min left"
            self._say(f"  {self._among(name)}{done} of {total}{', ' if detail else ''}{detail}{ending}")
        if done == total and len(self._open) > 1:
            self._end(name)

    def note(self, sentence: str) -> None:
        """Print a sentence, before the next step or stage; one that comes several times is printed once."""
        self._notes[sentence] = self._notes.get(sentence, 0) + 1

    def _say_notes(self) -> None:
        for sentence, count in self._notes.items():
            times = f" ({count} times)" if count > 1 else ""
            say(self.console, f"  {sentence if self._verbose else brief(sentence)}{times}")
        self._notes.clear()

    def _end(self, name: str) -> None:
        """Fill the bar of a stage; without a terminal, say what it took."""
        among = self._among(name)
        task, begun = self._open.pop(name)
        self.progress.update(task, total=1, completed=1)
        if self.progress.disable:
            self._say(f"  {among}{time.monotonic() - begun:.1f} s")

    def _among(self, name: str) -> str:
        """Which stage a line is about, where several are open or the line before was about another."""
        known = len(self._open) == 1 and self._spoken == name
        self._spoken = name
        return "" if known else f"{name}: "

    def _task(self, name: str) -> Task:
        return next(task for task in self.progress.tasks if task.id == self._open[name][0])

    def _say(self, line: str) -> None:
        self._last_line = time.monotonic()
        self.console.print(line, highlight=False, soft_wrap=True)
        self.console.file.flush()  # so that a log file has it now


def show(console: Console, baked: "Baked") -> None:
    """Print what a bake or a training ends with: the table of errors, what was written where, and what fell short.

    Ends the command with status UNEXPLAINED where less than nothing of some frames is explained.
    """
    from mua.baking.report import closing, legend, table

    lines = [closing(baked.stored, baked.output)]
    if baked.errors:
        console.print(table(baked.errors))
        lines = [*legend(teacher=baked.teacher), *lines]
    if baked.sheet is not None:
        lines.append(f"{baked.sheet}: teacher, student and their difference side by side")
    if baked.figures is not None:
        lines.append(f"{baked.figures}, {baked.figures.with_suffix('.json')}: errors of every attribute")
    for line in lines:
        say(console, line)
    for sentence in baked.shortfalls:
        print(f"warning: {sentence}", file=sys.stderr)
    if baked.shortfalls:
        raise typer.Exit(UNEXPLAINED)
