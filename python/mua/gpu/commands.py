"""A list of dispatches that is submitted as one, like Unity's CommandBuffer."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import wgpu

from mua.errors import InputError
from mua.gpu.buffer import Buffer
from mua.gpu.constants import Uniforms
from mua.gpu.failure import naming
from mua.gpu.kernel import Kernel
from mua.gpu.timestamps import Timestamps


@dataclass(frozen=True)
class Bound:
    """A dispatch with what is needed to count its cost."""

    kernel: str
    sizes: Mapping[str, int]  # bytes of its buffers, by the kernel's names for them
    constants: Mapping[str, Any]


@dataclass(frozen=True)
class _Dispatch:
    bound: Bound
    kernel: Kernel
    group: wgpu.GPUBindGroup
    constants: bytes | None
    groups: tuple[int, int, int]


class Commands:
    """Dispatches in order; each sees what those before it wrote."""

    def __init__(self, device: wgpu.GPUDevice, uniforms: Uniforms, *, timed: bool) -> None:
        self._device, self._uniforms, self._timed = device, uniforms, timed
        self._dispatches: list[_Dispatch] = []
        self._timestamps: Timestamps | None = None

    def dispatch(
        self, kernel: Kernel, groups: tuple[int, int, int], buffers: Mapping[str, Buffer], **constants: Any
    ) -> None:
        """Append a dispatch of `groups`; it runs at `submit`, and not at all with 0 groups."""
        kernel.check_groups(groups)
        kernel.check(buffers, constants)
        packed = kernel.bindings.pack(constants)
        bound = Bound(kernel.name, {name: buffer.size for name, buffer in buffers.items()}, constants)
        self._dispatches.append(_Dispatch(bound, kernel, kernel.bindings.group(buffers), packed, groups))

    @property
    def bound(self) -> tuple[Bound, ...]:
        """The dispatches appended so far, in order."""
        return tuple(dispatch.bound for dispatch in self._dispatches)

    def submit(self) -> None:
        """Run all dispatches on the device, without waiting for them; may be called again to run them again."""
        dispatches = [d for d in self._dispatches if min(d.groups) > 0]
        placed = iter(self._uniforms.place([d.constants for d in dispatches if d.constants is not None]))
        offsets = [None if d.constants is None else next(placed) for d in dispatches]
        with naming("dispatches"):
            encoder = self._device.create_command_encoder()
            if self._timed:
                self._encode_timed(encoder, dispatches, offsets)
            else:
                self._encode(encoder, dispatches, offsets)
            self._device.queue.submit([encoder.finish()])

    def milliseconds(self) -> dict[str, float]:
        """Time that the device spent in each kernel in the last submit, summed by entry name; waits for it."""
        if not self._timed:
            raise InputError("dispatches: not timed; ask for commands(timed=True)")
        spent: dict[str, float] = defaultdict(float)
        if self._timestamps is None:
            return spent
        ran = [d for d in self._dispatches if min(d.groups) > 0]
        for dispatch, taken in zip(ran, np.diff(self._timestamps.milliseconds()).tolist(), strict=True):
            spent[dispatch.kernel.name] += max(taken, 0)
        return dict(spent)

    def _encode(self, encoder: wgpu.GPUCommandEncoder, dispatches: list[_Dispatch], offsets: list[int | None]) -> None:
        compute = encoder.begin_compute_pass()
        for dispatch, offset in zip(dispatches, offsets, strict=True):
            _record(compute, dispatch, offset)
        compute.end()

    def _encode_timed(
        self, encoder: wgpu.GPUCommandEncoder, dispatches: list[_Dispatch], offsets: list[int | None]
    ) -> None:
        """One pass for each dispatch: timestamps are taken only where passes begin and end."""
        self._timestamps = None
        if not dispatches:
            return
        self._timestamps = Timestamps(self._device, 1 + len(dispatches))
        encoder.begin_compute_pass(timestamp_writes=self._timestamps.of_pass(0)).end()
        for index, (dispatch, offset) in enumerate(zip(dispatches, offsets, strict=True), start=1):
            compute = encoder.begin_compute_pass(timestamp_writes=self._timestamps.of_pass(index))
            _record(compute, dispatch, offset)
            compute.end()
        self._timestamps.resolve(encoder)


def _record(compute: wgpu.GPUComputePassEncoder, dispatch: _Dispatch, offset: int | None) -> None:
    compute.set_pipeline(dispatch.kernel.pipeline)
    compute.set_bind_group(0, dispatch.group, [] if offset is None else [offset])
    compute.dispatch_workgroups(*dispatch.groups)
