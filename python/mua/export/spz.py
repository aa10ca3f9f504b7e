"""Splats as .spz, Niantic's quantised layout in its version 3: about a tenth of a .ply.

A 16-byte header, then one array after another, all of it compressed by gzip: centres in 24-bit fixed point, opacities,
mean colours, logarithmic scales in 8 bits, rotations as the three smaller components of a quaternion, spherical
harmonics in 8 bits. Version 4 holds the same numbers, compressed by zstd.
"""

import gzip
import struct

import numpy as np

from mua.arrays import Array
from mua.export.splats import WorldSplats

MAGIC, VERSION = b"NGSP", 3
DEGREE = 1
ANTIALIASED = 1  # drawn by a filter over the pixel, as our renderer does
MOST_FRACTION = 20  # bits: a millionth of a metre
POSITION_BITS = 24
COLOR_SCALE = 0.15  # scale of the constant coefficient, so that colours somewhat outside of 0..1 fit
SCALE_OFFSET, SCALE_STEPS = 10.0, 16.0  # logarithms from -10 in sixteenths
COEFFICIENT_STEPS = 128.0  # -1 to 1


def spz_bytes(splats: WorldSplats) -> bytes:
    """The content of a .spz."""
    fraction = _fraction(splats.centres)
    header = struct.pack("<4sIIBBBB", MAGIC, VERSION, len(splats), DEGREE, fraction, ANTIALIASED, 0)
    arrays = (
        _fixed_point(splats.centres, fraction),
        _byte(splats.opacities * 255),
        _byte((splats.sh[:, :3] * COLOR_SCALE + 0.5) * 255),
        _byte((splats.log_scales + SCALE_OFFSET) * SCALE_STEPS),
        _rotation_words(splats.rotations),
        _byte((splats.sh[:, 3:] + 1) * COEFFICIENT_STEPS),
    )
    return gzip.compress(b"".join([header, *(array.tobytes() for array in arrays)]), mtime=0)


def _fraction(
    points: Array,  # [N, 3] metres
) -> int:
    """As many fractional bits as leave room for the farthest centre, rounded up."""
    farthest = float(np.abs(points).max(initial=0))
    whole = max(int(np.floor(np.log2(max(farthest, 0.5)))) + 1, 0)
    return min(MOST_FRACTION, POSITION_BITS - 2 - whole)


def _fixed_point(points: Array, fraction: int) -> Array:
    """The three low bytes [N, 3, 3] of signed whole numbers."""
    fixed = np.rint(points.astype(float) * (1 << fraction)).astype("<i4")
    return fixed[..., None].view(np.uint8)[..., :3]


def _rotation_words(
    rotations: Array,  # [N, 4] unit, wxyz
) -> Array:
    """Words [N] uint32: in two bits which of xyzw is largest, then sign and nine bits of each other one."""
    xyzw = np.roll(rotations, -1, axis=1)
    largest = np.abs(xyzw).argmax(axis=1)
    xyzw = np.where(np.take_along_axis(xyzw, largest[:, None], axis=1) < 0, -xyzw, xyzw)
    word = largest.astype(np.uint32)
    others = np.array([[k for k in range(4) if k != left_out] for left_out in range(4)])[largest]
    for component in np.take_along_axis(xyzw, others, axis=1).T:
        size = np.minimum(np.abs(component) * np.sqrt(2) * 511 + 0.5, 511).astype(np.uint32)
        word = word << np.uint32(10) | (component < 0).astype(np.uint32) << np.uint32(9) | size
    return word.astype("<u4")


def _byte(values: Array) -> Array:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)
