"""Constants of every type reach the device; wrong ones are refused by name."""

from pathlib import Path

import numpy as np
import pytest
from dispatch import run

from mua.errors import InputError
from mua.gpu import Device, Kernel

SHADER = """
#pragma kernel Echo
RWStructuredBuffer<float> y;
RWStructuredBuffer<uint> z;
cbuffer Constants
{
    uint count; int shift; float scale; uint3 steps; float2 middle; float4 corner; float4x4 view[2]; float taps[3];
    int last;
};
void put(uint at, float4 row)
{
    y[at] = row.x; y[at + 1] = row.y; y[at + 2] = row.z; y[at + 3] = row.w;
}
[numthreads(1, 1, 1)] void Echo()
{
    z[0] = count; z[1] = asuint(shift); z[2] = steps.x; z[3] = steps.y; z[4] = steps.z; z[5] = asuint(last);
    y[0] = scale;
    y[1] = middle.x; y[2] = middle.y;
    put(3, corner);
    put(7, view[0][0]); put(11, view[0][1]); put(15, view[0][2]); put(19, view[0][3]);
    put(23, view[1][0]); put(27, view[1][1]); put(31, view[1][2]); put(35, view[1][3]);
    put(39, mul(view[0], corner)); put(43, mul(view[1], corner));
    y[47] = taps[0]; y[48] = taps[1]; y[49] = taps[2];
}
"""
VIEW = np.arange(32.0).reshape(2, 4, 4)
CORNER = np.array([1.0, -2, 3, 0.5])
VALUES = {
    "count": 2**32 - 1,
    "shift": -5,
    "scale": 0.25,
    "steps": np.array([3, 2**31, 7], np.uint32),
    "middle": (1.5, -2.5),
    "corner": CORNER,
    "view": VIEW,
    "taps": [1, 2, 3],
    "last": np.int64(-(2**31)),
}


@pytest.fixture
def shader(tmp_path: Path) -> Path:
    path = tmp_path / "echo.compute"
    path.write_text(SHADER)
    return path


@pytest.fixture
def kernel(device: Device, shader: Path) -> Kernel:
    return device.kernel(shader, "Echo")


def test_every_type_reaches_the_device(device: Device, shader: Path) -> None:
    buffers = {"y": np.zeros(50, np.float32), "z": np.zeros(6, np.uint32)}
    found = run(device, shader, "Echo", (1, 1, 1), buffers, **VALUES)
    words = [2**32 - 1, 2**32 - 5, 3, 2**31, 7, 2**31]
    np.testing.assert_array_equal(found["z"], words)
    small = [0.25, 1.5, -2.5, *CORNER, *VIEW.ravel(), *(VIEW @ CORNER).ravel(), 1, 2, 3]
    np.testing.assert_array_equal(found["y"], small)  # all are sums of few small multiples of 1/2: exact


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("count", -1, "count is -1, expected one uint"),
        ("count", 2**32, "count is 4294967296, expected one uint"),
        ("count", 1.0, "count is 1.0, expected one uint"),
        ("count", "1", "count is '1', expected one uint"),
        ("shift", 2**31, "shift is 2147483648, expected one int"),
        ("scale", 1e39, "scale is 1e[+]39, expected one float"),
        ("scale", [1.0, 2.0], r"scale is \[1.0, 2.0\], expected one float"),
        ("steps", [1, 2], r"steps is int64 \[2\], expected uint \[3\]"),
        ("steps", [1, 2, -1], r"steps is \[1, 2, -1\], expected uint \[3\]"),
        ("steps", [1.0, 2.0, 3.0], r"steps is float64 \[3\], expected uint \[3\]"),
        ("middle", 1.0, r"middle is float64 \[\], expected float \[2\]"),
        ("view", VIEW[:1], r"view is float64 \[1, 4, 4\], expected float \[2, 4, 4\]"),
    ],
)
def test_rejects_wrong_types_and_shapes(
    device: Device, kernel: Kernel, name: str, value: object, expected: str
) -> None:
    buffers = {"y": device.buffer(200, name="y"), "z": device.buffer(24, name="z")}
    with pytest.raises(InputError, match=f"kernel Echo: constant {expected}"):
        device.commands().dispatch(kernel, (1, 1, 1), buffers, **(VALUES | {name: value}))


def test_rejects_missing_and_unknown_names(device: Device, kernel: Kernel) -> None:
    buffers = {"y": device.buffer(200, name="y"), "z": device.buffer(24, name="z")}
    without = {name: value for name, value in VALUES.items() if name != "taps"}
    with pytest.raises(InputError, match="kernel Echo: constant taps is missing"):
        device.commands().dispatch(kernel, (1, 1, 1), buffers, **without)
    with pytest.raises(InputError, match="kernel Echo: has no constant tap; it has corner, count,"):
        device.commands().dispatch(kernel, (1, 1, 1), buffers, **VALUES, tap=1)


def test_each_dispatch_of_one_submit_has_its_own(device: Device, tmp_path: Path) -> None:
    path = tmp_path / "place.compute"
    path.write_text(
        "#pragma kernel Place\nRWStructuredBuffer<uint> y;\ncbuffer Constants { uint index; uint value; };\n"
        "[numthreads(1, 1, 1)] void Place() { y[index] = value; }\n"
    )
    kernel, y = device.kernel(path, "Place"), device.buffer(4 * 1009, name="y")
    for rounds in range(6):  # more constants than the ring holds at once, some of its end left over
        commands = device.commands()
        for index in range(1009):
            commands.dispatch(kernel, (1, 1, 1), {"y": y}, index=index, value=index + rounds)
        commands.submit()
        np.testing.assert_array_equal(y.read(), np.arange(1009) + rounds)
    for index in range(4096 - 1009 + 1):
        commands.dispatch(kernel, (1, 1, 1), {"y": y}, index=0, value=index)
    with pytest.raises(InputError, match="constants: 1048832 bytes for one submit are more than 1048576"):
        commands.submit()
