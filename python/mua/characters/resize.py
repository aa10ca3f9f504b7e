"""A character brought to the size that a user asks for."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mua.atlas.character_surfaces import Surfaces
from mua.characters.correction import carried
from mua.characters.figure_size import AS_FOUND, LEAST, MOST, FigureSize
from mua.errors import InputError


def resized(surfaces: Surfaces, size: FigureSize, path: Path) -> Surfaces:
    """The character at the size asked for; where none is, as it was read.

    Errors: InputError where `size.scale` makes the character of `path` impossibly small or large.
    """
    if size == AS_FOUND:
        return surfaces
    height = float(np.ptp(surfaces.vertices[:, 1]))
    if size.height is not None:
        if not height:
            raise InputError(f"--height {size.height:g}: the character of {path} is flat; give --scale instead")
        factor = size.height / height
    else:
        factor = (size.scale or 1.0) / surfaces.unit
        extent = factor * float(np.ptp(surfaces.vertices, axis=0).max())
        if not LEAST <= extent <= MOST:
            raise InputError(
                f"--scale {size.scale:g}: makes the character of {path} measure {extent:.3g} m, "
                f"expected {LEAST:g} to {MOST:g}"
            )
    skeleton, source, expressions = surfaces.skeleton, surfaces.source, surfaces.expressions
    scaling = np.diag([factor, factor, factor, 1.0])
    return replace(
        surfaces,
        skeleton=replace(skeleton, bind_translations=factor * skeleton.bind_translations),
        vertices=factor * surfaces.vertices,
        expressions=None if expressions is None else replace(expressions, offsets=factor * expressions.offsets),
        clips=tuple(replace(clip, translations=factor * clip.translations) for clip in surfaces.clips),
        source=None if source is None else replace(source, scene=carried(source.scene, scaling)),
        unit=factor * surfaces.unit,
        size_notes=(),
        notes=tuple(note for note in surfaces.notes if note not in surfaces.size_notes),
    )
