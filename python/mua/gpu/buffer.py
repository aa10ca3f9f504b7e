"""A buffer on the device."""

from itertools import count
from typing import Any

import numpy as np
import numpy.typing as npt
import wgpu

from mua.arrays import Array
from mua.errors import InputError
from mua.gpu.failure import naming

WORD = 4  # bytes; the unit that shaders address
ALLOCATION = 16  # bytes: a whole float4, so that every element type of a shader fits even an empty buffer

_serials = count()


class Buffer:
    """Named memory on the device that shaders read and write as whole words."""

    def __init__(self, device: wgpu.GPUDevice, content: Array | int, *, name: str, indirect: bool = False) -> None:
        """Allocate and fill with an array's bytes, or with this number of zero bytes."""
        data = None if isinstance(content, int) else _bytes(content, name)
        bytes_given = content if isinstance(content, int) else len(data or b"")
        if bytes_given < 0:
            raise InputError(f"buffer {name}: size is {bytes_given} bytes, expected at least 0")
        self.name = name
        self.size = -(-bytes_given // WORD) * WORD  # bytes, without what is added to fill the allocation
        self.serial = next(_serials)
        allocated = max(-(-bytes_given // ALLOCATION) * ALLOCATION, ALLOCATION)
        most = min(device.limits["max-buffer-size"], device.limits["max-storage-buffer-binding-size"])
        if allocated > most:
            raise InputError(f"buffer {name}: {allocated} bytes are more than the {most} that the device can bind")
        usage = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC | wgpu.BufferUsage.COPY_DST
        if indirect:
            usage |= wgpu.BufferUsage.INDIRECT
        self._queue = device.queue
        with naming(f"buffer {name}"):
            self.raw = device.create_buffer(label=name, size=allocated, usage=usage)
            if data:
                self._queue.write_buffer(self.raw, 0, data.ljust(self.size, b"\0"))

    def read(self, dtype: npt.DTypeLike = np.uint32) -> Array:  # [size / itemsize]
        """Wait for the device and copy the buffer back as values of `dtype`."""
        kind = np.dtype(dtype)
        if self.size % kind.itemsize:
            raise InputError(f"buffer {self.name}: {self.size} bytes are no whole number of {kind} values")
        if not self.size:
            return np.zeros(0, kind)
        with naming(f"buffer {self.name}"):
            return np.frombuffer(self._queue.read_buffer(self.raw, 0, self.size), kind).copy()

    def write(self, array: Array, offset: int = 0) -> None:
        """Overwrite bytes from `offset` on; the dispatches submitted before still see the old content."""
        data = _bytes(array, self.name)
        if offset % WORD or len(data) % WORD:
            raise InputError(f"buffer {self.name}: {len(data)} bytes at {offset}, expected whole words of {WORD} bytes")
        if offset < 0 or offset + len(data) > self.size:
            raise InputError(f"buffer {self.name}: {len(data)} bytes at {offset} do not fit its {self.size}")
        if data:
            with naming(f"buffer {self.name}"):
                self._queue.write_buffer(self.raw, offset, data)


def _bytes(array: Any, name: str) -> bytes:
    values = np.asarray(array)
    if values.dtype.kind not in "iufb" or values.dtype.itemsize > WORD:
        raise InputError(f"buffer {name}: values are {values.dtype}, expected numbers of at most 4 bytes")
    return values.tobytes()
