"""The 32-byte splat of pack_splats, unpacked; how far what a GPU rounds may lie from the exact value."""

import numpy as np

from mua.arrays import Array

PACKED = np.dtype(
    [
        ("centre", "<f4", 3),
        ("colors", "<u4", 2),  # colours of both eyes, with the opacity
        ("axes", "<f2", (2, 2)),  # axes for either eye: column and row, pixels
        ("minors", "<f2", 2),
    ]
)

LARGEST_HALF = float(np.finfo(np.float16).max)
LEAST_NORMAL_HALF = float(np.finfo(np.float16).tiny)
MANTISSA_BITS = np.finfo(np.float16).nmant


def unpacked(
    words: Array,  # [N, 8] uint32
) -> Array:
    """The fields [N] of PACKED."""
    return np.ascontiguousarray(words, "<u4").reshape(-1).view(PACKED)


def color_scales(
    splats: Array,  # [N] of PACKED
) -> Array:
    """What 1023 steps of a splat's colours stand for, [N]."""
    return np.asarray(2.0 ** (splats["colors"][:, 0] >> 30))


def colors_of(
    splats: Array,  # [N] of PACKED
) -> Array:
    """sRGB towards both eyes, [2, N, 3]."""
    mean = (splats["colors"][:, :1] >> np.array([0, 10, 20], np.uint32)) % 1024
    tint = (splats["colors"][:, 1:] >> np.array([11, 18, 25], np.uint32)) % 128 - 64.0
    return np.asarray(np.maximum([mean + tint, mean - tint], 0) * (color_scales(splats) / 1023)[:, None])


def opacities_of(
    splats: Array,  # [N] of PACKED
) -> Array:
    return np.asarray(splats["colors"][:, 1] % 2048 / 2047)


def screen_covariance(
    splats: Array,  # [N] of PACKED
    eye: int,
) -> Array:
    """[N, 2, 2] square pixels, of the ellipses of one eye."""
    axes, minors = splats["axes"][:, eye].astype(float), splats["minors"][:, eye].astype(float)
    along = axes / np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), 1e-30)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) * minors[:, None]
    return axes[:, :, None] * axes[:, None, :] + across[:, :, None] * across[:, None, :]


def assert_halves(
    found: Array,  # float16
    exact: Array,  # float64, before it is rounded to a half float
    bound: Array | float,  # error of the float32 that the GPU rounds to a half float
) -> None:
    """Within the bound and one half float: GPUs round to the nearest or towards zero, and may flush subnormals."""
    held = np.clip(exact, -LARGEST_HALF, LARGEST_HALF)
    largest = np.minimum(np.abs(held) + bound, LARGEST_HALF)
    ulp = np.exp2(np.floor(np.log2(np.maximum(largest, LEAST_NORMAL_HALF))) - MANTISSA_BITS)
    step = np.where(largest < LEAST_NORMAL_HALF, LEAST_NORMAL_HALF, ulp)
    excess = np.abs(found.astype(float) - held) - bound - step
    assert np.all(excess <= 0), f"{excess.max(initial=0):.3g} beyond the bound"
