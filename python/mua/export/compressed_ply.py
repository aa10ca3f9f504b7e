"""Splats as a compressed .ply, the quantised layout of PlayCanvas: 25 bytes a splat, which SuperSplat opens.

256 neighbours in space share a chunk, which holds the range of their centres, logarithmic scales and mean colours.
Each splat has four words: centre and scale in 11, 10 and 11 bits of that range; the three smaller components of its
quaternion in 10 bits each, after the number of the largest; colour and opacity in 8 bits each. A byte for each linear
coefficient covers -4 to 4.
"""

import numpy as np

from mua.arrays import Array
from mua.export.ply import by_channel, written
from mua.export.splats import WorldSplats, morton_order

CHUNK = 256
LEAST_RANGE = 1e-5  # smallest range of a chunk; readers treat smaller ones as zero
LARGEST_LOG = 20.0  # limit of a logarithmic scale in either direction
COEFFICIENTS = 8.0  # the width of the range that a byte of a linear coefficient covers
AXES, COLORS = ("x", "y", "z"), ("r", "g", "b")
RANGES = tuple(
    f"{end}_{name}"
    for names in (AXES, tuple(f"scale_{axis}" for axis in AXES), COLORS)
    for end in ("min", "max")
    for name in names
)
WORDS = ("packed_position", "packed_rotation", "packed_scale", "packed_color")


def compressed_ply_bytes(splats: WorldSplats) -> bytes:
    """The content of a .compressed.ply; the splats are in another order."""
    order = morton_order(splats.centres)
    scales = np.clip(splats.log_scales[order], -LARGEST_LOG, LARGEST_LOG)
    position, position_ranges = _in_chunks(splats.centres[order])
    scale, scale_ranges = _in_chunks(scales)
    color, color_ranges = _in_chunks(splats.mean_colors[order])
    words = [
        _bits(position, (11, 10, 11)),
        _rotation_words(splats.rotations[order]),
        _bits(scale, (11, 10, 11)),
        _bits(np.column_stack([color, splats.opacities[order]]), (8, 8, 8, 8)),
    ]
    ranges = np.concatenate([position_ranges, scale_ranges, color_ranges], axis=1)
    rest = np.clip((by_channel(splats.sh[order]) / COEFFICIENTS + 0.5) * 256, 0, 255).astype(np.uint8)
    return written(
        ("chunk", RANGES, ranges.astype("<f4")),
        ("vertex", WORDS, np.stack(words, axis=1).astype("<u4")),
        ("sh", tuple(f"f_rest_{k}" for k in range(9)), rest),
    )


def _in_chunks(
    values: Array,  # [N, 3]
) -> tuple[Array, Array]:
    """The values as shares [N, 3] of their chunk's range, and the ranges [K, 6]: all minima, then all maxima."""
    starts = np.arange(0, len(values), CHUNK)
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    owner = np.arange(len(values)) // CHUNK
    width = (high - low)[owner]
    shares = np.divide(values - low[owner], width, out=np.zeros_like(values), where=width >= LEAST_RANGE)
    return shares, np.concatenate([low, high], axis=1)


def _bits(
    shares: Array,  # [N, k] in 0..1
    widths: tuple[int, ...],  # bits of each, the highest first
) -> Array:
    """One word [N] uint32 of several numbers."""
    word = np.zeros(len(shares), np.uint32)
    for share, width in zip(shares.T, widths, strict=True):
        most = (1 << width) - 1
        word = word << np.uint32(width) | (np.clip(share, 0, 1) * most + 0.5).astype(np.uint32)
    return word


def _rotation_words(
    rotations: Array,  # [N, 4] unit, wxyz
) -> Array:
    """Words [N] of quaternions, w counted as component 0."""
    largest = np.abs(rotations).argmax(axis=1)
    others = np.array([[k for k in range(4) if k != left_out] for left_out in range(4)])[largest]
    sign = np.where(np.take_along_axis(rotations, largest[:, None], axis=1) < 0, -1, 1)
    smaller = np.take_along_axis(rotations, others, axis=1) * sign
    return largest.astype(np.uint32) << np.uint32(30) | _bits(smaller * np.sqrt(0.5) + 0.5, (10, 10, 10))
