"""The atlas: every part painted from its rest surface, texel by texel, as plain albedo."""

from collections.abc import Callable

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.brush import Surface
from mua.teachers.procedural.cloth import paint_bodice, paint_skirt, paint_sleeve
from mua.teachers.procedural.complexion import paint_finger, paint_hair, paint_head, paint_leg
from mua.teachers.procedural.grid import GRID, Part

ATLAS = 1024  # texels a side
_BACKGROUND = (0.5, 0.5, 0.5)


def _surface(part: Part, rows: Array, columns: Array) -> Surface:
    """Sample a part at texel centres (UV) of `rows` [H] and `columns` [W], clamped to its chart."""
    u0, v0, u1, v1 = part.chart
    across = np.clip((columns - u0) / (u1 - u0), 0, 1)
    down = np.clip((rows - v0) / (v1 - v0), 0, 1)
    rings, count = part.points.shape[:2]
    ring = np.interp(down, part.rows, np.arange(rings))
    r, c = np.minimum(ring.astype(int), rings - 2), np.minimum((across * (count - 1)).astype(int), count - 2)
    s, t = (ring - r)[:, None, None], (across * (count - 1) - c)[None, :, None]
    g = part.points
    upper = (1 - t) * g[r[:, None], c] + t * g[r[:, None], c + 1]
    lower = (1 - t) * g[r[:, None] + 1, c] + t * g[r[:, None] + 1, c + 1]
    length = np.linalg.norm(np.diff(g, axis=0), axis=-1).mean(axis=1).sum()
    around, along, ring = np.broadcast_arrays(across[None, :], length * down[:, None], ring[:, None])
    return Surface((1 - s) * upper + s * lower, around, along, ring)


_BRUSHES: dict[str, Callable[[Surface], Array]] = {
    "skirt": paint_skirt,
    "trunk": paint_bodice,
    "head": paint_head,
    "hair": paint_hair,
    "left arm": paint_sleeve,
    "right arm": paint_sleeve,
    "left leg": paint_leg,
    "right leg": paint_leg,
}


def paint(parts: tuple[Part, ...]) -> Array:
    """The atlas [S, S, 4] uint8 sRGB, opaque; gutters repeat the colour of the chart beside them."""
    atlas = np.full((ATLAS, ATLAS, 4), 1.0)
    atlas[..., :3] = _BACKGROUND
    centers = (np.arange(ATLAS) + 0.5) / ATLAS
    for part in parts:
        left, top, right, bottom = part.cell
        rows = np.flatnonzero((centers * GRID >= top) & (centers * GRID < bottom))
        columns = np.flatnonzero((centers * GRID >= left) & (centers * GRID < right))
        brush = _BRUSHES.get(part.name, paint_finger)
        atlas[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1, :3] = brush(
            _surface(part, centers[rows], centers[columns])
        )
    return np.round(255 * np.clip(atlas, 0, 1)).astype(np.uint8)
