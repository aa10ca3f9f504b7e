"""How many threads torch computes with, where several threads of this process call it."""

from collections.abc import Iterator
from contextlib import contextmanager

import torch


@contextmanager
def thread_share(parts: int) -> Iterator[None]:
    """Let torch compute with one of so many parts of its threads within the block, in each thread that asks it to."""
    threads = torch.get_num_threads()
    torch.set_num_threads(max(threads // parts, 1))
    try:
        yield
    finally:
        torch.set_num_threads(threads)
