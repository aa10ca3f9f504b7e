"""The source of the training frames' subbands: memory where they fit, else the recording's files."""

from collections.abc import Callable

import torch
from torch import Tensor

from mua.channels import LOWPASS_TEXELS
from mua.training.processes import ALONE, Processes
from mua.wavelets import Bands

HELD_BYTES = 1 << 30  # subbands up to this size are kept in memory, larger ones are read batch by batch
GPU_SHARE = 0.5  # share of a GPU's free memory for subbands; the rest is for the factorisation
READ_FRAMES = 64  # at once
CPU = torch.device("cpu")

Source = Callable[[slice, Tensor], Bands]  # copies of the subbands of channels and rows of the training frames


def hold(
    subbands: Source,
    channels: slice,
    *,
    frames: int,
    size: int,
    device: torch.device = CPU,
    processes: Processes = ALONE,
    together: int = 1,  # how many sources share the memory
) -> Source:
    """A source of `channels` alone, counted from 0, read once into the memory of `device` where they fit.

    Each of several processes holds its own frames and reads others. The values are the same wherever they come from.
    """
    own = processes.held(frames)
    values = (size // LOWPASS_TEXELS) ** 2  # LL, D3 and D2 together have the samples of the low-pass quarter-size image
    held: Bands | None = None
    if len(own) * values * (channels.stop - channels.start) * 4 <= room(device) // together:
        held = _read(subbands, channels, torch.tensor(own), device=device)

    def source(part: slice, rows: Tensor) -> Bands:
        if held is None or not all(row in own for row in rows.tolist()):
            return subbands(slice(channels.start + part.start, channels.start + part.stop), rows)
        places = ((rows - own.start) // own.step).to(device)
        return Bands(*(band[places] for band in held.of(part)))

    return source


def room(device: torch.device) -> int:
    """Bytes that a branch's subbands may take in the memory of `device`."""
    if device.type != "cuda":
        return HELD_BYTES
    free, _ = torch.cuda.mem_get_info(device)
    idle = torch.cuda.memory_reserved(device) - torch.cuda.memory_allocated(device)  # torch caches freed memory
    return int(GPU_SHARE * (free + idle))


def _read(subbands: Source, channels: slice, frames: Tensor, *, device: torch.device) -> Bands:
    """Frames of given numbers, some at a time, so that the processor's memory never has to hold what a GPU holds."""
    held: Bands | None = None
    for place, rows in enumerate(frames.split(READ_FRAMES)):
        part = subbands(channels, rows)
        if held is None:
            held = Bands(*(torch.empty((len(frames), *band.shape[1:]), device=device) for band in part))
        for band, own in zip(held, part, strict=True):
            band[place * READ_FRAMES : place * READ_FRAMES + len(rows)] = own.to(device)
    assert held is not None  # there is a training frame
    return held
