"""The 64-byte splat of pack_splats, unpacked; how far a half float of a GPU may lie from the exact value."""

import numpy as np

from mua.arrays import Array
from mua.kernels.dq_skinning import METRES2_TO_MM2

PACKED = np.dtype(
    [
        ("centre", "<f4", 3),
        ("covariance", "<f2", 6),
        ("turn", "<f2", 4),
        ("sh", "<f2", 12),
        ("opacity", "<f4"),
        ("", "<u4"),
    ]
)

LARGEST_HALF = float(np.finfo(np.float16).max)
LEAST_NORMAL_HALF = float(np.finfo(np.float16).tiny)
MANTISSA_BITS = np.finfo(np.float16).nmant


def unpacked(
    words: Array,  # [N, 16] uint32
) -> Array:
    """The fields [N] of PACKED."""
    return np.ascontiguousarray(words, "<u4").reshape(-1).view(PACKED)


def covariance_of(fields: Array) -> Array:
    """[N, 6] square metres, float64."""
    return fields["covariance"].astype(float) / METRES2_TO_MM2


def assert_halves(
    found: Array,  # float16
    exact: Array,  # float64, before it is rounded to a half float
    bound: Array | float,  # of the float32 that the GPU rounds to a half float
) -> None:
    """Within the bound and one half float: GPUs round to the nearest or towards zero, and may flush subnormals."""
    held = np.clip(exact, -LARGEST_HALF, LARGEST_HALF)
    largest = np.minimum(np.abs(held) + bound, LARGEST_HALF)
    ulp = np.exp2(np.floor(np.log2(np.maximum(largest, LEAST_NORMAL_HALF))) - MANTISSA_BITS)
    step = np.where(largest < LEAST_NORMAL_HALF, LEAST_NORMAL_HALF, ulp)
    excess = np.abs(found.astype(float) - held) - bound - step
    assert np.all(excess <= 0), f"{excess.max(initial=0):.3g} beyond the bound"
