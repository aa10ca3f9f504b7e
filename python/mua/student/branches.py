"""Fits parts of a student at once on a CPU, each with its share of the threads."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from threading import Event

from mua.training.optimise import Progress, Run
from mua.training.threads import together
from mua.training.torch_threads import thread_share

PARTS = 2  # tasks at once, each with so large a part of torch's threads


class Stopped(Exception):
    """Raised in a part whose fit must end because that of another one failed."""


def fit_apart(tasks: Sequence[Callable[[Run], None]], run: Run) -> None:
    """Fit parts that share nothing but their inputs: on a CPU two side by side; else one after the other.

    There half the threads for each do more than all for one: the larger part of a step is too small to be divided.
    One alone has no more, as the last bits of its sums depend on their number.
    """
    if not side_by_side(run):
        for task in tasks:
            task(run)
        return
    stop = Event()

    def report(progress: Progress) -> None:
        if stop.is_set():
            raise Stopped
        run.report(progress)

    with thread_share(PARTS):
        own = replace(run, report=report)
        together([partial(task, own) for task in tasks], stop=stop.set, threads=PARTS)


def side_by_side(run: Run) -> bool:
    """Whether parts are fitted at once: not on a GPU, whose memory one fills, nor where processes take turns."""
    return run.device.type == "cpu" and run.processes.count == 1
