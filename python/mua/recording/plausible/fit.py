"""Finds the unit or axes that turn given points into the expected ones, which identifies a mistaken convention."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from mua.arrays import Array

UNITS = {1000.0: "millimetres", 100.0: "centimetres", 39.37: "inches", 0.01: "hundreds of metres", 0.001: "kilometres"}
UNIT_ERROR = 1.6  # tolerance between the ratio found and that of the unit
EXPLAINED = 0.25  # share of the distance that remains once a mistake is undone
Z_UP, LEFT_HANDED = ("x", "z", "-y"), {("-x", "y", "z"), ("x", "y", "-z")}


@dataclass(frozen=True)
class Mistake:
    """The change that brings points to the expected places."""

    question: str
    distance: float  # remaining distance, root mean square, in the unit of the expected points


def unit_of(ratio: float) -> str | None:
    """The unit in which lengths are `ratio` times the expected metres."""
    for factor, name in UNITS.items():
        if factor / UNIT_ERROR < ratio < factor * UNIT_ERROR:
            return name
    return None


def explain(
    given: Array,  # [n, 3]
    expected: Array,  # [n, 3]
) -> Mistake | None:
    """The change of unit or axes that brings `given` to `expected`, where one does and nothing else is needed."""
    before = rms(given - expected)
    found = min(_attempts(given, expected), key=lambda attempt: attempt.distance)
    return found if found.distance < EXPLAINED * before else None


def _attempts(given: Array, expected: Array) -> Iterator[Mistake]:
    ratio = rms(given) / max(rms(expected), np.finfo(float).tiny)
    unit = unit_of(ratio)
    factor = next((factor for factor, name in UNITS.items() if name == unit), 1.0)
    for axes in permutations(range(3)):
        for signs in product((1, -1), repeat=3):
            names = tuple(("-" if sign < 0 else "") + "xyz"[axis] for axis, sign in zip(axes, signs, strict=True))
            questions = ([] if unit is None else [f"are these {unit}?"]) + _axes_question(names)
            if questions:
                yield Mistake(" ".join(questions), rms(given[:, axes] * signs / factor - expected))


def _axes_question(names: tuple[str, ...]) -> list[str]:
    if names == ("x", "y", "z"):
        return []
    if names == Z_UP:
        return ["is Z up? Y is expected to be"]
    if names in LEFT_HANDED:
        return [f"is this left-handed? ({', '.join(names)}) fits"]
    return [f"are the axes others? ({', '.join(names)}) fits"]


def rms(points: Array) -> float:
    """The root mean square length of points [n, 3]."""
    return float(np.sqrt(np.square(points).sum(axis=-1).mean())) if len(points) else 0.0
