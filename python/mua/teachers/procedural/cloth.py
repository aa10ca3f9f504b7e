"""The patterned cloth of skirt and bodice."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.brush import Surface, color, filled, inside, over
from mua.teachers.procedural.complexion import SKIN
from mua.teachers.procedural.figure import SLEEVE_EDGE

IVORY, TEAL, CORAL, MUSTARD, LEAF = color("f3e6cf"), color("17505e"), color("d9573f"), color("e2a63a"), color("4f8a7b")
_APEX = 0.197  # metres from the cone's apex to the waist: waist girth / pi, for a half circle of cloth
_REPEAT = 0.15  # metres from motif to motif
_TRIM = 0.055  # metres of trim above the hem


def _flower(x: Array, y: Array, *, radius: float, petals: int) -> Array:
    """Signed distance (about) to a flower's outline."""
    return np.asarray(np.hypot(x, y) - radius * (0.78 + 0.22 * np.cos(petals * np.arctan2(y, x))))


def paint_skirt(surface: Surface) -> Array:
    """Flowers on a lattice over the flat half circle that the skirt is cut from, and a scalloped trim.

    The lattice turns into itself by half a turn, so the pattern meets at the back seam.
    """
    half = (surface.around - 0.5) * np.pi
    radius = _APEX + surface.along
    x, y = radius * np.cos(half) / _REPEAT, radius * np.sin(half) / _REPEAT
    i, j = np.round(x), np.round(y)
    x, y, even = (x - i) * _REPEAT, (y - j) * _REPEAT, (i + j) % 2 == 0
    cloth = filled(surface.around, IVORY)
    flower = np.where(even, _flower(x, y, radius=0.06, petals=6), _flower(x, y, radius=0.036, petals=4))
    cloth = over(cloth, np.where(even[..., None], CORAL, TEAL), inside(flower))
    cloth = over(cloth, IVORY, inside(np.abs(np.hypot(x, y) - 0.028) - 0.004) * even)
    cloth = over(cloth, MUSTARD, inside(np.hypot(x, y) - np.where(even, 0.019, 0.013)))
    cx, cy = _REPEAT / 2 - np.abs(x), _REPEAT / 2 - np.abs(y)
    cloth = over(cloth, LEAF, inside(np.hypot(cx, cy) - 0.011))

    above_hem = surface.along.max() - surface.along - 0.02
    scallop = _TRIM + 0.016 * np.abs(np.sin(surface.around * np.pi * 40))
    cloth = over(cloth, TEAL, inside(above_hem - scallop))
    return over(cloth, MUSTARD, inside(np.abs(above_hem - 0.022) - 0.004))


def paint_bodice(surface: Surface) -> Array:
    """A plain fitted top with a coral belt and an edge along the neckline."""
    cloth = filled(surface.around, TEAL)
    height = surface.points[..., 1]
    cloth = over(cloth, CORAL, inside(np.abs(height - 1.048) - 0.020))
    return over(cloth, MUSTARD, inside(surface.ring - 1, edge=0.05))


def paint_sleeve(surface: Surface) -> Array:
    """The top's sleeve with its cuff, then the bare forearm and hand."""
    cloth = filled(surface.around, TEAL)
    cloth = over(cloth, MUSTARD, inside(np.abs(surface.ring - SLEEVE_EDGE) - 1, edge=0.05))
    return over(cloth, SKIN, inside(SLEEVE_EDGE + 0.7 - surface.ring, edge=0.05))
