"""How far splats lie below the surface: less far in thin parts, so that no side comes out in front of the other.

A splat on edge shows its tails beyond the outline, so that it is sunk. In a plate whose inside is a surface of its own,
the sunk splats of both sides would pass through each other, and the wrong side would be seen.
"""

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array

SINK = 0.45  # of its smaller standard deviation, by which a splat lies below the surface: on edge, many tails add up
NEAREST = 12  # texels among which the other side is sought
OPPOSITE = -0.8  # cosine between normals up to which a texel is one of the other side
TOUCHING = 0.1  # full depths: rounding aside, two sides at one place
BESIDE = 2.0  # deviations: what lies farther to the side is not behind


def depths(
    places: Array,  # [N, 3] of the texels, metres
    *,
    normals: Array,  # [N, 3] unit
    deviations: Array,  # [N] the smaller one of each texel's splat along the surface, metres
) -> Array:
    """Depths [N] below the surface, metres: the two sides stay twice the full depth apart, or as far as they are."""
    whole = SINK * deviations
    sought = places - 2 * whole[:, None] * normals
    near = cKDTree(places).query(sought, k=range(1, min(NEAREST, len(places)) + 1), workers=-1)[1]
    apart = places[:, None] - places[near]
    below = np.einsum("nkc,nc->nk", apart, normals)
    beside = np.sqrt(np.maximum(np.sum(apart**2, axis=2) - below**2, 0))
    facing = np.einsum("nkc,nc->nk", normals[near], normals)
    # along the normal to the plane of the other texel
    thickness = np.einsum("nkc,nkc->nk", apart, normals[near]) / np.minimum(facing, OPPOSITE)
    behind = (facing < OPPOSITE) & (thickness >= -TOUCHING * whole[:, None]) & (beside < BESIDE * deviations[:, None])
    thinnest = np.where(behind, thickness, np.inf).min(axis=1)
    return np.asarray(np.clip(thinnest / 2 - whole, 0, whole))
