"""Places charts in a square, turned, turned over and close together, by trying every place of a grid for each.

Charts are laid down from large to small. Of all places where a chart fits and all its ways, the one is chosen at which
most of its outline lies near what is taken. The smallest, which count as their boxes, fill what is left row by row.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

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
SLANT = np.pi / 4  # half a right angle

Shapes = Callable[[int, float, float], Shape]  # a chart at a scale, turned by so much more than upright


@dataclass(frozen=True, eq=False)
class _Layout:
    """Where each chart lies: at `turns @ point + shifts`."""

    turns: Array  # [K, 2, 2]
    shifts: Array  # [K, 2] cells
    scale: float
    side: int  # of the square around all, cells

    @property
    def fineness(self) -> float:
        return self.scale / self.side


def pack(
    corners: Array,  # [F, 3, 2] all charts in one scale
    charts: Array,  # [F], numbered from 0
) -> Array:
    """Place the charts in the unit square, as large as they fit without overlap: [F, 3, 2]."""
    surface = areas(corners).sum()
    scaled = corners * (GRID * np.sqrt(FULL / max(surface, np.finfo(float).tiny)))
    points, angles = points_on(scaled, charts), narrowest_angles(corners, charts)

    @cache  # several tries ask for the same
    def shape(chart: int, scale: float, slant: float) -> Shape:
        return rasterised(scale * points[chart], angles[chart] + slant)

    tries, half = TRIES[: max(CHARTS_TRIED // len(points), 1)], _half_gutters(shape, len(points))
    longest = max(np.ptp(p, axis=1).max() for p in points)
    best: _Layout | None = None
    for by_box, full in tries:
        scale = min(_fitting(full * FULL, half), float(GRID / longest))
        layout = _laid(shape, len(points), by_box=by_box, scale=scale, beyond=best.fineness if best else 0.0)
        best = layout if best is None or layout.fineness > best.fineness else best
    assert best is not None
    placed = best.scale * np.einsum("fij,fkj->fki", best.turns[charts], scaled) + best.shifts[charts][:, None]
    placed -= placed.min(axis=(0, 1))
    return placed / max(placed.max(), np.finfo(float).tiny)


def _laid(
    shape: Shapes,
    count: int,  # of charts
    *,
    by_box: bool,  # the order is that of their boxes, not of their cells
    scale: float,
    beyond: float,  # fineness: a layout that does not come to more is left unfinished
) -> _Layout:
    """Lay down all charts in this scale, or in a smaller one where they must."""
    while True:
        layout = _attempt(shape, count, scale=scale, by_box=by_box, beyond=beyond)
        if layout:
            return layout
        scale *= SMALLER


def _half_gutters(shape: Shapes, count: int) -> float:
    """Half of what the gutters take beside the charts at a scale of 1."""
    surface = FULL * GRID**2
    gutters = sum(shape(chart, 1.0, 0.0).cells for chart in range(count)) - surface
    return float(gutters / (2 * surface))


def _fitting(full: float, half: float) -> float:
    """The scale at which charts and half of their gutters have as many cells as `full` of the square."""
    return float(np.sqrt(full / FULL + half**2) - half)  # gutters grow with length, charts with area: quadratic


def _attempt(shape: Shapes, count: int, *, scale: float, by_box: bool, beyond: float) -> _Layout | None:
    """A layout in this scale, None where something fits nowhere."""
    shapes = [shape(chart, scale, 0.0) for chart in range(count)]
    cells = np.array([one.cells for one in shapes])
    order = np.argsort([-one.mask.size for one in shapes] if by_box else -cells, kind="stable").tolist()
    grid = PackingGrid(int(np.sqrt(2) * max(max(one.mask.shape) for one in shapes)) + 1, len(shapes))
    turns, shifts = np.empty((len(shapes), 2, 2)), np.empty((len(shapes), 2))
    crumbs: dict[tuple[int, ...], list[int]] = {}
    for chart in order:
        choice = ways(shapes[chart])
        if max(choice[0].mask.shape) <= CRUMB:
            crumbs.setdefault(tuple(sorted(choice[0].mask.shape)), []).append(chart)
            continue
        if cells[chart] > LARGE * GRID**2:
            choice += ways(shape(chart, scale, SLANT))
        place = grid.best(choice)
        if place is None:
            return None
        grid.take(place)
        turns[chart], shifts[chart] = place.shape.turn, place.shape.shift + place.at
        if scale <= beyond * grid.reach:
            return _Layout(turns, shifts, scale, grid.reach)
    for box in sorted(crumbs, reverse=True):
        found = grid.fill(box, len(crumbs[box]))
        if len(found) < len(crumbs[box]):
            return None
        for chart, at in zip(crumbs[box], found, strict=True):
            lying = next(way for way in ways(shapes[chart]) if way.mask.shape == box)
            turns[chart], shifts[chart] = lying.turn, lying.shift + np.array(at)
    return _Layout(turns, shifts, scale, grid.reach)
