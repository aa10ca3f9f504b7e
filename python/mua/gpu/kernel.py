"""A compute kernel, ready to be dispatched."""

from collections.abc import Mapping
from typing import Any

import wgpu

from mua.errors import InputError
from mua.gpu.bindings import Bindings, check_names
from mua.gpu.buffer import Buffer
from mua.gpu.constants import Uniforms
from mua.gpu.failure import naming
from mua.gpu.reflect import BufferSlot, Constant, reflect

MOST_GROUPS = 65535  # groups along one axis that every device allows


class Kernel:
    """An entry point of a compute shader with its names, types and sizes."""

    def __init__(self, device: wgpu.GPUDevice, uniforms: Uniforms, *, name: str, code: bytes) -> None:
        interface = reflect(code)
        self.name = name
        self.threads = interface.threads
        with naming(f"kernel {name}"):
            self.bindings = Bindings(
                device, uniforms, label=f"kernel {name}", interface=interface, stage=wgpu.ShaderStage.COMPUTE
            )
            layout = device.create_pipeline_layout(bind_group_layouts=[self.bindings.layout])
            module = device.create_shader_module(label=name, code=code)
            self.pipeline = device.create_compute_pipeline(
                label=name, layout=layout, compute={"module": module, "entry_point": name}
            )

    @property
    def buffers(self) -> tuple[BufferSlot, ...]:
        """Its buffers in order, each with whether it is read-only, its kind of scalar and the bytes of an element."""
        return self.bindings.buffers

    @property
    def constants(self) -> Mapping[str, Constant]:
        """The members of its constant buffer by name."""
        return self.bindings.constants

    def check(self, buffers: Mapping[str, Buffer], constants: Mapping[str, Any]) -> None:
        """Raise InputError that names the kernel and the buffer or constant if one is missing or unknown."""
        check_names(self.bindings.label, (self.bindings,), buffers, constants)

    def check_groups(self, groups: tuple[int, int, int]) -> None:
        if len(groups) != 3 or min(groups) < 0 or max(groups) > MOST_GROUPS:
            raise InputError(f"kernel {self.name}: groups are {groups}, expected three from 0 to {MOST_GROUPS}")
