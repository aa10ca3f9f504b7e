"""The devices of this machine, and the choice of one."""

import os
import sys
import tempfile
from dataclasses import dataclass

import wgpu

from mua.errors import InputError

BACKENDS = ("Vulkan", "Metal", "D3D12", "OpenGL")
KINDS = ("DiscreteGPU", "IntegratedGPU", "CPU", "Unknown")


@dataclass(frozen=True)
class Adapter:
    """A device that can be opened: its name, its programming interface, and whether it is a GPU or the CPU."""

    name: str
    backend: str
    kind: str

    def __str__(self) -> str:
        return f"{self.name} ({self.backend})"


def adapters() -> tuple[Adapter, ...]:
    """Every device that wgpu finds, the best first."""
    return tuple(adapter for adapter, _ in found())


def found() -> list[tuple[Adapter, wgpu.GPUAdapter]]:
    """Every device with wgpu's own handle of it: Vulkan before other interfaces, GPUs before the CPU."""
    if sys.platform == "linux" and "XDG_RUNTIME_DIR" not in os.environ:
        os.environ["XDG_RUNTIME_DIR"] = tempfile.gettempdir()  # or the search for OpenGL prints a complaint
    pairs = [(_described(raw), raw) for raw in wgpu.gpu.enumerate_adapters_sync()]
    return sorted(pairs, key=lambda pair: (_rank(BACKENDS, pair[0].backend), _rank(KINDS, pair[0].kind)))


def choose(choice: str | None) -> tuple[Adapter, wgpu.GPUAdapter]:
    """The device at an index of `adapters()` or with a part of a name; the best without a choice."""
    pairs = found()
    if not pairs:
        raise InputError(
            "no graphics device: install a Vulkan driver (on Debian, mesa-vulkan-drivers; it has one for the CPU too)"
        )
    if choice is None:
        return pairs[0]
    if choice.isdecimal() and int(choice) < len(pairs):
        return pairs[int(choice)]
    for pair in pairs:
        if choice.lower() in str(pair[0]).lower():
            return pair
    listed = ", ".join(f"{index}: {adapter}" for index, (adapter, _) in enumerate(pairs))
    raise InputError(f"device {choice}: no graphics device has this in its name; expected one of {listed}")


def _described(raw: wgpu.GPUAdapter) -> Adapter:
    return Adapter(raw.info["device"], raw.info["backend_type"], raw.info["adapter_type"])


def _rank(order: tuple[str, ...], name: str) -> int:
    return order.index(name) if name in order else len(order)
