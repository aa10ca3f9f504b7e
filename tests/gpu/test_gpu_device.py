"""The choice of a device, and the error when none fits."""

from types import SimpleNamespace

import numpy as np
import pytest
import wgpu

from mua.errors import InputError
from mua.gpu import Adapter, Device, adapters, open_device

LISTED = [
    ("Slow CPU", "Vulkan", "CPU"),
    ("Good 4090", "OpenGL", "DiscreteGPU"),
    ("Good 4090", "Vulkan", "DiscreteGPU"),
    ("Odd 7", "Vulkan", "IntegratedGPU"),
]


@pytest.fixture
def listed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine with the devices of LISTED, each with no storage buffers: they are found, but do not open."""
    keys = ("device", "backend_type", "adapter_type")
    limits = {"max-storage-buffers-per-shader-stage": 0}
    found = [SimpleNamespace(info=dict(zip(keys, row, strict=True)), limits=limits) for row in LISTED]
    monkeypatch.setattr(wgpu.gpu, "enumerate_adapters_sync", lambda: found)


@pytest.mark.usefixtures("listed")
def test_devices_are_listed_best_first() -> None:
    order = [("Good 4090", "Vulkan"), ("Odd 7", "Vulkan"), ("Slow CPU", "Vulkan"), ("Good 4090", "OpenGL")]
    assert [(adapter.name, adapter.backend) for adapter in adapters()] == order
    assert adapters()[1] == Adapter("Odd 7", "Vulkan", "IntegratedGPU")


@pytest.mark.usefixtures("listed")
@pytest.mark.parametrize(
    ("choice", "chosen"),
    [
        (None, "Good 4090 (Vulkan)"),
        ("1", "Odd 7 (Vulkan)"),
        ("slow", "Slow CPU (Vulkan)"),
        ("4090", "Good 4090 (Vulkan)"),
        ("opengl", "Good 4090 (OpenGL)"),
        ("7", "Odd 7 (Vulkan)"),
    ],
)
def test_devices_are_chosen_by_index_or_part_of_a_name(choice: str | None, chosen: str) -> None:
    with pytest.raises(InputError) as raised:
        open_device(choice)
    assert str(raised.value) == f"{chosen}: a shader may bind 0 buffers, expected at least 8"


@pytest.mark.usefixtures("listed")
def test_an_unknown_device_is_refused_with_the_present_ones() -> None:
    with pytest.raises(InputError, match=r"device nonesuch: .*; expected one of 0: Good 4090 \(Vulkan\), 1: Odd 7"):
        open_device("nonesuch")


def test_no_device_is_reported_with_a_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wgpu.gpu, "enumerate_adapters_sync", list)
    with pytest.raises(InputError, match=r"no graphics device: install a Vulkan driver .*mesa-vulkan-drivers"):
        open_device()


def test_a_lost_device_is_reported() -> None:
    device = open_device()
    buffer = device.buffer(np.arange(4, dtype=np.uint32), name="texels")
    device.close()
    for use in (buffer.read, lambda: device.buffer(4, name="texels"), lambda: buffer.write(np.zeros(1, np.uint32))):
        with pytest.raises(InputError, match=r"^buffer texels: the device was lost$"):
            use()


def test_an_absent_shader_is_named(device: Device) -> None:
    with pytest.raises(InputError, match=r"nonesuch\.compute: there is no such shader"):
        device.kernel("nonesuch.compute", "K")
