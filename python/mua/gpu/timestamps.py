"""How long passes take on the device."""

from typing import Any

import numpy as np
import wgpu
from wgpu.backends.wgpu_native import lib

from mua.arrays import Array
from mua.errors import InputError
from mua.gpu.failure import naming

MOST_PASSES = 4096  # timestamps of a query set (WebGPU, section 20.1)


class Timestamps:
    """When each pass of one command encoder ends; how long it took is the time since the end of the pass before.

    Beginnings are not recorded: a device that puts timestamps off to the next barrier (Mesa's lavapipe) notes a
    beginning only with its end. An empty pass gives the first one its beginning.
    """

    def __init__(self, device: wgpu.GPUDevice, passes: int) -> None:
        """Errors: InputError where there are no passes or too many."""
        if not 1 <= passes <= MOST_PASSES:
            raise InputError(f"timestamps: {passes} passes, expected 1 to {MOST_PASSES}")
        self._device, self._passes = device, passes
        with naming("timestamps"):
            self._queries = device.create_query_set(type="timestamp", count=passes)
            usage = wgpu.BufferUsage.QUERY_RESOLVE | wgpu.BufferUsage.COPY_SRC
            self._ticks = device.create_buffer(size=8 * passes, usage=usage)

    def of_pass(self, index: int) -> dict[str, Any]:
        """The `timestamp_writes` of a compute or render pass."""
        return {"query_set": self._queries, "end_of_pass_write_index": index}

    def resolve(self, encoder: wgpu.GPUCommandEncoder) -> None:
        """Append the copy that makes the timestamps readable, after the last pass."""
        encoder.resolve_query_set(self._queries, 0, self._passes, self._ticks, 0)

    def milliseconds(self) -> Array:  # [passes] float64
        """Wait for the device; times count from the end of the first pass."""
        with naming("timestamps"):
            ticks = np.frombuffer(self._device.queue.read_buffer(self._ticks), np.int64)
        period = lib.wgpuQueueGetTimestampPeriod(self._device.queue._internal)  # nanoseconds of one tick
        return (ticks - ticks[0]) * (period * 1e-6)
