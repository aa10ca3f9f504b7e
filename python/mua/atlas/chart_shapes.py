"""Charts as cells of a grid, in the ways in which they may be laid down: turned, and turned over."""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.rig.charts import areas

GUTTER = 1  # cells between charts
SAMPLING = 0.5  # cells between points of a chart
ANGLES = 32  # over a right angle, among which that of a chart's narrowest box is sought
WAYS = [(swap, down, right) for swap in (False, True) for down in (1, -1) for right in (1, -1)]


@dataclass(frozen=True, eq=False)
class Shape:
    """A chart on the grid in one of its ways: it lies at `turn @ point + shift`, x right and y down."""

    angle: float  # before it was turned by right angles
    turn: Array  # [2, 2]
    shift: Array  # [2] cells
    solid: Array  # [h, w] bool, cells that it touches, with a margin of GUTTER
    mask: Array  # [h, w] bool, grown by GUTTER

    @property
    def cells(self) -> float:
        """How many cells it takes with half of the gutter around it."""
        return (np.count_nonzero(self.solid) + np.count_nonzero(self.mask)) / 2

    @property
    def runs(self) -> tuple[Array, Array, Array]:
        """Rows, first columns and lengths of the mask's runs."""
        padded = np.zeros((self.mask.shape[0], self.mask.shape[1] + 2), np.int8)
        padded[:, 1:-1] = self.mask
        rows, ends = np.nonzero(np.diff(padded, axis=1))
        return rows[::2], ends[::2], ends[1::2] - ends[::2]

    @property
    def outline(self) -> tuple[Array, Array]:
        """Rows and columns of its cells beside one that it does not touch."""
        inner = self.solid.copy()
        inner[1:-1, 1:-1] &= self.solid[:-2, 1:-1] & self.solid[2:, 1:-1]
        inner[1:-1, 1:-1] &= self.solid[1:-1, :-2] & self.solid[1:-1, 2:]
        row, column = np.nonzero(self.solid & ~inner)
        return row, column

    @staticmethod
    def box(height: int, width: int) -> "Shape":
        """A rectangle, gutters included."""
        solid = np.zeros((height, width), bool)
        solid[GUTTER:-GUTTER, GUTTER:-GUTTER] = True
        return Shape(0.0, np.eye(2), np.zeros(2), solid, np.ones_like(solid))


def rasterised(
    points: Array,  # [2, n] x and y, in cells
    angle: float,
) -> Shape:
    """A chart turned by an angle, on the grid."""
    turn = _rotation(angle)
    moved = turn @ points
    shift = GUTTER - moved.min(axis=1)
    column, row = (moved + shift[:, None]).astype(np.int32)
    height, width = row.max() + 1 + GUTTER, column.max() + 1 + GUTTER
    cells = np.zeros(height * width, bool)
    cells[row * width + column] = True
    solid = cells.reshape(height, width)
    return Shape(angle, turn, shift, solid, grown(solid, GUTTER))


def ways(shape: Shape) -> list[Shape]:
    """A shape turned by right angles and turned over; those that come out alike once."""
    found = {}
    for swap, down, right in WAYS:
        solid, mask, turn, shift = shape.solid, shape.mask, shape.turn, shape.shift
        if swap:
            solid, mask, turn, shift = solid.T, mask.T, turn[::-1], shift[::-1]
        signs = np.array([right, down])
        shift = signs * shift + np.where(signs < 0, solid.shape[::-1], 0)
        solid, mask = solid[::down, ::right], mask[::down, ::right]
        key = solid.shape, solid.tobytes()
        if key not in found:
            found[key] = Shape(shape.angle, signs[:, None] * turn, shift, solid, mask)
    return list(found.values())


def grown(
    cells: Array,  # [h, w] bool
    by: int,
) -> Array:
    """The cells and all that lie up to `by` beside or across from them."""
    out = cells.copy()
    for _ in range(by):
        out[1:] |= out[:-1]
        out[:-1] |= out[1:]
        out[:, 1:] |= out[:, :-1]
        out[:, :-1] |= out[:, 1:]
    return out


def narrowest_angles(
    corners: Array,  # [F, 3, 2]
    charts: Array,  # [F]
) -> Array:
    """The angles [K] that turn the least box around each chart upright."""
    order = np.argsort(charts, kind="stable")
    starts = 3 * np.searchsorted(charts[order], np.arange(charts.max() + 1))
    points = np.ascontiguousarray(corners[order].reshape(-1, 2).T)
    angles = np.arange(ANGLES) * (np.pi / 2 / ANGLES)
    boxes = []
    for angle in angles:
        x, y = (np.maximum.reduceat(m, starts) - np.minimum.reduceat(m, starts) for m in _rotation(angle) @ points)
        boxes.append(x * y)
    return angles[np.argmin(boxes, axis=0)]


def points_on(
    corners: Array,  # [F, 3, 2] in cells
    charts: Array,  # [F]
) -> list[Array]:
    """Points [2, n] on each chart's triangles, at most SAMPLING apart, corners among them."""
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)  # [F, 3], side k ends at corner k
    first = (sides.argmax(axis=1)[:, None] + [2, 0, 1]) % 3  # corners, those of the longest side first
    corners, longest = np.take_along_axis(corners, first[..., None], axis=1), sides.max(axis=1)
    height = 2 * areas(corners) / np.maximum(longest, np.finfo(float).tiny)
    along, across = (_steps(x / SAMPLING) for x in (longest, height))
    found, owners = [], []
    for steps in np.unique(np.stack([along, across], axis=1), axis=0):
        x, y = (grid.ravel() for grid in np.meshgrid(*(np.arange(n + 1) / n for n in steps)))
        grid = np.stack([(1 - x) * (1 - y), x * (1 - y), y])
        rows = np.flatnonzero((along == steps[0]) & (across == steps[1]))
        found.append(np.stack([corners[rows, :, axis] @ grid for axis in range(2)]).reshape(2, -1))
        owners.append(np.repeat(charts[rows], len(x)))
    points, owner = np.concatenate(found, axis=1), np.concatenate(owners)
    order, ends = np.argsort(owner, kind="stable"), np.cumsum(np.bincount(owner))[:-1]
    return np.split(points.take(order, axis=1), ends, axis=1)  # by rows in memory, unlike points[:, order]


def _steps(wanted: Array) -> Array:
    """Whole numbers of steps, few different ones: powers of two, or three times one."""
    power = np.exp2(np.ceil(np.log2(np.maximum(wanted, 1))))
    return np.ceil(np.where(0.75 * power >= wanted, 0.75 * power, power)).astype(np.int64)


def _rotation(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
