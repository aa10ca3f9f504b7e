"""The radix sort against numpy's stable argsort: the reference, and the shader on a device."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from sorted_keys import CORNERS, INSTANCES, UNWRITTEN, sort_keys

from mua.arrays import Array
from mua.gpu import Device, sources
from mua.kernels.splat_project import HIDDEN
from mua.kernels.splat_sort import splat_sort

COUNTS = [0, 1, 2, 255, 256, 257, 1021, 70001]
BLOCK_COUNTS = [2047, 2048, 2049, 4096, 30011]  # around and beyond the 2048 keys of one group
LARGE_COUNTS = [300_000, 600_000]  # 600,000 keys make more groups than ScanDigits has threads
LARGEST = [0, 1, 0xFF, 0x100, 0xFFFE]
SHARES = [0.0, 0.3, 0.999, 1.0]  # shares of hidden keys


def random_keys(count: int, largest: int = 0xFFFE) -> Array:
    return np.random.default_rng(count).integers(0, largest, count, dtype=np.uint16, endpoint=True)


def partly_hidden(count: int, share: float) -> Array:
    keys = random_keys(count)
    keys[np.random.default_rng(count).random(count) < share] = HIDDEN
    return keys


@pytest.mark.parametrize("share", SHARES)
def test_leaves_out_what_is_hidden(share: float) -> None:
    keys = partly_hidden(1021, share)
    order = np.argsort(keys, kind="stable")
    np.testing.assert_array_equal(splat_sort(keys), order[: np.count_nonzero(keys != HIDDEN)])


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
    """The order of the visible, equal keys in the order of arrival; nothing behind it; and the draw's arguments."""
    order, arguments = sort_keys(device, keys)
    visible = int(np.count_nonzero(keys != HIDDEN))
    np.testing.assert_array_equal(order[:visible], np.argsort(keys, kind="stable")[:visible])
    assert np.all(order[visible:] == UNWRITTEN)
    if len(keys):
        np.testing.assert_array_equal(arguments, [CORNERS * visible, INSTANCES, 0, 0, visible])


@pytest.mark.parametrize("count", [1, 2, 257, *BLOCK_COUNTS])
@pytest.mark.parametrize("share", SHARES)
def test_shader_leaves_out_what_is_hidden(device: Device, count: int, share: float) -> None:
    assert_sorts(device, partly_hidden(count, share))


def test_shader_leaves_out_whole_groups(device: Device) -> None:
    keys = random_keys(9 * 2048 + 5)
    keys[2048 : 5 * 2048] = HIDDEN
    assert_sorts(device, keys)


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
    [np.sort, lambda keys: np.sort(keys)[::-1], np.zeros_like, lambda keys: np.full_like(keys, 0xFFFE)],
    ids=["sorted", "reversed", "all zero", "all largest"],
)
def test_shader_sorts_what_has_an_order(device: Device, count: int, arrange: Callable[[Array], Array]) -> None:
    assert_sorts(device, np.ascontiguousarray(arrange(random_keys(count))))


def test_shader_gives_the_same_order_every_time(device: Device) -> None:
    keys = random_keys(30011, 0xFF)
    first = sort_keys(device, keys)[0]
    for _ in range(3):
        np.testing.assert_array_equal(sort_keys(device, keys)[0], first)


def test_shader_sorts_whichever_thread_of_a_group_is_ahead(
    device: Device, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Threads that run from the last to the first find what a missing barrier leaves unwritten."""
    shaders = shutil.copytree(sources.directory(), tmp_path / "shaders")
    kernel = shaders / "splat_sort.compute"
    text = kernel.read_text()
    for_each = re.compile(r"uint thread : SV_GroupIndex(.*)\)\n\{")
    turned, entries = for_each.subn(r"uint slot : SV_GroupIndex\1)\n{\n    uint thread = THREADS - 1 - slot;", text)
    assert entries == len(sources.kernels(text))
    kernel.write_text(turned)
    monkeypatch.setenv("MUA_SHADERS", str(shaders))
    assert_sorts(device, partly_hidden(9 * 2048 + 5, 0.3))
