"""Redraws charts so that each place of them gets the size that it should have, without new cuts.

A grid over each chart, with the gaps between its flaps, is drawn as rigid as possible (Liu et al. 2008,
https://doi.org/10.1111/j.1467-8659.2008.01290.x) towards cells of the wanted sizes: turns are fitted to the cells, then
corners to the turned cells, and so on. A chart moves with its grid, and cannot overlap itself while no cell folds.
"""

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.sparse import coo_matrix, identity
from scipy.sparse.linalg import splu

from mua.arrays import Array
from mua.atlas.chart_shapes import narrowest_angles
from mua.atlas.filtering import filled
from mua.rig.charts import areas, signed_areas
from mua.rig.texel_map import cover

CELLS = 48  # along the larger side of a chart, a margin of one on each side included
LARGE = 0.003  # share of the area of all charts from which on a chart is redrawn; others are scaled as a whole
EVEN = 1.2  # largest over smallest wanted size, up to which a chart is scaled as a whole as well
SMALLEST, LARGEST = 0.4, 4.0  # of a chart's mean, in length
SMOOTHING = 1.5  # cells, standard deviation
GAP = 0.1  # stiffness of cells that the chart does not cover, over that of the others
ROUNDS = 8
HOLD = 1e-6  # of the mean stiffness, with which corners keep to their places: nothing drifts
WAYS = (1.0, 0.7, 0.5, 0.35, 0.25)  # shares of the way, of which the first is gone at which no cell folds
LONGEST = 1.15  # length of a chart over the side of a square as large as all: that is about what they are packed in
FINE = 384  # texels along a square around a chart, in which its triangles are looked at for overlap
THINNEST = 0.03  # of its wanted area, that each cell has


def redrawn(
    corners: Array,  # [F, 3, 2]
    charts: Array,  # [F], numbered from 0
    larger: Array,  # [F] in length
) -> Array:
    """Charts whose triangles are about `larger` times as large as they were: [F, 3, 2]."""
    area = areas(corners)
    drawn = np.bincount(charts, area)
    mean = np.sqrt(np.bincount(charts, area * larger**2) / np.maximum(drawn, np.finfo(float).tiny))[charts]
    larger = mean * np.clip(larger / np.maximum(mean, np.finfo(float).tiny), SMALLEST, LARGEST)
    result = corners * mean[:, None, None]
    for chart in np.flatnonzero(drawn > LARGE * drawn.sum()):
        rows = np.flatnonzero(charts == chart)
        if larger[rows].max() > EVEN * larger[rows].min():
            result[rows] = _unfolded(result[rows], _with_grid(corners[rows], larger[rows]))
    return _fitting(result, charts)


def _unfolded(start: Array, end: Array) -> Array:
    """One chart as far on the way from start to end as none of its triangles covers another that it did not cover."""
    turned, twice = np.sign(signed_areas(start)), _covered_twice(start)
    for way in WAYS:
        moved = start + way * (end - start)
        if (np.sign(signed_areas(moved)) == turned).all() and _covered_twice(moved) <= twice:
            return np.asarray(moved)
    return start


def _covered_twice(corners: Array) -> int:
    """How many of FINE x FINE squares around one chart two of its triangles claim."""
    low = corners.min(axis=(0, 1))
    claims = cover((corners - low) * (FINE / np.ptp(corners.reshape(-1, 2), axis=0).max()), FINE)[1]
    return int(np.count_nonzero(claims > 1))


def _fitting(
    corners: Array,  # [F, 3, 2]
    charts: Array,  # [F]
) -> Array:
    """Charts no longer than LONGEST of a square as large as all of them: one long chart would make all others small."""
    angles = narrowest_angles(corners, charts)[charts]
    x, y = np.moveaxis(corners, 2, 0)
    cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
    turned = np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=2)
    low, high = np.full((charts.max() + 1, 2), np.inf), np.full((charts.max() + 1, 2), -np.inf)
    np.minimum.at(low, charts, turned.min(axis=1))
    np.maximum.at(high, charts, turned.max(axis=1))
    longest = max(LONGEST * float(np.sqrt(areas(corners).sum())), np.finfo(float).tiny)
    return corners * (longest / np.maximum((high - low).max(axis=1), longest))[charts][:, None, None]


def _with_grid(corners: Array, larger: Array) -> Array:
    """One chart, moved with its grid."""
    cell = np.ptp(corners.reshape(-1, 2), axis=0).max() / (CELLS - 2)
    at = (corners - corners.min(axis=(0, 1))) / cell + 1
    owner = cover(at, CELLS)[0].reshape(CELLS, CELLS)
    empty = owner < 0
    if empty.all():
        return np.asarray(corners * np.sqrt(np.mean(larger**2)))
    size = filled(np.log(larger)[np.maximum(owner, 0)][..., None], empty)[..., 0]
    grid = _drawn(np.exp(gaussian_filter(size, SMOOTHING, mode="nearest")), np.where(empty, GAP, 1.0))
    first = np.floor(at).astype(np.int64)
    right, down = np.moveaxis(at - first, 2, 0)[..., None]
    column, row = np.moveaxis(first, 2, 0)
    above = (1 - right) * grid[row, column] + right * grid[row, column + 1]
    below = (1 - right) * grid[row + 1, column] + right * grid[row + 1, column + 1]
    return np.asarray(cell * ((1 - down) * above + down * below))


def _drawn(
    size: Array,  # [CELLS, CELLS] wanted, in length
    stiffness: Array,  # [CELLS, CELLS]
) -> Array:
    """Places of the corners of a grid's cells [CELLS + 1, CELLS + 1, 2]."""
    start, ends = _halves(CELLS)
    size, stiffness = np.tile(size.ravel(), 2), np.tile(stiffness.ravel(), 2)
    rest = start[ends] * size[:, None, None]
    gradients, area = _gradients(rest)
    weighted = (stiffness * area)[:, None, None] * gradients
    entries = np.einsum("fki,fli->fkl", weighted, gradients).ravel()
    matrix = coo_matrix((entries, (np.repeat(ends, 3, axis=1).ravel(), np.tile(ends, (1, 3)).ravel()))).tocsc()
    hold = HOLD * matrix.diagonal().mean()
    solver = splu(matrix + hold * identity(len(start), format="csc"))
    start = start * np.sqrt(np.average(size**2, weights=stiffness))
    places = start
    for _ in range(ROUNDS):
        turns = _nearest_turns(np.einsum("fkc,fki->fci", places[ends], gradients))
        pull = np.einsum("fki,fci->fkc", weighted, turns)
        pulls = [np.bincount(ends.ravel(), pull[..., axis].ravel(), len(start)) for axis in (0, 1)]
        places = solver.solve(np.stack(pulls, axis=1) + hold * places)
    for way in WAYS:
        moved = start + way * (places - start)
        if (signed_areas(moved[ends]) > THINNEST * area).all():
            return np.asarray(moved.reshape(CELLS + 1, CELLS + 1, 2))
    return np.asarray(start.reshape(CELLS + 1, CELLS + 1, 2))


def _halves(cells: int) -> tuple[Array, Array]:
    """Corners [(cells + 1)^2, 2] of a grid, and its cells' halves [2 cells^2, 3]: diagonals take turns."""
    row, column = np.divmod(np.arange((cells + 1) ** 2), cells + 1)
    corner = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]))
    odd = (np.add.outer(np.arange(cells), np.arange(cells)) % 2 == 1).ravel()
    first = np.stack([a, b, np.where(odd, c, d)], axis=1)
    second = np.stack([np.where(odd, b, a), d, c], axis=1)
    return np.stack([column, row], axis=1).astype(float), np.concatenate([first, second])


def _gradients(
    rest: Array,  # [n, 3, 2]
) -> tuple[Array, Array]:
    """Gradients [n, 3, 2] of the linear functions that are 1 at one corner of a triangle and 0 at others, and areas."""
    area = signed_areas(rest)
    opposite = np.roll(rest, -2, axis=1) - np.roll(rest, -1, axis=1)
    across = np.stack([-opposite[..., 1], opposite[..., 0]], axis=-1)
    return across / (2 * area[:, None, None]), area


def _nearest_turns(
    maps: Array,  # [n, 2, 2]
) -> Array:
    """The rotations [n, 2, 2] nearest to linear maps."""
    x, y = maps[:, 0, 0] + maps[:, 1, 1], maps[:, 1, 0] - maps[:, 0, 1]
    length = np.maximum(np.hypot(x, y), np.finfo(float).tiny)
    c, s = x / length, y / length
    return np.stack([c, -s, s, c], axis=1).reshape(-1, 2, 2)
