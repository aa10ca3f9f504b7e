"""Back-to-front order of the splats: a stable radix sort of 16-bit keys, least significant digit first, 2 x 8 bit."""

import numpy as np

from mua.arrays import Array
from mua.kernels.splat_project import HIDDEN

DIGIT_BITS = 8
KEY_BITS = 16


def splat_sort(
    keys: Array,  # [N] uint16
) -> Array:
    """The stable ascending order of the keys that are not HIDDEN, [M] int32 indices into all of them."""
    order = np.flatnonzero(keys != HIDDEN).astype(np.int32)
    for shift in range(0, KEY_BITS, DIGIT_BITS):
        digits = (keys[order] >> shift).astype(np.uint8)
        order = order[_scatter(digits)]
    return order


def _scatter(
    digits: Array,  # [M] uint8
) -> Array:
    """The element for each place of the output: bucket by bucket, in order of arrival inside a bucket."""
    return np.concatenate([np.flatnonzero(digits == d) for d in range(1 << DIGIT_BITS)])
