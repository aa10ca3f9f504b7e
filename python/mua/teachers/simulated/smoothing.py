"""Smoothing of fields on a surface by its Laplacian, in one sparse solve."""

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from mua.arrays import Array

TURN_WAVELENGTH = 0.08  # metres on a person: in the crease of a knee skinning turns the surface faster than texels hold


def low_pass(vertices: Array, faces: Array, wavelength: float) -> Callable[[Array], Array]:
    """A filter for fields [V, c] on a surface that halves waves of this length and keeps longer ones: (M + t L)^-1 M.

    L is the cotangent Laplacian without its negative weights, M the area about each vertex.
    """
    a, b, c = vertices[faces].swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    count = len(vertices)
    mass = np.bincount(faces.ravel(), np.repeat(area / 3, 3), count)
    weight = sparse.diags(np.maximum(mass, 1e-6 * mass.mean()))
    links = sparse.csr_matrix((count, count))
    for corner, (p, q, r) in enumerate(((a, b, c), (b, c, a), (c, a, b))):
        cotangent = np.sum((q - p) * (r - p), axis=1) / np.maximum(4 * area, 1e-12)
        ends = faces[:, (corner + 1) % 3], faces[:, (corner + 2) % 3]
        links = links + sparse.csr_matrix((cotangent, ends), shape=(count, count))
    links = (links + links.T).maximum(0)
    stiffness = sparse.diags(np.asarray(links.sum(axis=1)).ravel()) - links
    t = (wavelength / (2 * np.pi)) ** 2
    system = (weight + t * stiffness).tocsc()
    factors = linalg.splu(system, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    return lambda field: np.asarray(factors.solve(np.asarray(weight @ field)))
