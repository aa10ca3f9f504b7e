"""Polygons cut into triangles."""

import numpy as np

from mua.arrays import Array


def triangulated(
    points: Array,  # [C, 3] of the corners
    starts: Array,  # [P] first corner of each polygon
    counts: Array,  # [P] corners of each polygon
) -> tuple[Array, Array]:
    """Triangles [F, 3] of corner numbers, and the polygon [F] of each.

    Each polygon is a fan about the corner from which no triangle is folded over, where there is such a corner: a
    quad that is not convex has one.
    """
    triangles, polygons = [np.zeros((0, 3), int)], [np.zeros(0, int)]
    for count in np.unique(counts[counts >= 3]):
        chosen = np.flatnonzero(counts == count)
        ring = starts[chosen, None] + np.arange(count)
        if count > 3:
            ring = np.take_along_axis(ring, (_apex(points[ring])[:, None] + np.arange(count)) % count, axis=1)
        fan = np.stack([np.repeat(ring[:, :1], count - 2, axis=1), ring[:, 1:-1], ring[:, 2:]], axis=2)
        triangles.append(fan.reshape(-1, 3))
        polygons.append(np.repeat(chosen, count - 2))
    order = np.argsort(np.concatenate(polygons), kind="stable")
    return np.concatenate(triangles)[order], np.concatenate(polygons)[order]


def _apex(ring: Array) -> Array:
    """The corner [P] of each polygon [P, n, 3] whose fan folds least; the first of equal ones."""
    normal = np.cross(ring, np.roll(ring, -1, axis=1)).sum(axis=1)
    folds = []
    for first in range(ring.shape[1]):
        turned = np.roll(ring, -first, axis=1) - ring[:, first, None]
        areas = np.einsum("pti,pi->pt", np.cross(turned[:, 1:-1], turned[:, 2:]), normal)
        folds.append((areas < 0).sum(axis=1))
    return np.argmin(folds, axis=0)
