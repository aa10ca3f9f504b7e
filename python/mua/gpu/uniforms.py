"""The memory through which constants reach the device."""

from collections.abc import Sequence

import wgpu

from mua.errors import InputError

ALIGNMENT = 256  # bytes; no device asks for more between the constants of two dispatches
CAPACITY = 1 << 20  # bytes: several thousand dispatches may wait for one submit


class Uniforms:
    """A ring of constants: a value stays until CAPACITY more bytes are placed, long after its submit."""

    def __init__(self, device: wgpu.GPUDevice) -> None:
        usage = wgpu.BufferUsage.UNIFORM | wgpu.BufferUsage.COPY_DST
        self.raw = device.create_buffer(label="constants", size=CAPACITY, usage=usage)
        self._queue = device.queue
        self._next = 0

    def place(self, blocks: Sequence[bytes]) -> list[int]:
        """Upload constants in one write and return the offset of each, in bytes."""
        padded = [block.ljust(-(-len(block) // ALIGNMENT) * ALIGNMENT, b"\0") for block in blocks]
        total = sum(map(len, padded))
        if total > CAPACITY:
            raise InputError(f"constants: {total} bytes for one submit are more than {CAPACITY}; submit in parts")
        if self._next + total > CAPACITY:
            self._next = 0
        offsets = []
        start = self._next
        for block in padded:
            offsets.append(self._next)
            self._next += len(block)
        if total:
            self._queue.write_buffer(self.raw, start, b"".join(padded))
        return offsets
