"""The texels that a brush paints on, and how one colour is laid over another."""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array

EDGE = 0.0012  # metres over which one colour turns into the next


@dataclass(frozen=True, eq=False)
class Surface:
    """The texels [H, W] of a part: where each lies on it."""

    points: Array  # [H, W, 3] rest position, metres
    around: Array  # [H, W] 0..1 along the columns
    along: Array  # [H, W] metres from the upper end, on average over the columns
    ring: Array  # [H, W] ring of the part, with fraction


def inside(distance: Array, *, edge: float = EDGE) -> Array:
    """Coverage 0..1 of a shape from the signed distance [...] to its outline (metres, negative inside)."""
    return np.clip(0.5 - distance / (2 * edge), 0, 1)


def over(below: Array, color: tuple[float, float, float] | Array, coverage: Array) -> Array:
    """Lay `color` over `below` [H, W, 3] where `coverage` [H, W] says."""
    return np.asarray(below + (np.asarray(color) - below) * coverage[..., None])


def color(hexadecimal: str) -> tuple[float, float, float]:
    """An sRGB colour from six hexadecimal digits."""
    red, green, blue = bytes.fromhex(hexadecimal)
    return red / 255, green / 255, blue / 255


def filled(like: Array, paint: tuple[float, float, float]) -> Array:
    """A plain coat [H, W, 3] of one colour."""
    return np.tile(np.array(paint), (*like.shape, 1))
