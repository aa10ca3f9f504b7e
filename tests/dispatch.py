"""One kernel, one dispatch, arrays in and arrays out."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.errors import InputError
from mua.gpu.device import Device

FENCE = 0x7FFF7FFF  # not a number, as a float and as two halves
FENCE_WORDS = 1024
KINDS = {"uint": "iufb", "int": "i", "float": "f"}  # of numpy values by a buffer's scalar; uint holds any bytes


def run(
    device: Device,
    file: str | Path,
    entry: str,
    groups: tuple[int, int, int],
    buffers: Mapping[str, Array],
    **constants: Any,
) -> dict[str, Array]:
    """Upload arrays, dispatch once, and return the buffers that the kernel may write, in their type and shape.

    Raises InputError where a name, type or size does not fit the kernel.
    """
    kernel = device.kernel(file, entry)
    for slot in kernel.buffers:
        given = buffers.get(slot.name)
        if given is None:
            continue
        whole = slot.scalar == "uint" or np.asarray(given).dtype.itemsize == 4
        if np.asarray(given).dtype.kind not in KINDS[slot.scalar] or not whole:
            raise InputError(
                f"kernel {entry}: buffer {slot.name} is {np.asarray(given).dtype}, expected 4-byte {slot.scalar} values"
            )
    uploaded = {name: device.buffer(_fenced(np.asarray(array)), name=name) for name, array in buffers.items()}
    commands = device.commands()
    commands.dispatch(kernel, groups, uploaded, **constants)
    commands.submit()
    found = {}
    for slot in kernel.buffers:
        if not slot.read_only:
            given = np.asarray(buffers[slot.name])
            read = uploaded[slot.name].read(np.uint8)
            assert (read[given.nbytes :].view(np.uint32) == FENCE).all(), f"{entry} writes beyond {slot.name}"
            found[slot.name] = read[: given.nbytes].view(given.dtype).reshape(given.shape)
    return found


def _fenced(array: Array) -> Array:
    """The words of an array and more behind them, which no kernel may use or change."""
    words = np.ascontiguousarray(array).reshape(-1).view(np.uint32)
    return np.concatenate([words, np.full(FENCE_WORDS, FENCE, np.uint32)])
