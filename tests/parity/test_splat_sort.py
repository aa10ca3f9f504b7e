"""The radix sort against numpy's stable argsort."""

import numpy as np
import pytest

from mua.kernels.splat_sort import splat_sort

COUNTS = [0, 1, 2, 255, 256, 257, 1021, 70001]


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("largest", [0, 1, 0xFF, 0x100, 0xFFFF])
def test_equals_stable_argsort(count: int, largest: int) -> None:
    keys = np.random.default_rng(count).integers(0, largest, count, dtype=np.uint16, endpoint=True)
    order = splat_sort(keys)
    assert order.dtype == np.int32
    np.testing.assert_array_equal(order, np.argsort(keys, kind="stable"))


def test_sorted_and_reversed_keys() -> None:
    keys = np.arange(0, 0x10000, 7, dtype=np.uint16)
    np.testing.assert_array_equal(splat_sort(keys), np.arange(len(keys)))
    np.testing.assert_array_equal(splat_sort(keys[::-1]), np.arange(len(keys))[::-1])
