"""Smooth filling of the texels outside the UV charts, so that chart borders put no energy into the detail subbands.

Push-pull (Gortler et al. 1996, https://doi.org/10.1145/237170.237200): averages of the valid texels are pushed up an
image pyramid and pulled down again by bilinear interpolation wherever a level is empty; one Jacobi sweep of Laplace's
equation per level then takes the corners out. Everything wraps around, as the periodized wavelet transform does.
Each step is linear, so that it is a sparse matrix which follows from the map alone.
"""

from functools import lru_cache

import numpy as np
import torch
from scipy import sparse
from torch import Tensor

from mua.arrays import Array
from mua.errors import InputError
from mua.rig.texel_map import TexelMap


class Fill:
    """The filling of one texel map."""

    def __init__(self, texels: TexelMap) -> None:
        """Raises InputError where no texel is valid: then there is nothing to fill from."""
        if len(texels.texels) == 0:
            raise InputError(f"texel map: of {texels.size} x {texels.size} texels none is valid, expected at least one")
        self._size = texels.size
        valid: Array = np.zeros(texels.size**2, dtype=bool)
        valid[texels.texels] = True
        valid = valid.reshape(texels.size, texels.size)
        self._levels = []  # fine first: the push from a level's known cells, and the pull to all of its cells
        while not valid.all() and len(valid) % 2 == 0:
            push, coarser = _push(valid)
            self._levels.append((push, _pull(valid)))
            valid = coarser
        self._levels.append(_mean(valid))

    def __call__(
        self,
        values: Tensor,  # [N, C] any float type, at the valid texels in the order of the map
    ) -> Tensor:
        """Images [C, H, W] of the same type that keep `values` at the valid texels and are smooth elsewhere."""
        images = torch.from_numpy(self._filled(np.ascontiguousarray(values.T.numpy())))
        return images.to(values.dtype).view(-1, self._size, self._size)

    def _filled(self, planes: Array, level: int = 0) -> Array:
        """All cells [C, n n] of a level whose known ones are given, [C, K]."""
        if level == len(self._levels):
            return planes
        push, pull = self._levels[level]
        coarser = self._filled(_product(push, planes), level + 1)
        return _product(pull, np.concatenate([planes, coarser], axis=1))


fill_of = lru_cache(maxsize=1)(Fill)  # of the map that was asked for last: parts of a recording share theirs


def _product(matrix: sparse.csr_matrix, planes: Array) -> Array:
    """A matrix [M, K] times each of the planes [C, K]: one by one, as the cache of a CPU holds one."""
    return np.stack([matrix @ plane for plane in planes])


def _push(valid: Array) -> tuple[sparse.csr_matrix, Array]:
    """The averages of a level's known cells that are the known cells of the next one, and which of its cells these are.

    The matrix is [K', K].
    """
    half = len(valid) // 2
    row, column = np.nonzero(valid)
    above = row // 2 * half + column // 2
    counts = np.bincount(above, minlength=half * half)
    known, rank = np.unique(above, return_inverse=True)
    weights = (1 / counts[above]).astype(np.float32)
    matrix = sparse.csr_matrix((weights, (rank, np.arange(len(above)))), shape=(len(known), len(above)))
    return matrix, (counts > 0).reshape(half, half)


def _pull(valid: Array) -> sparse.csr_matrix:
    """All cells of a level by its known ones and all of the next level's, [n n, K + n n / 4]."""
    known, empty = np.flatnonzero(valid), np.flatnonzero(~valid)
    axis = _upsampling(len(valid))
    beside = _neighbours(len(valid), empty)
    rows = sparse.hstack([beside[:, known], beside[:, empty] @ sparse.kron(axis, axis).tocsr()[empty]])
    kept = sparse.eye(len(known), rows.shape[1], dtype=np.float32)
    order = np.argsort(np.concatenate([known, empty]))
    return sparse.vstack([kept, rows]).tocsr()[order]


def _mean(valid: Array) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
    """The mean [1, K] of the known cells, and all cells [n n, K + 1] by them and by that."""
    count = int(valid.sum())
    columns = np.where(valid.ravel(), np.cumsum(valid) - 1, count)
    ones = np.ones(valid.size, dtype=np.float32)
    pull = sparse.csr_matrix((ones, (np.arange(valid.size), columns)), shape=(valid.size, count + 1))
    return sparse.csr_matrix(np.full((1, count), 1 / count, dtype=np.float32)), pull


def _upsampling(size: int) -> sparse.csr_matrix:
    """Bilinear and periodic along one axis, [n, n / 2]."""
    fine = np.arange(size)
    near, far = fine // 2, (fine // 2 + 2 * (fine % 2) - 1) % (size // 2)
    weights = np.repeat(np.array([0.75, 0.25], dtype=np.float32), size)
    at = np.concatenate([fine, fine]), np.concatenate([near, far])
    return sparse.csr_matrix((weights, at), shape=(size, size // 2))


def _neighbours(size: int, cells: Array) -> sparse.csr_matrix:
    """The means of the four cells around some, periodic, [E, n n]."""
    row, column = np.divmod(cells, size)
    steps = ((1, 0), (-1, 0), (0, 1), (0, -1))
    around = [(row + down) % size * size + (column + right) % size for down, right in steps]
    at = np.tile(np.arange(len(cells)), 4), np.concatenate(around)
    weights = np.full(len(at[0]), 0.25, dtype=np.float32)
    return sparse.csr_matrix((weights, at), shape=(len(cells), size * size))
