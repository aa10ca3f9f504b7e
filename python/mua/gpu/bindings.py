"""Binds buffers and constants by name to one compiled entry point."""

from collections.abc import Iterable, Mapping
from typing import Any
from weakref import WeakKeyDictionary

import wgpu

from mua.errors import InputError
from mua.gpu import constants
from mua.gpu.buffer import Buffer
from mua.gpu.constants import Uniforms
from mua.gpu.failure import naming
from mua.gpu.reflect import BufferSlot, Interface

MOST_BUFFERS = 8  # buffers that one stage may bind on every device that Unity runs on


class Bindings:
    """The layout of one entry point, and the bind groups made for it so far."""

    def __init__(
        self, device: wgpu.GPUDevice, uniforms: Uniforms, *, label: str, interface: Interface, stage: int
    ) -> None:
        if len(interface.buffers) > MOST_BUFFERS:
            raise InputError(f"{label}: binds {len(interface.buffers)} buffers, expected at most {MOST_BUFFERS}")
        self.label = label
        self.buffers = interface.buffers
        self.constants = {constant.name: constant for constant in interface.constants}
        self.needed = {constant.name for constant in interface.constants if constant.used}
        self._size = constants.block_size(interface.constants) if interface.constants else 0
        self._binding = interface.constants_binding
        self._device, self._uniforms = device, uniforms
        self.layout = device.create_bind_group_layout(entries=self._layout(stage))
        # by the first buffer, so that groups go when it goes; then by the serial numbers of all
        self._groups: WeakKeyDictionary[Buffer, dict[tuple[int, ...], wgpu.GPUBindGroup]] = WeakKeyDictionary()

    def pack(self, values: Mapping[str, Any]) -> bytes | None:
        """The bytes of the constant buffer; None if the code has none."""
        return None if self._binding is None else constants.pack(self.label, self.constants, self._size, values)

    def group(self, buffers: Mapping[str, Buffer]) -> wgpu.GPUBindGroup:
        """The bind group of these buffers, made once for the same ones."""
        bound = [buffers[slot.name] for slot in self.buffers]
        if not bound:
            return self._made(bound)
        groups = self._groups.setdefault(bound[0], {})
        key = tuple([buffer.serial for buffer in bound])
        if key not in groups:
            groups[key] = self._made(bound)
        return groups[key]

    def _layout(self, stage: int) -> list[dict[str, Any]]:
        entries: list[dict[str, Any]] = []
        for slot in self.buffers:
            kind = "read-only-storage" if slot.read_only else "storage"
            entries.append({"binding": slot.binding, "visibility": stage, "buffer": {"type": kind}})
        if self._binding is not None:
            uniform = {"type": "uniform", "has_dynamic_offset": True, "min_binding_size": self._size}
            entries.append({"binding": self._binding, "visibility": stage, "buffer": uniform})
        return entries

    def _made(self, bound: list[Buffer]) -> wgpu.GPUBindGroup:
        self._check_aliases(bound)
        entries = []
        for slot, buffer in zip(self.buffers, bound, strict=True):
            if buffer.size % slot.stride:
                raise InputError(
                    f"{self.label}: buffer {slot.name} has {buffer.size} bytes, "
                    f"expected a multiple of its elements' {slot.stride}"
                )
            entries.append({"binding": slot.binding, "resource": {"buffer": buffer.raw}})
        if self._binding is not None:
            constant_memory = {"buffer": self._uniforms.raw, "offset": 0, "size": self._size}
            entries.append({"binding": self._binding, "resource": constant_memory})
        with naming(self.label):
            return self._device.create_bind_group(layout=self.layout, entries=entries)

    def _check_aliases(self, bound: list[Buffer]) -> None:
        """Refuse a buffer that is written and also bound under another name: the result would depend on the device."""
        for index, (slot, buffer) in enumerate(zip(self.buffers, bound, strict=True)):
            for other, same in zip(self.buffers[:index], bound[:index], strict=True):
                if same is buffer and not (slot.read_only and other.read_only):
                    raise InputError(
                        f"{self.label}: buffers {other.name} and {slot.name} are both {buffer.name}, "
                        "expected two where one is written"
                    )


def check_names(
    label: str, bindings: Iterable[Bindings], buffers: Mapping[str, Buffer], values: Mapping[str, Any]
) -> None:
    """Raise InputError for a missing name that some stage reads, or a given name that no stage has."""
    slots: dict[str, BufferSlot] = {}
    declared: set[str] = set()
    needed: set[str] = set()
    for stage in bindings:
        slots |= {slot.name: slot for slot in stage.buffers}
        declared |= stage.constants.keys()
        needed |= stage.needed
    _compare(label, "buffer", set(slots), set(slots), set(buffers))
    _compare(label, "constant", needed, declared, set(values))
    for name, buffer in buffers.items():
        if not isinstance(buffer, Buffer):
            raise InputError(f"{label}: buffer {name} is a {type(buffer).__name__}, expected a Buffer of the device")


def _compare(label: str, kind: str, needed: set[str], declared: set[str], given: set[str]) -> None:
    for name in sorted(needed - given):
        raise InputError(f"{label}: {kind} {name} is missing")
    for name in sorted(given - declared):
        raise InputError(f"{label}: has no {kind} {name}; it has {', '.join(sorted(declared)) or 'none'}")
