"""The size that a user gives a character, in place of what its file says or the reader guesses."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua.errors import InputError
from mua.rig.assemble import Surfaces
from mua.rig.correction import POSSIBLE_HEIGHTS

LEAST, MOST = POSSIBLE_HEIGHTS


@dataclass(frozen=True)
class FigureSize:
    """At most one of the two is given."""

    scale: float | None = None  # multiplies the units of the file
    height: float | None = None  # metres in the bind pose

    def __post_init__(self) -> None:
        """Errors: InputError where both are given, or one is no possible size."""
        if self.scale is not None and self.height is not None:
            raise InputError(f"--scale {self.scale:g} and --height {self.height:g}: expected one of them, not both")
        if self.scale is not None and not (np.isfinite(self.scale) and self.scale > 0):
            raise InputError(f"--scale {self.scale:g}: expected a number above 0")
        if self.height is not None and not LEAST <= self.height <= MOST:
            raise InputError(f"--height {self.height:g}: expected {LEAST:g} to {MOST:g} metres")


AS_FOUND = FigureSize()


def resized(surfaces: Surfaces, size: FigureSize, path: Path) -> Surfaces:
    """The character at the size asked for; where none is, as it was read.

    Errors: InputError where `size.scale` makes the character of `path` impossibly small or large.
    """
    if size == AS_FOUND:
        return surfaces
    height = float(np.ptp(surfaces.vertices[:, 1]))
    if size.height is not None:
        if not height:
            raise InputError(f"--height {size.height:g}: the character of {path} lies flat, give --scale instead")
        factor = size.height / height
    else:
        factor = (size.scale or 1.0) / surfaces.unit
        extent = factor * float(np.ptp(surfaces.vertices, axis=0).max())
        if not LEAST <= extent <= MOST:
            raise InputError(
                f"--scale {size.scale:g}: makes the character of {path} measure {extent:.3g} m, "
                f"expected {LEAST:g} to {MOST:g}"
            )
    skeleton = surfaces.skeleton
    return replace(
        surfaces,
        skeleton=replace(skeleton, bind_translations=factor * skeleton.bind_translations),
        vertices=factor * surfaces.vertices,
        clips=tuple(replace(clip, translations=factor * clip.translations) for clip in surfaces.clips),
        unit=factor * surfaces.unit,
        size_notes=(),
        notes=tuple(note for note in surfaces.notes if note not in surfaces.size_notes),
    )
