"""PNG files of large pictures: libdeflate packs them four times as fast as the library that Pillow has."""

import struct
import zlib

import deflate
import numpy as np

from mua.arrays import Array

SIGNATURE = b"\x89PNG\r\n\x1a\n"
RGB, DEPTH = 2, 8  # the colour type, and bits of a channel
UP = 2  # the filter of a row: its bytes less those above
FAST = 1  # of libdeflate's levels: 2 % larger than by 4, in two thirds of the time


def png_bytes(
    picture: Array,  # [H, W, 3] uint8, sRGB
) -> bytes:
    """A PNG file (https://www.w3.org/TR/png)."""
    height, width, channels = picture.shape
    rows = np.empty((height, 1 + width * channels), np.uint8)
    rows[:, 0] = UP
    flat = picture.reshape(height, -1)
    rows[:1, 1:] = flat[:1]
    np.subtract(flat[1:], flat[:-1], out=rows[1:, 1:])
    header = struct.pack(">IIBBBBB", width, height, DEPTH, RGB, 0, 0, 0)
    packed = bytes(deflate.zlib_compress(rows, FAST))
    return SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", packed) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(content, zlib.crc32(kind)))
