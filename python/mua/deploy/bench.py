"""The cost of an avatar's frames on the headset, from the compositor's lines while the player plays it."""

from collections.abc import Iterable
from contextlib import closing
from dataclasses import dataclass

import numpy as np

from mua.deploy import vrapi
from mua.deploy.headset import Headset
from mua.deploy.player import PATIENCE, answers, follow, new_run
from mua.deploy.steady import LEVEL, steady
from mua.errors import InputError

MARK = "MUA-BENCH"
ENOUGH = 0.8  # share of the seconds that must have a line


@dataclass(frozen=True)
class Spread:
    """Statistics of one figure over all samples."""

    minimum: float
    median: float
    high: float  # 95th percentile


@dataclass(frozen=True)
class Benched:
    """The measurement of one avatar on one headset."""

    avatar: str
    serial: str
    model: str
    rate: int  # Hz
    seconds: int
    samples: list[dict[str, float]]  # one a second, each with the figures of vrapi.FIGURES that its line had

    def figures(self) -> dict[str, Spread]:
        """Every figure that any sample has."""
        columns = {name: [s[name] for s in self.samples if name in s] for name in vrapi.FIGURES}
        return {name: _spread(values) for name, values in columns.items() if values}


def bench(headset: Headset, avatar: str, *, seconds: int, rate: int) -> Benched:
    """Play `avatar`, which the headset holds, for that long at steady clocks.

    Errors: InputError if the player cannot, or if no figures came from it.
    """
    run = new_run()
    model = headset.run("getprop", "ro.product.model")
    arguments = ("-muaBench", avatar, "-muaSeconds", str(seconds))
    with (
        steady(headset, rate),
        closing(follow(headset, run, *arguments, patience=PATIENCE + seconds)) as lines,
    ):
        samples = collect(lines, run)
    if not samples:
        raise InputError(f"{headset.serial}: no VrApi line came while {avatar} played: is this a Quest?")
    return Benched(avatar, headset.serial, model, rate, seconds, samples)


def collect(lines: Iterable[str], run: str) -> list[dict[str, float]]:
    """The samples between START and END of one run.

    Errors: InputError with the player's reason if it cannot measure.
    """
    begun, samples = False, list[dict[str, float]]()
    for line in lines:
        for answer in answers([line], MARK, run):
            if answer.startswith("FAIL "):
                raise InputError(f"the player cannot measure: {answer.removeprefix('FAIL ')}")
            if answer == "END" and begun:
                return samples
            begun = begun or answer.startswith("START ")
        if begun and (sample := vrapi.parse(line)):
            samples.append(sample)
    raise InputError("the player's log ended while it measured")


def warnings(benched: Benched) -> list[str]:
    """Why the figures may not be what the headset can do, each a sentence."""
    found = []
    lines = len(benched.samples)
    if lines < ENOUGH * benched.seconds:
        found.append(
            f"only {lines} of {benched.seconds} seconds have a line: the headset slept or another window had the focus"
        )
    spreads = benched.figures()
    for name in ("cpu_level", "gpu_level"):
        if name in spreads and spreads[name].minimum < LEVEL:
            found.append(f"the {name.replace('_', ' ')} fell to {spreads[name].minimum:g}, {LEVEL} was asked for")
    if any(sample.get("power_state", 0) > 0 for sample in benched.samples):
        found.append("the headset was throttled, its power state left normal: let it cool and charge")
    return found


def as_json(benched: Benched) -> dict[str, object]:
    """The content of the JSON file."""
    return {
        "avatar": benched.avatar,
        "serial": benched.serial,
        "model": benched.model,
        "rate": benched.rate,
        "seconds": benched.seconds,
        "figures": {
            name: {"min": s.minimum, "median": s.median, "p95": s.high} for name, s in benched.figures().items()
        },
        "warnings": warnings(benched),
        "samples": benched.samples,
    }


def _spread(values: list[float]) -> Spread:
    return Spread(min(values), float(np.median(values)), float(np.percentile(values, 95)))
