"""Whether charts serve their surface: what overlaps, is distorted or has next to no texels, and their scale."""

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components

from mua.arrays import Array
from mua.rig.charts import areas
from mua.rig.texel_map import cover

CELL = 128  # texels along the square in which a chart is searched for overlap
CELLS_SIZE = 2048  # texels along all these squares together

STARVED = 1 / 6  # of its chart's texel density: a triangle below it is starved
SMOOTHING = 3  # rounds over neighbours
PATCH = 0.01  # share of the character's surface from which on a starved patch counts
SCATTERED = 0.02  # share of the surface from which on small patches count together, as colours from a palette do
PULLED = 2.5  # surface over drawing, in the direction in which a triangle is drawn too short for its chart
DISTORTED = 0.15  # share of a chart's surface that may be pulled
MOST_EVENED = (
    1.5  # in length: most that a chart grows beyond its best linear map, or a fold in it would decide its size
)


def overlapping(
    corners: Array,  # [F, 3, 2] UV
    charts: Array,  # [F]
) -> Array:
    """Share of each chart's texels [K] that two of its own triangles claim, each chart seen in a square of its own."""
    count = charts.max() + 1
    across = int(np.ceil(np.sqrt(count)))
    cell = max(min(CELL, CELLS_SIZE // across), 4)
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, charts, corners.min(axis=1))
    np.maximum.at(high, charts, corners.max(axis=1))
    scale = _ratio(np.full(count, float(cell)), (high - low).max(axis=1))
    place = np.stack(np.divmod(charts, across)[::-1], axis=1) * cell
    owner, claims = cover((corners - low[charts, None]) * scale[charts, None, None] + place[:, None], across * cell)
    filled = owner >= 0
    chart = charts[owner[filled]]
    return _ratio(np.bincount(chart, claims[filled] > 1, minlength=count), np.bincount(chart, minlength=count))


def starved(
    corners: Array,  # [F, 3, 2] UV
    positions: Array,  # [F, 3, 3] metres
    nodes: Array,  # [F, 3] int, as for find_charts
    *,
    charts: Array,  # [F]
    distorted: Array,  # [F] bool, belong to charts that are (`distorted`)
) -> Array:
    """Say which triangles [F] have far fewer texels for their surface than the rest of their chart, or none.

    Areas are smoothed over neighbours, and a patch counts where it is a good part of its chart or of the character, so
    that a skirt drawn in a narrow band is found and a nostril is not. Many patches count however small they are. A
    good part of the character that is drawn too short in one direction alone, as tails of a coat, counts as well:
    splats as long as its texels would stand out beyond the hem.
    """
    flat = isometric(corners, positions, charts)
    surface, drawn = areas(positions), areas(flat)
    touches = coo_matrix((np.ones(nodes.size), (np.repeat(np.arange(len(nodes)), 3), nodes.ravel()))).tocsr()
    around = np.stack([surface, drawn, surface * (_pulls(flat, positions) > PULLED)], axis=1)
    for _ in range(SMOOTHING):
        around = touches @ (touches.T @ around)
    there, here, pulled = around.T
    poor, narrow = here < STARVED * there, (pulled > there / 2) & ~distorted
    patch, strip = (_patch_areas(some, touches, surface) for some in (poor, narrow))
    least = PATCH * surface.sum()
    found = (patch > least) | (strip > least) | (patch > np.bincount(charts, surface)[charts] / 2)
    alone = drawn < STARVED * surface
    if surface[alone & ~found].sum() > SCATTERED * surface.sum():
        return found | alone
    beside = touches @ (touches.T @ found) > 0  # smoothing hid the border of the patch
    return found | (beside & alone)


def _patch_areas(
    some: Array,  # [F] bool
    touches: csr_matrix,  # [F, nodes]
    surface: Array,  # [F]
) -> Array:
    """The area [F] of the patch of some triangles that each belongs to, 0 for the others."""
    inside = touches[some]
    patch = connected_components(inside @ inside.T, directed=False)[1]
    areas_of = np.zeros(len(some))
    areas_of[some] = np.bincount(patch, surface[some])[patch]
    return areas_of


def distorted(
    corners: Array,  # [F, 3, 2] UV
    positions: Array,  # [F, 3, 3] metres
    charts: Array,  # [F]
) -> Array:
    """Say which triangles [F] belong to charts that no one linear map brings near to their surface.

    A layout that only picks colours, such as a palette of gradients, lays surfaces into strips. Texels of such a chart
    would be dense here and far apart there.
    """
    if not len(charts):
        return np.zeros(0, bool)
    charts = np.unique(charts, return_inverse=True)[1]
    flat = even(corners, positions, charts)
    surface = areas(positions)
    pulled = np.bincount(charts, surface * (_pulls(flat, positions) > PULLED))
    return (pulled > DISTORTED * np.bincount(charts, surface))[charts]


def _pulls(flat: Array, positions: Array) -> Array:
    """Surface over drawing [F], in the direction in which each triangle is drawn shortest."""
    sides = np.linalg.pinv(flat[:, 1:] - flat[:, :1]) @ (positions[:, 1:] - positions[:, :1])
    return np.linalg.svd(sides, compute_uv=False)[:, 0]


def isometric(
    corners: Array,  # [F, 3, 2] UV
    positions: Array,  # [F, 3, 3] metres
    charts: Array,  # [F]
) -> Array:
    """Stretch each chart by the one linear map that brings it closest to its surface: [F, 3, 2] metres, starting at 0.

    The map is the root of the chart's mean metric tensor; the mean is taken of logarithms, over the chart's area in UV,
    so that neither slivers nor a fold that hides in a few texels rule it.
    """
    edges = corners[:, 1:] - corners[:, :1]  # [F, 2 edges, 2]
    sides = positions[:, 1:] - positions[:, :1]
    flat = np.linalg.pinv(edges)
    value, axes = np.linalg.eigh(flat @ sides @ sides.transpose(0, 2, 1) @ flat.transpose(0, 2, 1))
    weight = areas(corners) * (value[:, 0] > 0)
    logs = (axes * np.log(np.where(value > 0, value, 1))[:, None]) @ axes.transpose(0, 2, 1)
    mean = np.stack([np.bincount(charts, weight * logs[:, i, j]) for i, j in ((0, 0), (0, 1), (0, 1), (1, 1))], axis=1)
    value, axes = np.linalg.eigh(_ratio(mean, np.bincount(charts, weight)[:, None]).reshape(-1, 2, 2))
    stretch = (axes * np.exp(value / 2)[:, None]) @ axes.transpose(0, 2, 1)
    moved = corners @ stretch[charts]
    low = np.full((charts.max() + 1, 2), np.inf)
    np.minimum.at(low, charts, moved.min(axis=1))
    return moved - low[charts, None]


def even(
    corners: Array,  # [F, 3, 2] UV
    positions: Array,  # [F, 3, 3] metres
    charts: Array,  # [F]
) -> Array:
    """`isometric`, with each chart as large in area as its surface within bounds: [F, 3, 2] metres."""
    flat = isometric(corners, positions, charts)
    drawn, surface = np.bincount(charts, areas(flat)), np.bincount(charts, areas(positions))
    return flat * np.clip(np.sqrt(_ratio(surface, drawn)), 1, MOST_EVENED)[charts, None, None]


def _ratio(a: Array, b: Array) -> Array:
    """a / b, and 0 where b is 0."""
    return np.divide(a, b, out=np.zeros(a.shape), where=b > 0)
