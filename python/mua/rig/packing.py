"""Places charts in a square, turned and close together, by trying every place of a coarse grid for each.

Charts are laid down from large to small. Where a chart fits is the correlation of its mask with what is taken; of all
places and turns the one is chosen that touches most of what lies there. Correlations are products of spectra, and for
a chart so small that it is taken for its box, sums over boxes.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.ndimage import binary_dilation, gaussian_filter
from scipy.spatial import ConvexHull, QhullError

from mua.arrays import Array
from mua.rig.charts import areas

GRID = 256  # cells along the square that the charts are meant to fill
GUTTER = 1  # cells between charts
FULL = 0.9  # share of that square which charts and half of their gutters would fill; what does not fit goes beyond
ROOM = 1.2  # cells along the whole grid, over those of the square
SAMPLING = 0.5  # cells between points of a chart
TURNS = 8  # tried for a chart, starting along its narrowest box
FEW_TURNS = 4  # for one with less than LARGE of the cells
LARGE = 0.004
BOX = 12  # cells along the longer side of a chart that is taken for its box
NEAR = 2.0  # cells over which touching counts
BLUR = 8  # cells beyond which nothing is near
POINTS_AT_ONCE = 1 << 20


@dataclass(frozen=True)
class _Turned:
    """A chart turned by an angle, on the grid."""

    angle: float
    origin: Array  # [2] x, y of the corner of its box, in cells
    solid: Array  # [h, w] bool, with a margin of GUTTER
    mask: Array  # [h, w] bool, grown by GUTTER


@dataclass(frozen=True)
class _Place:
    """Where a turned chart would lie."""

    score: float
    turned: _Turned
    row: int
    column: int
    reach: int  # cells that it makes the square wide


def pack(
    corners: Array,  # [F, 3, 2] all charts in one scale
    charts: Array,  # [F], numbered from 0
) -> Array:
    """Place the charts in the unit square, as large as they fit without overlap: [F, 3, 2]."""
    scaled = corners * (GRID / np.sqrt(max(areas(corners).sum(), np.finfo(float).tiny)))
    scaled *= np.sqrt(FULL * GRID**2 / sum(_cells(chart) for chart in _points(scaled, charts)))
    points = _points(scaled, charts)
    ground = _Ground()
    placed = np.empty_like(scaled)
    faces = np.split(np.argsort(charts, kind="stable"), np.cumsum(np.bincount(charts))[:-1])
    cells = np.array([_cells(chart) for chart in points])
    for chart in np.argsort(-cells, kind="stable"):
        place = ground.best(_turns(points[chart], TURNS if cells[chart] > LARGE * GRID**2 else FEW_TURNS))
        ground.take(place)
        at = np.array([place.column, place.row]) + GUTTER - place.turned.origin
        placed[faces[chart]] = scaled[faces[chart]] @ _rotation(place.turned.angle).T + at
    placed -= placed.min(axis=(0, 1))
    return placed / max(placed.max(), np.finfo(float).tiny)


class _Ground:
    """What is taken of the grid, and how wide the square around it is."""

    def __init__(self) -> None:
        self._reach = GRID
        self._taken = np.zeros((0, 0), np.float32)
        self._near = np.zeros((2 * BLUR, 2 * BLUR), np.float32)  # to what is taken; BLUR cells wider on all sides
        self._extend(int(ROOM * GRID))

    def best(self, turned: list[_Turned]) -> _Place:
        """The place and the turn that touch most of what is taken or of the border, within the square if any is."""
        sums = _box_sums if max(turned[0].mask.shape) <= BOX else _correlations
        while True:
            fields = np.stack([self._taken, self._near[BLUR:-BLUR, BLUR:-BLUR]])
            fitting = [one for one in turned if max(one.mask.shape) <= len(self._taken)]
            found = [self._scored(one, *under) for one, under in zip(fitting, sums(fields, fitting), strict=True)]
            best = max((place for place in found if place), key=lambda place: place.score, default=None)
            if best:
                return best
            self._extend(int(ROOM * len(self._taken)) + max(turned[0].mask.shape))

    def take(self, place: _Place) -> None:
        """Lay the chart down."""
        height, width = place.turned.solid.shape
        self._taken[place.row :, place.column :][:height, :width] += place.turned.solid
        around = gaussian_filter(np.pad(place.turned.solid, BLUR).astype(np.float32), NEAR, mode="constant")
        self._near[place.row :, place.column :][: height + 2 * BLUR, : width + 2 * BLUR] += around
        self._reach = max(self._reach, place.reach)

    def _extend(self, side: int) -> None:
        """Make the grid this large; its upper and left borders count as taken where it comes to touching."""
        before = len(self._taken)
        side = fft.next_fast_len(side, real=True)
        more = (0, side - before)
        self._taken, self._near = np.pad(self._taken, (more, more)), np.pad(self._near, (more, more))
        beyond = np.arange(-BLUR, side + BLUR) < 0
        border = gaussian_filter((beyond[:, None] | beyond).astype(np.float32), NEAR)
        border[: before + 2 * BLUR, : before + 2 * BLUR] = 0
        self._near += border

    def _scored(self, turned: _Turned, hits: Array, touching: Array) -> _Place | None:
        """The best place for one turn, None where it fits nowhere."""
        height, width = turned.mask.shape
        side = len(self._taken)
        rows, columns = side - height + 1, side - width + 1
        reach = np.maximum(np.arange(rows)[:, None] + height, np.arange(columns) + width) - GUTTER
        score = touching[:rows, :columns] / np.sqrt(np.count_nonzero(turned.mask))
        score -= side * np.maximum(reach - self._reach, 0)
        score[hits[:rows, :columns] > SAMPLING] = -np.inf
        row, column = divmod(int(score.argmax()), columns)
        if score[row, column] == -np.inf:
            return None
        return _Place(float(score[row, column]), turned, row, column, int(reach[row, column]))


def _correlations(fields: Array, turned: list[_Turned]) -> list[Array]:
    """For each turn, sums [2, side, side] of both fields under its mask by where its first corner lies."""
    shape = fields.shape[1:]
    spectra = fft.rfft2(fields)
    found = []
    for one in turned:
        mask = np.zeros(shape, np.float32)
        mask[: one.mask.shape[0], : one.mask.shape[1]] = one.mask
        found.append(fft.irfft2(spectra * np.conj(fft.rfft2(mask)), s=shape))
    return found


def _box_sums(fields: Array, turned: list[_Turned]) -> list[Array]:
    """`_correlations` for masks that fill their boxes."""
    sums = np.pad(fields.astype(np.float64).cumsum(axis=1).cumsum(axis=2), ((0, 0), (1, 0), (1, 0)))
    found = []
    for one in turned:
        h, w = one.mask.shape
        found.append(sums[:, h:, w:] - sums[:, :-h, w:] - sums[:, h:, :-w] + sums[:, :-h, :-w])
    return found


def _cells(points: Array) -> float:
    """How many cells a chart's points [n, 2] take with half of the gutter around them."""
    (one,) = _turns(points, 1)
    return (np.count_nonzero(one.solid) + np.count_nonzero(one.mask)) / 2


def _turns(points: Array, count: int) -> list[_Turned]:
    """A chart's points [n, 2] at angles that divide the full turn, the first along its narrowest box."""
    start = _narrowest(points)
    turned = []
    for angle in start + 2 * np.pi * np.arange(count) / count:
        moved = points @ _rotation(angle).T
        origin = moved.min(axis=0)
        column, row = np.floor(moved - origin).astype(np.int64).T + GUTTER
        solid = np.zeros((row.max() + 1 + GUTTER, column.max() + 1 + GUTTER), bool)
        solid[row, column] = True
        turned.append(_Turned(angle, origin, solid, binary_dilation(solid, np.ones((3, 3)), iterations=GUTTER)))
    if max(turned[0].mask.shape) <= BOX:
        return [
            _Turned(t.angle, t.origin, np.ones_like(t.solid), np.ones_like(t.mask))
            for t in turned[:: max(count // FEW_TURNS, 1)]
        ]
    return turned


def _narrowest(points: Array) -> float:
    """The angle that turns the least box around the points [n, 2] upright."""
    try:
        hull = points[ConvexHull(points).vertices]
    except (QhullError, ValueError):  # on a line, or too few
        hull = points[[points[:, 0].argmin(), points[:, 0].argmax()]]
    sides = np.roll(hull, -1, axis=0) - hull
    angles = -np.arctan2(sides[:, 1], sides[:, 0])
    turned = np.einsum("aij,nj->ani", np.array([_rotation(angle) for angle in angles]), hull)
    return float(angles[np.ptp(turned, axis=1).prod(axis=1).argmin()])


def _rotation(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _points(
    corners: Array,  # [F, 3, 2] in cells
    charts: Array,  # [F]
) -> list[Array]:
    """Points [n, 2] on each chart's triangles, at most SAMPLING apart, corners among them."""
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)  # [F, 3], side k ends at corner k
    first = (sides.argmax(axis=1)[:, None] + [2, 0, 1]) % 3  # corners, those of the longest side first
    corners, longest = np.take_along_axis(corners, first[..., None], axis=1), sides.max(axis=1)
    height = 2 * areas(corners) / np.maximum(longest, np.finfo(float).tiny)
    along, across = (1 << np.ceil(np.log2(np.maximum(x / SAMPLING, 1))).astype(np.int64) for x in (longest, height))
    found, owners = [], []
    for steps in np.unique(np.stack([along, across], axis=1), axis=0):
        x, y = (grid.ravel() for grid in np.meshgrid(*(np.arange(n + 1) / n for n in steps)))
        grid = np.stack([(1 - x) * (1 - y), x * (1 - y), y], axis=1)
        rows = np.flatnonzero((along == steps[0]) & (across == steps[1]))
        for some in np.array_split(rows, -(-len(rows) * len(grid) // POINTS_AT_ONCE)):
            found.append(np.einsum("gk,nkd->ngd", grid, corners[some]).reshape(-1, 2))
            owners.append(np.repeat(charts[some], len(grid)))
    points, owner = np.concatenate(found), np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.split(points[order], np.cumsum(np.bincount(owner))[:-1])
