"""Buffers, dispatches and their order, checked against numpy."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import wgpu
from dispatch import run

from mua.errors import InputError
from mua.gpu import Buffer, Device

SHADER = """
#pragma kernel AddIndex
#pragma kernel Twice
StructuredBuffer<float> x;
RWStructuredBuffer<float> y;
RWStructuredBuffer<float4> quads;
cbuffer Constants { uint count; float scale; };
[numthreads(64, 1, 1)] void AddIndex(uint3 id : SV_DispatchThreadID)
{
    if (id.x < count) y[id.x] = x[id.x] * scale + id.x;
}
[numthreads(64, 1, 1)] void Twice(uint3 id : SV_DispatchThreadID)
{
    if (id.x < count) quads[id.x] *= 2;
}
"""
SIZES = [0, 1, 7, 64, 101, 4099]


@pytest.fixture(scope="session")
def shader(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shaders") / "small.compute"
    path.write_text(SHADER)
    return path


def groups(count: int) -> tuple[int, int, int]:
    return -(-count // 64), 1, 1


@pytest.mark.parametrize("count", SIZES)
def test_run_returns_what_the_kernel_wrote(device: Device, shader: Path, count: int) -> None:
    x = np.arange(count, dtype=np.float32) % 128
    given = {"x": x, "y": np.full((count, 1), -1, np.float32)}
    found = run(device, shader, "AddIndex", groups(count), given, count=count, scale=0.5)
    assert found.keys() == {"y"}
    assert found["y"].shape == (count, 1)
    np.testing.assert_array_equal(found["y"][:, 0], x / 2 + np.arange(count))
    assert np.all(given["y"] == -1)


@pytest.mark.parametrize("dtype", [np.uint8, np.int8, np.float16, np.uint32, np.int32, np.float32, np.bool_])
@pytest.mark.parametrize("count", [0, 1, 5, 7, 16, 101])
def test_buffers_keep_bytes(device: Device, count: int, dtype: Any) -> None:
    array = np.arange(count).astype(dtype)
    buffer = device.buffer(array, name="bytes")
    assert buffer.size == -(-array.nbytes // 4) * 4
    np.testing.assert_array_equal(buffer.read(np.uint8)[: array.nbytes], array.view(np.uint8))
    assert not buffer.read(np.uint8)[array.nbytes :].any()


def test_new_buffers_are_zero_and_writes_land_at_their_offset(device: Device) -> None:
    buffer = device.buffer(28, name="words")
    buffer.write(np.array([3, 4], np.uint32), offset=8)
    np.testing.assert_array_equal(buffer.read(), [0, 0, 3, 4, 0, 0, 0])
    buffer.write(np.zeros(0, np.uint32))


def test_buffers_refuse_what_does_not_fit(device: Device) -> None:
    buffer = device.buffer(8, name="pair")
    most = min(device.limits["max-buffer-size"], device.limits["max-storage-buffer-binding-size"])
    for refused, sentence in [
        (lambda: buffer.write(np.zeros(2, np.uint32), offset=4), "pair: 8 bytes at 4 do not fit its 8"),
        (lambda: buffer.write(np.zeros(1, np.uint32), offset=-4), "pair: 4 bytes at -4 do not fit"),
        (lambda: buffer.write(np.zeros(3, np.uint8)), "pair: 3 bytes at 0, expected whole words"),
        (lambda: device.buffer(12, name="odd").read(np.float64), "odd: 12 bytes are no whole number of float64"),
        (lambda: device.buffer(np.zeros(2), name="wide"), "wide: values are float64, expected .* at most 4 bytes"),
        (lambda: device.buffer(np.array(["a"]), name="text"), "text: values are <U1"),
        (lambda: device.buffer(-1, name="less"), "less: size is -1 bytes"),
        (lambda: device.buffer(most + 1, name="huge"), f"huge: {most + 16 - most % 16} bytes are more than the {most}"),
    ]:
        with pytest.raises(InputError, match=f"buffer {sentence}"):
            refused()


@pytest.mark.parametrize(
    "error",
    [
        wgpu.GPUOutOfMemoryError("vkAllocateMemory"),
        wgpu.GPUValidationError("In wgpuDeviceCreateBuffer, label = 'texels'\n  Not enough memory left."),
    ],
)
def test_out_of_memory_is_one_sentence(error: wgpu.GPUError) -> None:
    def refuse(**_: Any) -> None:
        raise error

    limits = {"max-buffer-size": 1 << 40, "max-storage-buffer-binding-size": 1 << 40}
    full = cast(wgpu.GPUDevice, SimpleNamespace(limits=limits, queue=None, create_buffer=refuse))
    with pytest.raises(InputError, match=r"^buffer texels: the device is out of memory$"):
        Buffer(full, 1 << 39, name="texels")


def test_rejects_wrong_buffers(device: Device, shader: Path) -> None:
    kernel, commands = device.kernel(shader, "AddIndex"), device.commands()
    x, y = device.buffer(16, name="x"), device.buffer(16, name="y")
    constants = {"count": 4, "scale": 1.0}
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"x": x}, "buffer y is missing"),
        ({"x": x, "y": y, "z": y}, "has no buffer z; it has x, y"),
        ({"x": x, "y": np.zeros(4, np.float32)}, "buffer y is a ndarray, expected a Buffer"),
        ({"x": x, "y": x}, "buffers x and y are both x, expected two where one is written"),
    ]
    for buffers, sentence in wrong:
        with pytest.raises(InputError, match=f"kernel AddIndex: {sentence}"):
            commands.dispatch(kernel, (1, 1, 1), buffers, **constants)
    quads = device.buffer(20, name="quads")
    with pytest.raises(InputError, match="buffer quads has 20 bytes, expected a multiple of its elements' 16"):
        commands.dispatch(device.kernel(shader, "Twice"), (1, 1, 1), {"quads": quads}, count=1)


def test_run_rejects_a_wrong_type_of_values(device: Device, shader: Path) -> None:
    for dtype in (np.int32, np.float16):
        buffers = {"x": np.zeros(4, dtype), "y": np.zeros(4, np.float32)}
        with pytest.raises(InputError, match=f"buffer x is {np.dtype(dtype)}, expected 4-byte float values"):
            run(device, shader, "AddIndex", (1, 1, 1), buffers, count=4, scale=1.0)


def test_group_counts_have_bounds(device: Device, shader: Path) -> None:
    kernel, quads = device.kernel(shader, "Twice"), {"quads": device.buffer(16, name="quads")}
    for wrong in [(65536, 1, 1), (1, -1, 1), (1, 1)]:
        with pytest.raises(InputError, match=r"kernel Twice: groups are .*, expected three from 0 to 65535"):
            device.commands().dispatch(kernel, cast(Any, wrong), quads, count=1)


def ones(device: Device) -> Buffer:
    return device.buffer(np.ones((5, 4), np.float32), name="quads")


def test_no_groups_do_nothing(device: Device, shader: Path) -> None:
    quads, commands = ones(device), device.commands()
    commands.dispatch(device.kernel(shader, "Twice"), (1, 0, 1), {"quads": quads}, count=5)
    commands.submit()
    device.commands().submit()
    np.testing.assert_array_equal(quads.read(np.float32), 1)


def test_each_dispatch_sees_what_those_before_it_wrote(device: Device, shader: Path) -> None:
    quads, commands = ones(device), device.commands()
    for _ in range(11):
        commands.dispatch(device.kernel(shader, "Twice"), (1, 1, 1), {"quads": quads}, count=3)
    commands.submit()
    np.testing.assert_array_equal(quads.read(np.float32).reshape(5, 4)[:, 0], [2**11, 2**11, 2**11, 1, 1])
    commands.submit()
    assert quads.read(np.float32)[0] == 2**22


def test_timed_dispatches_give_times_by_kernel(device: Device, shader: Path) -> None:
    if not device.timestamps:
        with pytest.raises(InputError, match="no timestamps"):
            device.commands(timed=True)
        return
    quads, commands = ones(device), device.commands(timed=True)
    buffers = {"x": device.buffer(404, name="x"), "y": device.buffer(404, name="y")}
    assert commands.milliseconds() == {}
    for _ in range(2):
        commands.dispatch(device.kernel(shader, "Twice"), (1, 1, 1), {"quads": quads}, count=3)
    commands.dispatch(device.kernel(shader, "Twice"), (0, 1, 1), {"quads": quads}, count=3)
    commands.dispatch(device.kernel(shader, "AddIndex"), (2, 1, 1), buffers, count=101, scale=1.0)
    commands.submit()
    times = commands.milliseconds()
    assert times.keys() == {"Twice", "AddIndex"}
    assert all(time >= 0 for time in times.values())
    assert quads.read(np.float32)[0] == 4
    with pytest.raises(InputError, match="not timed"):
        device.commands().milliseconds()


def test_more_dispatches_than_there_are_timestamps_are_refused(device: Device, shader: Path) -> None:
    if not device.timestamps:
        pytest.skip("needs a device with timestamps")
    kernel, quads, commands = device.kernel(shader, "Twice"), ones(device), device.commands(timed=True)
    for _ in range(4096):  # timestamps of a query set; one more is taken where the first dispatch begins
        commands.dispatch(kernel, (1, 1, 1), {"quads": quads}, count=0)
    with pytest.raises(InputError, match=r"timestamps: [0-9]* passes, expected 1 to"):
        commands.submit()


def test_an_edited_shader_is_picked_up(device: Device, shader: Path, tmp_path: Path) -> None:
    path = tmp_path / "edited.compute"
    path.write_text(SHADER)
    first = device.kernel(path, "Twice")
    assert device.kernel(path, "Twice") is first
    path.write_text(SHADER.replace("*= 2", "*= 3"))
    quads, commands = ones(device), device.commands()
    commands.dispatch(device.kernel(path, "Twice"), (1, 1, 1), {"quads": quads}, count=5)
    commands.submit()
    np.testing.assert_array_equal(quads.read(np.float32), 3)


def test_more_than_eight_buffers_are_refused(device: Device, tmp_path: Path) -> None:
    path = tmp_path / "many.compute"
    declared = "".join(f"RWStructuredBuffer<uint> b{i};\n" for i in range(9))
    body = " ".join(f"b{i}[0] = {i};" for i in range(9))
    path.write_text(f"#pragma kernel Many\n{declared}[numthreads(1, 1, 1)] void Many() {{ {body} }}\n")
    with pytest.raises(InputError, match="kernel Many: binds 9 buffers, expected at most 8"):
        device.kernel(path, "Many")
