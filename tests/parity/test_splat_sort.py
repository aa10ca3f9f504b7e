"""The radix sort against numpy's stable argsort: the reference, and the shader on a device."""

from collections.abc import Callable

import numpy as np
import pytest
from sorted_keys import sort_keys

from mua.arrays import Array
from mua.gpu import Device
from mua.kernels.splat_sort import splat_sort

COUNTS = [0, 1, 2, 255, 256, 257, 1021, 70001]
BLOCK_COUNTS = [2047, 2048, 2049, 4096, 30011]  # around and beyond the 2048 keys of one group
LARGE_COUNTS = [300_000, 600_000]  # 600,000 keys make more groups than ScanDigits has threads
LARGEST = [0, 1, 0xFF, 0x100, 0xFFFF]


def random_keys(count: int, largest: int = 0xFFFF) -> Array:
    return np.random.default_rng(count).integers(0, largest, count, dtype=np.uint16, endpoint=True)


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("largest", LARGEST)
def test_equals_stable_argsort(count: int, largest: int) -> None:
    keys = random_keys(count, largest)
    order = splat_sort(keys)
    assert order.dtype == np.int32
    np.testing.assert_array_equal(order, np.argsort(keys, kind="stable"))


def test_sorted_and_reversed_keys() -> None:
    keys = np.arange(0, 0x10000, 7, dtype=np.uint16)
    np.testing.assert_array_equal(splat_sort(keys), np.arange(len(keys)))
    np.testing.assert_array_equal(splat_sort(keys[::-1]), np.arange(len(keys))[::-1])


def assert_sorts(device: Device, keys: Array) -> None:
    """Keys and the order that they came in, equal keys in the order of arrival."""
    sorted_keys, order = sort_keys(device, keys)
    expected = np.argsort(keys, kind="stable")
    np.testing.assert_array_equal(order, expected)
    np.testing.assert_array_equal(sorted_keys, keys[expected])


@pytest.mark.parametrize("count", COUNTS + BLOCK_COUNTS)
@pytest.mark.parametrize("largest", LARGEST)
def test_shader_equals_stable_argsort(device: Device, count: int, largest: int) -> None:
    assert_sorts(device, random_keys(count, largest))


@pytest.mark.parametrize("count", LARGE_COUNTS)
def test_shader_sorts_as_many_keys_as_a_frame_has(device: Device, count: int) -> None:
    assert_sorts(device, random_keys(count))


@pytest.mark.parametrize("count", [257, 2049, 300_007])
@pytest.mark.parametrize(
    "arrange",
    [np.sort, lambda keys: np.sort(keys)[::-1], np.zeros_like, lambda keys: np.full_like(keys, 0xFFFF)],
    ids=["sorted", "reversed", "all zero", "all largest"],
)
def test_shader_sorts_what_has_an_order(device: Device, count: int, arrange: Callable[[Array], Array]) -> None:
    assert_sorts(device, np.ascontiguousarray(arrange(random_keys(count))))


def test_shader_gives_the_same_order_every_time(device: Device) -> None:
    keys = random_keys(30011, 0xFF)
    first = sort_keys(device, keys)[1]
    for _ in range(3):
        np.testing.assert_array_equal(sort_keys(device, keys)[1], first)
