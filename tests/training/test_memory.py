"""Freed memory goes back to the system."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mua.training.memory import LARGE, release_memory

BLOCKS, BYTES = 400, 100_000  # below what the C library gives back by itself


def used() -> int:
    """Bytes of this process that are no files."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("RssAnon"))
    return int(line.split()[1]) * 1024


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs Linux, whose /proc says what a process uses")
def test_freed_blocks_below_one_in_use_are_given_back() -> None:
    blocks = [np.ones(BYTES, np.uint8) for _ in range(BLOCKS)]
    last = np.ones(BYTES, np.uint8)  # above them in memory: the C library alone gives back no more than the top
    before = used()
    blocks.clear()
    release_memory()
    assert before - used() > BLOCKS * BYTES / 2
    assert last.all()


ABOVE_SMALL_ONES = """
import numpy as np
from test_memory import used
from mua.training.memory import LARGE, return_large_blocks
{}
for _ in range(4):  # glibc keeps blocks of a size that was freed before
    np.ones(LARGE + 1, np.uint8)
start, kept = used(), []
for _ in range(10):
    large = np.ones(LARGE + 1, np.uint8)
    kept.append(bytes(LARGE // 100))
    del large
print(used() - start)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs Linux, whose /proc says what a process uses")
def test_small_blocks_in_use_do_not_take_the_place_of_large_ones() -> None:
    """In processes of their own, because the setting is one of the process."""
    left = {}
    for setting in ("", "return_large_blocks()"):
        program = [sys.executable, "-c", ABOVE_SMALL_ONES.format(setting)]
        left[setting] = int(subprocess.check_output(program, cwd=Path(__file__).parent))
    assert left["return_large_blocks()"] < LARGE
    assert left[""] > 0  # the program measures something
