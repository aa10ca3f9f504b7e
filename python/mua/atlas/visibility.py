"""How much of a surface is seen from outside: from all around, and from the front."""

from collections.abc import Iterator

import numpy as np

from mua.arrays import Array

VIEWS = 24
STEEPEST = 0.7  # sine of the highest and lowest view: people look from the sides
FRONT = 0.6  # cosine between the forward direction and a view of the front
CELLS = 192  # along the figure's largest side
NEAR = 0.75  # cells behind the foremost point, at which a surface that faces the view counts as seen
LEAST_FACING = 0.2  # cosine: a surface that is more on edge is no deeper within a cell
SOLID = 0.5  # opacity from which a point hides what is behind it
GOLDEN = np.pi * (3 - np.sqrt(5))  # radians


def seen_shares(
    places: Array,  # [n, 3] metres, facing +z, y up
    normals: Array,  # [n, 3] unit; either side is seen
    opacity: Array,  # [n]
) -> tuple[Array, Array]:
    """The shares of all views, and of those of the front, in which points are seen, as they are foreshortened: [n]."""
    shown, possible = np.zeros(len(places)), np.zeros(len(places))
    in_front, views = np.zeros(len(places)), 0
    cell = max(float(np.ptp(places, axis=0).max()), np.finfo(float).tiny) / CELLS
    for away in _views():
        facing = np.abs(normals @ away)
        seen = facing * _foremost(places, away, facing, solid=opacity >= SOLID, cell=cell)
        shown, possible = shown + seen, possible + facing
        if away[2] > FRONT:
            in_front, views = in_front + seen, views + 1
    return shown / np.maximum(possible, np.finfo(float).tiny), in_front / views


def _views() -> Iterator[Array]:
    """Unit vectors towards cameras all around."""
    for number in range(VIEWS):
        up = STEEPEST * (1 - (2 * number + 1) / VIEWS)
        flat, azimuth = np.sqrt(1 - up * up), GOLDEN * number
        yield np.array([flat * np.sin(azimuth), up, flat * np.cos(azimuth)])


def _foremost(places: Array, away: Array, facing: Array, *, solid: Array, cell: float) -> Array:
    """Which points [n] have none of the solid ones in front of them; `cell` is in metres."""
    right = np.array([away[2], 0, -away[0]]) / np.hypot(away[0], away[2])
    column, row = (np.floor(places @ axis / cell).astype(np.int64) for axis in (right, np.cross(away, right)))
    at = (row - row.min()) * (np.ptp(column) + 1) + column - column.min()
    depth, first = places @ away / cell, np.full(at.max() + 1, -np.inf)
    np.maximum.at(first, at[solid], depth[solid])
    slope = np.sqrt(np.maximum(1 - facing**2, 0)) / np.maximum(facing, LEAST_FACING)
    return np.asarray(depth >= first[at] - NEAR * (1 + slope))
