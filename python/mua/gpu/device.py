"""An open device: makes buffers, kernels, pipelines and lists of dispatches."""

from pathlib import Path

import wgpu

from mua.arrays import Array
from mua.errors import InputError
from mua.gpu import compile, sources
from mua.gpu.adapters import Adapter, choose
from mua.gpu.bindings import MOST_BUFFERS
from mua.gpu.buffer import Buffer
from mua.gpu.commands import Commands
from mua.gpu.constants import Uniforms
from mua.gpu.draw import Pipeline
from mua.gpu.failure import naming
from mua.gpu.kernel import Kernel

# Limits requested beyond WebGPU's defaults: as much as the device has.
RAISED_LIMITS = ("max-buffer-size", "max-storage-buffer-binding-size", "max-texture-dimension-2d")
FEATURES = ("timestamp-query", "float32-blendable")  # asked for where present


class Device:
    """A device and the kernels and pipelines compiled for it so far."""

    def __init__(self, adapter: Adapter, device: wgpu.GPUDevice) -> None:
        self.adapter = adapter
        self.wgpu = device
        self.limits: dict[str, int] = dict(device.limits)
        self.timestamps = "timestamp-query" in device.features
        self._uniforms = Uniforms(device)
        self._kernels: dict[tuple[Path, str], tuple[bytes, Kernel]] = {}

    def buffer(self, content: Array | int, *, name: str, indirect: bool = False) -> Buffer:
        """A buffer with an array's bytes (any type of at most 4 bytes), or with this number of zero bytes.

        `indirect` lets the device read arguments of draws from it. InputError if it is too large.
        """
        return Buffer(self.wgpu, content, name=name, indirect=indirect)

    def kernel(self, file: str | Path, entry: str) -> Kernel:
        """An entry point of a shader in the shaders' directory, or at an absolute path; compiled once."""
        path = sources.find(file)
        code = compile.spirv(path, entry)
        known = self._kernels.get((path, entry))
        if known is None or known[0] != code:  # the file may have been edited since
            known = code, self.kernel_of(entry, code)
            self._kernels[path, entry] = known
        return known[1]

    def kernel_of(self, entry: str, code: bytes) -> Kernel:
        """An entry point of SPIR-V."""
        return Kernel(self.wgpu, self._uniforms, name=entry, code=code)

    def commands(self, *, timed: bool = False) -> Commands:
        """An empty list of dispatches; with `timed`, the device notes when each begins and ends."""
        if timed and not self.timestamps:
            raise InputError(f"{self.adapter}: the device has no timestamps")
        return Commands(self.wgpu, self._uniforms, timed=timed)

    def pipeline(
        self,
        file: str | Path,
        vertex: str,
        fragment: str,
        *,
        color_format: str,
        depth_format: str | None,
        blend: bool,
        depth_write: bool = False,
        depth_compare: str = "always",
        topology: str = "triangle-list",
        cull: str = "none",
    ) -> Pipeline:
        """A pair of entry points that draw; `blend` lays premultiplied colour over what is there."""
        path = sources.find(file)
        state = None
        if depth_format is not None:
            state = {"format": depth_format, "depth_write_enabled": depth_write, "depth_compare": depth_compare}
        return Pipeline(
            self.wgpu,
            self._uniforms,
            vertex=(vertex, compile.spirv(path, vertex, stage="vert")),
            fragment=(fragment, compile.spirv(path, fragment, stage="frag")),
            color_format=color_format,
            depth_stencil=state,
            blend=blend,
            primitive={"topology": topology, "cull_mode": cull},
        )

    def close(self) -> None:
        """Give the device's memory back; its buffers and kernels can no longer be used."""
        self.wgpu.destroy()


def open_device(choice: str | None = None) -> Device:
    """Open a device by a part of its name or its index in `adapters()`; without a choice, the best Vulkan device.

    Raises InputError if there is none, or none like this, or if it lacks what the shaders need.
    """
    adapter, raw = choose(choice)
    buffers = raw.limits["max-storage-buffers-per-shader-stage"]
    if buffers < MOST_BUFFERS:
        raise InputError(f"{adapter}: a shader may bind {buffers} buffers, expected at least {MOST_BUFFERS}")
    with naming(str(adapter)):
        device = raw.request_device_sync(
            required_features=[feature for feature in FEATURES if feature in raw.features],
            required_limits={limit: raw.limits[limit] for limit in RAISED_LIMITS},
        )
        return Device(adapter, device)
