"""One fully connected layer, y = act(W x + b); without activation it also expands the PCA mesh."""

import numpy as np

from mua.arrays import Array


def mlp_matmul(
    weight: Array,  # [out, in]
    bias: Array,  # [out]
    x: Array,  # [in]
    *,
    relu: bool,
) -> Array:
    """Return y [out] = W x + b, negative outputs set to zero where `relu`."""
    y = weight @ x + bias
    return np.maximum(y, 0) if relu else y
