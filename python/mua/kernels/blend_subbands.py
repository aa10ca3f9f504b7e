"""Dynamic subbands from coefficients (paper, Dynamic low-frequency and mid-frequency subbands)."""

import numpy as np

from mua.arrays import Array


def blend_ll(
    mean: Array,  # [C, n, n]
    basis: Array,  # [C, R, n, n]
    alpha: Array,  # [C, R]
) -> Array:
    """LL [C, n, n] = mean + sum_r alpha(r, c) B(:, :, r, c)."""
    channels, rank, rows, columns = basis.shape
    blended = alpha[:, None, :] @ basis.reshape(channels, rank, rows * columns)
    return np.asarray(mean + blended.reshape(mean.shape))


def blend_detail(
    mean: Array,  # [3, C, n, n]
    h: Array,  # [3, C, R, n] along rows
    w: Array,  # [3, C, R, n] along columns
    alpha: Array,  # [C, R], shared by the three bands
) -> Array:
    """The detail bands of one level [3, C, n, n] = mean + sum_r alpha(r, c) h_s(:, r, c) (x) w_s(:, r, c)."""
    return np.asarray(mean + (alpha[:, :, None] * h).swapaxes(2, 3) @ w)
