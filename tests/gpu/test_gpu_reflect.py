"""Interfaces read off compiled code, against HLSL's own rules."""

from pathlib import Path

import numpy as np
import pytest

from mua.errors import InputError
from mua.gpu.compile import spirv
from mua.gpu.reflect import reflect

SHADER = """
#pragma kernel Mix
#pragma kernel Count
StructuredBuffer<uint> words;
StructuredBuffer<float4> points;
RWStructuredBuffer<float2> pairs;
RWStructuredBuffer<int> totals;
cbuffer Constants { uint count; int shift; float scale; uint3 steps; float2 middle; float4x4 view[2]; float row; };
[numthreads(8, 4, 2)] void Mix(uint3 id : SV_DispatchThreadID)
{
    if (id.x < count) pairs[id.x] = mul(view[1], points[words[id.x]]).xy * scale;
}
[numthreads(64, 1, 1)] void Count(uint3 id : SV_DispatchThreadID) { totals[id.x] += shift; }
"""


@pytest.fixture
def shader(tmp_path: Path) -> Path:
    path = tmp_path / "mix.compute"
    path.write_text(SHADER)
    return path


def test_buffers_by_name_with_access_scalar_and_element_size(shader: Path) -> None:
    found = {slot.name: slot for slot in reflect(spirv(shader, "Mix")).buffers}
    described = {name: (slot.read_only, slot.scalar, slot.stride) for name, slot in found.items()}
    expected = {"words": (True, "uint", 4), "points": (True, "float", 16), "pairs": (False, "float", 8)}
    assert described == expected
    assert len({slot.binding for slot in found.values()}) == 3
    (totals,) = reflect(spirv(shader, "Count")).buffers
    assert (totals.name, totals.read_only, totals.scalar) == ("totals", False, "int")


def test_constants_have_types_shapes_and_places(shader: Path) -> None:
    found = reflect(spirv(shader, "Mix")).constants
    described = {constant.name: (constant.offset, constant.scalar, constant.shape) for constant in found}
    assert described == {
        "count": (0, "uint", ()),
        "shift": (4, "int", ()),
        "scale": (8, "float", ()),
        "steps": (16, "uint", (3,)),
        "middle": (32, "float", (2,)),
        "view": (48, "float", (2, 4, 4)),
        "row": (176, "float", ()),
    }
    view = next(constant for constant in found if constant.name == "view")
    assert view.strides == (64, 4, 16)  # rows of HLSL's column_major memory lie one value apart


def test_constants_know_which_entry_reads_them(shader: Path) -> None:
    used = {entry: {c.name for c in reflect(spirv(shader, entry)).constants if c.used} for entry in ("Mix", "Count")}
    assert used == {"Mix": {"count", "scale", "view"}, "Count": {"shift"}}


def test_rejects_what_is_no_spirv() -> None:
    for code in (b"", b"abc", bytes(20), b"\x03\x02\x23\x07"):
        with pytest.raises(InputError, match="not SPIR-V"):
            reflect(code)


def test_rejects_an_instruction_longer_than_the_code(shader: Path) -> None:
    words = np.frombuffer(spirv(shader, "Mix"), "<u4")
    with pytest.raises(InputError, match="cut off at word 5"):
        reflect(words[:6].tobytes())
    with pytest.raises(InputError, match="cut off at word 5"):
        reflect(np.append(words[:5], np.uint32(0)).tobytes())
