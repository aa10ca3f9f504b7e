"""Which cells of a square are taken, a bit for each, and where a shape may lie: at all places of the square at once.

A run of cells hits what is taken where any of its bits does. Bits are kept for runs of every power of two, and shifted
by every part of a byte, so that a run of a shape is tested everywhere by two ORs of whole byte arrays.
"""

import numpy as np

from mua.arrays import Array

BITS = 8  # of a byte


class Occupancy:
    """The cells of a square."""

    def __init__(self, side: int, longest: int) -> None:
        """`longest` is the length of the longest run that will be asked for."""
        self.stride = -(-side // BITS)  # bytes of a row
        self.side = side
        self.levels = max(longest, 1).bit_length()
        beyond = 2 * side * self.stride + BITS  # a shape at the last place reaches beyond the square
        self._hits = np.zeros((self.levels, BITS, beyond), np.uint8)

    def take(self, cells: Array, row: int, column: int) -> None:
        """Take these cells [h, w] bool, their first corner at a row and a column."""
        rows = np.zeros((len(cells), self.stride * BITS), bool)
        rows[:, column : column + cells.shape[1]] = cells
        packed = np.packbits(rows.ravel(), bitorder="little")
        first, last = row * self.stride, (row + len(cells)) * self.stride
        self._hits[0, 0, first:last] |= packed
        self._update(max(first - self.stride, 0), last)

    def _update(self, first: int, last: int) -> None:
        """Carry bytes of what is taken over to all runs and shifts."""
        for level in range(self.levels):
            if level:
                half = 1 << (level - 1)
                below = self._hits[level - 1]
                self._hits[level, 0, first:last] = (
                    below[0, first:last] | below[half % BITS, first + half // BITS :][: last - first]
                )
            plain = self._hits[level, 0, first : last + 1]
            for shift in range(1, BITS):
                self._hits[level, shift, first:last] = (plain[:-1] >> shift) | (plain[1:] << (BITS - shift))

    def blocked(
        self,
        runs: tuple[Array, Array, Array],
        rows: int,  # how many rows of places are asked for
    ) -> Array:
        """Where a shape of these runs hits what is taken, by the place of its first corner: bytes [rows, stride]."""
        count = rows * self.stride
        found = np.zeros(count, np.uint8)
        for row, start, length in zip(*(part.tolist() for part in runs), strict=True):
            level = length.bit_length() - 1
            rest = length - (1 << level)
            for at in (start, start + rest) if rest else (start,):
                skipped, shift = divmod(at, BITS)
                first = row * self.stride + skipped
                np.bitwise_or(found, self._hits[level, shift, first : first + count], out=found)
        return found.reshape(rows, self.stride)


def first_bits(stride: int, count: int) -> Array:
    """A row of bytes with its first `count` bits set."""
    return np.packbits(np.arange(stride * BITS) < count, bitorder="little")


def each_bit(bits: Array) -> Array:
    """Bytes [rows, stride] as bools [rows, stride * BITS]."""
    return np.unpackbits(bits, axis=1, bitorder="little").astype(bool)


def beside(
    free: Array,  # [rows, stride] bytes
) -> Array:
    """The free places that have a neighbour which is not free."""
    stride, cells = free.shape[1], free.ravel()
    left, right = cells << 1, cells >> 1
    left[1:] |= cells[:-1] >> (BITS - 1)
    right[:-1] |= cells[1:] << (BITS - 1)
    inner = cells & left & right
    inner[stride:] &= cells[:-stride]
    inner[:-stride] &= cells[stride:]
    inner[:stride] = inner[-stride:] = 0
    return (cells & ~inner).reshape(free.shape)


def places(
    bits: Array,  # [rows, stride] bytes
) -> tuple[Array, Array]:
    """Rows and columns [n] of the bits that are set, row by row."""
    at = np.flatnonzero(bits.ravel() != 0)
    which, bit = np.divmod(np.flatnonzero(np.unpackbits(bits.ravel()[at], bitorder="little")), BITS)
    rows, columns = np.divmod(at[which], bits.shape[1])
    return rows, columns * BITS + bit
