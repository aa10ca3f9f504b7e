"""Skeletool's .motion: the number of a frame and its degrees of freedom (DoFs), line by line."""

from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.characters.skeletool.lines import MOTION, Lines
from mua.errors import InputError


def read_dofs(path: Path, names: tuple[str, ...]) -> tuple[int, Array]:
    """The number of the first frame, and the DoFs [F, D] of all; `names` are those that the skeleton has.

    Raises InputError that names the line where a number is missing or not finite, or frames do not count up by 1.
    """
    rows: list[Array] = []
    for line in Lines(path, MOTION):
        values = line.numbers(0)
        if len(values) != 1 + len(names):
            raise line.error(f"has {len(values) - 1} DoFs, expected the {len(names)} of the skeleton")
        if rows and values[0] != rows[-1][0] + 1:
            raise line.error(f"is frame {values[0]:g}, expected {rows[-1][0] + 1:g} after {rows[-1][0]:g}")
        if values[0] < 0 or values[0] % 1:
            raise line.error(f"the frame is {line.words[0]}, expected a whole number of at least 0")
        rows.append(values)
    if not rows:
        raise InputError(f"{path}: holds no frame")
    found = np.array(rows)
    return int(found[0, 0]), found[:, 1:]


def first_frame(path: Path) -> int:
    """The number of the first frame of a .motion; raises InputError where it has none."""
    return Lines(path, MOTION).next("a frame").whole(0)
