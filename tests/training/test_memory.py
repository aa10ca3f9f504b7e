"""Freed memory goes back to the system."""

import sys
from pathlib import Path

import numpy as np
import pytest

from mua.training.memory import release_memory

BLOCKS, BYTES = 400, 100_000  # below what the C library gives back by itself


def used() -> int:
    """Bytes of this process that are no files."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("RssAnon"))
    return int(line.split()[1]) * 1024


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs Linux, which says what a process uses")
def test_freed_blocks_below_one_in_use_are_given_back() -> None:
    blocks = [np.ones(BYTES, np.uint8) for _ in range(BLOCKS)]
    last = np.ones(BYTES, np.uint8)  # above them in memory: the C library alone gives back no more than the top
    before = used()
    blocks.clear()
    release_memory()
    assert before - used() > BLOCKS * BYTES / 2
    assert last.all()
