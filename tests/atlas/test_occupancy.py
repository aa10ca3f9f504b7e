"""Taken cells: what is found with bits is what trying every place finds."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.atlas.chart_shapes import Shape, ways
from mua.atlas.occupancy import Occupancy, beside, each_bit, first_bits, places

SIDE = 37


def shape_of(mask: Array) -> Shape:
    return Shape(0.0, np.eye(2), np.zeros(2), mask, mask)


def hit_at(taken: Array, mask: Array, row: int, column: int) -> bool:
    under = taken[row : row + mask.shape[0], column : column + mask.shape[1]]
    return bool((under & mask).any())


@pytest.mark.parametrize("seed", range(4))
def test_a_shape_is_blocked_where_it_hits_what_is_taken(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mask = rng.random((rng.integers(1, 9), rng.integers(1, 19))) < 0.5
    taken, cells = Occupancy(SIDE, longest=20), np.zeros((SIDE, SIDE), bool)
    for _ in range(3):
        block = rng.random((5, 6)) < 0.3
        row, column = rng.integers(0, SIDE - 6, 2).tolist()
        taken.take(block, row, column)
        cells[row : row + 5, column : column + 6] |= block
    rows, columns = SIDE - mask.shape[0] + 1, SIDE - mask.shape[1] + 1
    found = each_bit(taken.blocked(shape_of(mask).runs, rows))[:, :columns]
    wanted = [[hit_at(cells, mask, row, column) for column in range(columns)] for row in range(rows)]
    np.testing.assert_array_equal(found, wanted)


def test_beside_keeps_free_places_next_to_blocked_ones() -> None:
    free = np.zeros((9, 24), bool)
    free[1:8, 3:20] = True
    bits = np.packbits(free, axis=1, bitorder="little")
    row, column = places(beside(bits))
    inner = np.zeros_like(free)
    inner[2:7, 4:19] = True
    np.testing.assert_array_equal(np.stack([row, column]), np.nonzero(free & ~inner))


def test_first_bits_are_the_columns_before_a_count() -> None:
    np.testing.assert_array_equal(np.flatnonzero(each_bit(first_bits(3, 13)[None])[0]), np.arange(13))


def test_a_shape_lies_eight_ways_and_a_square_one() -> None:
    crooked = np.array([[1, 0, 0], [1, 1, 1]], bool)
    assert len(ways(shape_of(crooked))) == 8
    assert len(ways(shape_of(np.ones((3, 3), bool)))) == 1
