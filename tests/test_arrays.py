"""Equal rows of an array, beside numpy's own."""

import numpy as np
import pytest

from mua.arrays import Array, unique_rows

RNG = np.random.default_rng(0)


@pytest.mark.parametrize(
    "rows",
    [
        RNG.integers(-3, 3, (200, 3)),
        RNG.integers(0, 2, (9, 1)).astype(np.int32),
        RNG.integers(0, 5, (50, 2)) / 4,
        np.zeros((7, 2), int),
        np.zeros((1, 4)),
        np.zeros((0, 2), int),
    ],
    ids=["three columns", "one column", "floats", "all equal", "one row", "none"],
)
def test_equal_rows_are_numbered_as_numpy_numbers_them(rows: Array) -> None:
    expected, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    found = unique_rows(rows)
    np.testing.assert_array_equal(found[0], expected)
    np.testing.assert_array_equal(found[1], first)
    np.testing.assert_array_equal(found[2], inverse.reshape(-1))
    assert found[0].dtype == rows.dtype
