"""How opaque surfels make the surface that they stand for: where it is well below 1, there are holes or dots."""

import numpy as np
from scipy.spatial import cKDTree

from mua import rotation
from mua.arrays import Array

NEAREST = 24  # surfels that may cover a point


def coverage(
    places: Array,  # [S, 3] points of the surface, metres
    centres: Array,  # [N, 3] of the surfels
    rotations: Array,  # [N, 4] unit
    scales: Array,  # [N, 3] standard deviations, metres
    *,
    opacity: float = 1.0,
) -> Array:
    """Opacity [S] at points of a surface seen along the normals of the surfels nearest to them."""
    found = cKDTree(centres).query(places, k=min(NEAREST, len(centres)))[1].reshape(len(places), -1)
    axes = rotation.to_matrix(rotations)
    through = np.ones(len(places))
    for surfel in found.T:
        along = np.einsum("sc,sck->sk", places - centres[surfel], axes[surfel][:, :, :2]) / scales[surfel, :2]
        through *= 1 - opacity * np.exp(-0.5 * np.sum(along * along, axis=1))
    return 1 - through
