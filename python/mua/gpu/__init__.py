"""Runs the shaders of ComputeShaders/ outside Unity, on whichever device wgpu finds."""

from mua.gpu.adapters import Adapter, adapters
from mua.gpu.buffer import Buffer
from mua.gpu.commands import Bound, Commands
from mua.gpu.device import Device, open_device
from mua.gpu.kernel import Kernel

__all__ = ["Adapter", "Bound", "Buffer", "Commands", "Device", "Kernel", "adapters", "open_device"]
