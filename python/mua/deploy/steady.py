"""A headset kept awake or at steady clocks, and put back as it was: after errors and Ctrl-C too."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from mua.errors import InputError

if TYPE_CHECKING:  # loads adbutils
    from mua.deploy.headset import Headset

RATES = (72, 80, 90, 120)  # Hz of Quest 3's display
LEVEL = 4  # level of CPU and GPU that a Quest 3 holds without throttling
UNDO_SECONDS = 10.0

SENSOR = "com.oculus.vrpowermanager"
WORN = ("am", "broadcast", "-a", f"{SENSOR}.prox_close")
AS_SENSED = ("am", "broadcast", "-a", f"{SENSOR}.automation_disable")


@contextmanager
def awake(headset: "Headset") -> Iterator[None]:
    """The headset behaves as if it were worn, so that the player keeps the focus."""
    with _undoing(headset, [AS_SENSED]):
        headset.run(*WORN)
        yield


@contextmanager
def steady(headset: "Headset", rate: int) -> Iterator[None]:
    """Awake, with fixed clocks and fixed foveation and a display at `rate` Hz."""
    wanted = {
        "debug.oculus.cpuLevel": str(LEVEL),
        "debug.oculus.gpuLevel": str(LEVEL),
        "debug.oculus.refreshRate": str(rate),
        "debug.oculus.foveation.dynamic": "0",
    }
    before = {name: headset.run("getprop", name) for name in wanted}
    undo = [AS_SENSED, *(("setprop", name, value) for name, value in before.items())]
    with _undoing(headset, undo):
        headset.run(*WORN)
        for name, value in wanted.items():
            headset.run("setprop", name, value)
            if (found := headset.run("getprop", name)) != value:
                raise InputError(f"{headset.serial}: {name} is {found!r} after setting it, expected {value!r}")
        yield


@contextmanager
def _undoing(headset: "Headset", commands: Sequence[tuple[str, ...]]) -> Iterator[None]:
    """Run `commands` at the end, whatever happened; one that fails becomes part of the sentence."""
    failure = ""
    try:
        yield
    except InputError as error:
        failure = f"{error}; "
        raise
    finally:
        try:
            for command in commands:
                headset.run(*command, seconds=UNDO_SECONDS)
        except InputError as error:
            raise InputError(f"{failure}{headset.serial} keeps its measuring settings until it is restarted") from error
