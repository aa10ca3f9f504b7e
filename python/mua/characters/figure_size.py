"""The size that a user gives a character, in place of what its file says or the reader guesses."""

import math
from dataclasses import dataclass

from mua.errors import InputError

LEAST, MOST = 0.01, 100.0  # metres: within them a splat's square millimetres fit the half floats of a GPU


@dataclass(frozen=True)
class FigureSize:
    """At most one of the two is given."""

    scale: float | None = None  # multiplies the units of the file
    height: float | None = None  # metres in the bind pose

    def __post_init__(self) -> None:
        """Errors: InputError where both are given, or one is no possible size."""
        if self.scale is not None and self.height is not None:
            raise InputError(f"--scale {self.scale:g} and --height {self.height:g}: expected one of them, not both")
        if self.scale is not None and not (math.isfinite(self.scale) and self.scale > 0):
            raise InputError(f"--scale {self.scale:g}: expected a number above 0")
        if self.height is not None and not LEAST <= self.height <= MOST:
            raise InputError(f"--height {self.height:g}: expected {LEAST:g} to {MOST:g} metres")


AS_FOUND = FigureSize()
