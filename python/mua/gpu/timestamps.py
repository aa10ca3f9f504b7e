"""When passes begin and end on the device."""

from typing import Any

import numpy as np
import wgpu
from wgpu.backends.wgpu_native import lib

from mua.arrays import Array
from mua.errors import InputError
from mua.gpu.failure import naming

MOST_PASSES = 2048  # a query set holds 4096 timestamps (WebGPU, section 20.1)


class Timestamps:
    """Two timestamps for each of so many passes of one command encoder."""

    def __init__(self, device: wgpu.GPUDevice, passes: int) -> None:
        """Errors: InputError where there are none or too many passes."""
        if not 1 <= passes <= MOST_PASSES:
            raise InputError(f"timestamps: {passes} passes, expected 1 to {MOST_PASSES}")
        self._device, self._passes = device, passes
        with naming("timestamps"):
            self._queries = device.create_query_set(type="timestamp", count=2 * passes)
            usage = wgpu.BufferUsage.QUERY_RESOLVE | wgpu.BufferUsage.COPY_SRC
            self._ticks = device.create_buffer(size=16 * passes, usage=usage)

    def of_pass(self, index: int) -> dict[str, Any]:
        """The `timestamp_writes` of a compute or render pass."""
        return {
            "query_set": self._queries,
            "beginning_of_pass_write_index": 2 * index,
            "end_of_pass_write_index": 2 * index + 1,
        }

    def resolve(self, encoder: wgpu.GPUCommandEncoder) -> None:
        """Append what makes the timestamps readable; after the last pass."""
        encoder.resolve_query_set(self._queries, 0, 2 * self._passes, self._ticks, 0)

    def milliseconds(self) -> Array:  # [passes, 2] float64 begin and end
        """Wait for the device; times count from an instant of its own."""
        with naming("timestamps"):
            ticks = np.frombuffer(self._device.queue.read_buffer(self._ticks), np.uint64).reshape(-1, 2)
        period = lib.wgpuQueueGetTimestampPeriod(self._device.queue._internal)  # nanoseconds of one tick
        return (ticks - ticks.min()) * (period * 1e-6)
