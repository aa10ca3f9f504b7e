"""Where the subbands of the training frames come from: memory where they fit, the recording's files where not."""

from collections.abc import Callable

import torch
from torch import Tensor

from mua.student.model import Bands

HELD_BYTES = 2 << 30  # a branch's subbands up to this size are kept in memory, larger ones are read batch by batch

Source = Callable[[slice, Tensor], Bands]  # the subbands of channels and rows of the training frames


def hold(subbands: Source, channels: slice, *, frames: int, size: int) -> Source:
    """A source of `channels` alone, counted from 0, read once into memory where they fit in HELD_BYTES."""
    values = (size // 4) ** 2  # LL, D3 and D2 together have the samples of the low-pass quarter-size image
    if frames * values * (channels.stop - channels.start) * 4 > HELD_BYTES:
        return lambda part, rows: subbands(slice(channels.start + part.start, channels.start + part.stop), rows)
    held = Bands(*subbands(channels, torch.arange(frames)))
    return lambda part, rows: Bands(*(band[rows] for band in held.of(part)))
