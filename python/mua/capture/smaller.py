"""Images made smaller: each new pixel is the mean of the area that it covers, parts of pixels counted as parts."""

import numpy as np

from mua.arrays import Array


def area_average(
    picture: Array,  # [H, W, C]
    row_edges: Array,  # [h + 1] ascending, where the new rows begin and end in the image, 0..H
    column_edges: Array,  # [w + 1]
) -> Array:
    """The smaller image [h, w, C] float32."""
    rows = _averages(picture.astype(np.float32), row_edges)
    return np.ascontiguousarray(_averages(rows.swapaxes(0, 1), column_edges).swapaxes(0, 1))


def _averages(
    values: Array,  # [N, ...] float32
    edges: Array,  # [n + 1]
) -> Array:
    """The mean [n, ...] of the values between neighbouring edges."""
    if np.array_equal(edges, np.arange(len(values) + 1)):
        return values
    from scipy.sparse import csr_matrix  # not needed for whole images

    first = np.floor(edges[:-1]).astype(int)
    last = np.minimum(np.ceil(edges[1:]).astype(int), len(values))  # edges are rounded
    counts = last - first
    new = np.repeat(np.arange(len(counts)), counts)
    old = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts) + first[new]
    overlap = np.minimum(old + 1, edges[new + 1]) - np.maximum(old, edges[new])
    weights = (overlap / (edges[new + 1] - edges[new])).astype(np.float32)
    matrix = csr_matrix((weights, (new, old)), shape=(len(counts), len(values)))
    return np.asarray(matrix @ values.reshape(len(values), -1)).reshape(len(counts), *values.shape[1:])
