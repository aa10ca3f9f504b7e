"""How many threads torch computes with, where several threads of this process call it."""

from collections.abc import Iterator
from contextlib import contextmanager

import torch

FEW = 4  # threads, where each needs much memory


@contextmanager
def thread_share(parts: int) -> Iterator[None]:
    """Let torch use 1 / `parts` of its threads within the block, in each thread that calls this."""
    threads = torch.get_num_threads()
    torch.set_num_threads(max(threads // parts, 1))
    try:
        yield
    finally:
        torch.set_num_threads(threads)


def few_threads() -> int:
    """How many threads work on items that each hold an image and its splats: some hundred megabytes."""
    return min(torch.get_num_threads(), FEW)
