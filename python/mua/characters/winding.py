"""Closed pieces of a surface that are wound inside out. Nobody sees them from within, so all should face outward."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from mua.arrays import Array


def inside_out(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
) -> Array:
    """Which triangles [F] belong to closed pieces whose triangles all face inward.

    A piece is closed where every edge has one triangle on either side, which pass it in opposite directions.
    """
    if not len(faces):
        return np.zeros(0, bool)
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2)
    ends = np.ones(len(edges)), (edges[:, 0], edges[:, 1])
    passed = sparse.csr_matrix(ends, shape=(len(vertices), len(vertices)))  # times in each direction
    count, piece = connected_components(passed, directed=False)
    piece = piece[faces[:, 0]]
    there, back = (np.asarray(one[edges[:, 0], edges[:, 1]]).ravel() for one in (passed, passed.T.tocsr()))
    open_edges = ((there != 1) | (back != 1)).reshape(-1, 3).any(axis=1)
    # About a point of each piece, or rounding would decide on what is small and far from the origin.
    origins = np.zeros((count, 3))
    origins[piece] = vertices[faces[:, 0]]
    a, b, c = (vertices[faces[:, corner]] - origins[piece] for corner in range(3))
    volumes = np.bincount(piece, np.einsum("ni,ni->n", a, np.cross(b, c)), minlength=count)
    closed = np.bincount(piece, open_edges, minlength=count) == 0
    return (closed & (volumes < 0))[piece]
