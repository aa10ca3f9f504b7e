"""Places charts in a square, turned, turned over and close together, by trying every place of a grid for each.

Charts are laid down from large to small. Of all places where a chart fits and all its ways, the one is chosen at which
most of its outline lies near what is taken. The smallest, which count as their boxes, fill what is left row by row.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.atlas.chart_shapes import Shape, narrowest_angles, points_on, rasterised, ways
from mua.atlas.packing_grid import GRID, PackingGrid
from mua.rig.charts import areas

FULL = 0.93  # share of the square which charts and half of their gutters would fill; what does not fit goes beyond
TRIES = ((False, 1.0), (True, 1.0), (False, 0.93), (True, 1.06))  # from the largest box instead? what share of FULL?
CHARTS_TRIED = 250  # in all tries together
LARGE = 0.004  # share of the cells from which on a chart is also tried turned by half a right angle
CRUMB = 8  # cells along the longer side of a chart with its gutters that is taken for its box
SMALLER = 0.95  # each time that something fits nowhere


@dataclass(frozen=True, eq=False)
class _Layout:
    """Where each chart lies: at `turns @ point + shifts`."""

    turns: Array  # [K, 2, 2]
    shifts: Array  # [K, 2] cells
    scale: float
    side: int  # of the square around all, cells


def pack(
    corners: Array,  # [F, 3, 2] all charts in one scale
    charts: Array,  # [F], numbered from 0
) -> Array:
    """Place the charts in the unit square, as large as they fit without overlap: [F, 3, 2]."""
    surface = areas(corners).sum()
    scaled = corners * (GRID * np.sqrt(FULL / max(surface, np.finfo(float).tiny)))
    points, angles = points_on(scaled, charts), narrowest_angles(corners, charts)
    tries, half = TRIES[: max(CHARTS_TRIED // len(points), 1)], _half_gutters(points, angles)
    layouts = [_laid(points, angles, by_box=by_box, full=full * FULL, half=half) for by_box, full in tries]
    best = max(layouts, key=lambda layout: layout.scale / layout.side)
    placed = best.scale * np.einsum("fij,fkj->fki", best.turns[charts], scaled) + best.shifts[charts][:, None]
    placed -= placed.min(axis=(0, 1))
    return placed / max(placed.max(), np.finfo(float).tiny)


def _laid(
    points: Sequence[Array],  # of each chart [2, n], cells
    angles: Array,  # [K]
    *,
    by_box: bool,  # the order is that of their boxes, not of their cells
    full: float,
    half: float,  # from `_half_gutters`
) -> _Layout:
    """Lay down all charts, smaller than they are until they take `full` of the square, or less where they must."""
    scale = _fitting(points, full, half)
    while True:
        shapes = [rasterised(scale * p, angle) for p, angle in zip(points, angles, strict=True)]
        layout = _attempt(shapes, [scale * p for p in points], scale=scale, by_box=by_box)
        if layout:
            return layout
        scale *= SMALLER


def _half_gutters(points: Sequence[Array], angles: Array) -> float:
    """Half of what the gutters take beside the charts at a scale of 1."""
    surface = FULL * GRID**2
    gutters = sum(rasterised(p, angle).cells for p, angle in zip(points, angles, strict=True)) - surface
    return float(gutters / (2 * surface))


def _fitting(points: Sequence[Array], full: float, half: float) -> float:
    """The scale at which charts and half of their gutters have as many cells as `full` of the square."""
    scale = np.sqrt(full / FULL + half**2) - half  # gutters grow with length, charts with area: a quadratic equation
    return float(min(scale, GRID / max(np.ptp(p, axis=1).max() for p in points)))


def _attempt(shapes: Sequence[Shape], points: Sequence[Array], *, scale: float, by_box: bool) -> _Layout | None:
    """A layout in this scale, None where something fits nowhere."""
    cells = np.array([shape.cells for shape in shapes])
    order = np.argsort([-shape.mask.size for shape in shapes] if by_box else -cells, kind="stable").tolist()
    grid = PackingGrid(int(np.sqrt(2) * max(max(shape.mask.shape) for shape in shapes)) + 1, len(shapes))
    turns, shifts = np.empty((len(shapes), 2, 2)), np.empty((len(shapes), 2))
    crumbs: dict[tuple[int, ...], list[int]] = {}
    for chart in order:
        choice = ways(shapes[chart])
        if max(choice[0].mask.shape) <= CRUMB:
            crumbs.setdefault(tuple(sorted(choice[0].mask.shape)), []).append(chart)
            continue
        if cells[chart] > LARGE * GRID**2:
            choice += ways(rasterised(points[chart], shapes[chart].angle + np.pi / 4))
        place = grid.best(choice)
        if place is None:
            return None
        grid.take(place)
        turns[chart], shifts[chart] = place.shape.turn, place.shape.shift + place.at
    for box in sorted(crumbs, reverse=True):
        found = grid.fill(box, len(crumbs[box]))
        if len(found) < len(crumbs[box]):
            return None
        for chart, at in zip(crumbs[box], found, strict=True):
            lying = next(way for way in ways(shapes[chart]) if way.mask.shape == box)
            turns[chart], shifts[chart] = lying.turn, lying.shift + np.array(at)
    return _Layout(turns, shifts, scale, grid.reach)
