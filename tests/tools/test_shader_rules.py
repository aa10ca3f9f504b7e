"""The shaders keep the rules, every broken rule is reported, and their parsed text agrees with the compilers."""

from pathlib import Path

import check_shaders
import gen_kernel_table
import pytest
import shader_rules
import shader_source

from mua.gpu import compile
from mua.gpu.reflect import reflect

GOOD = """
#pragma kernel Scale

StructuredBuffer<float> source;
RWStructuredBuffer<float> scaled;

cbuffer Constants
{
    uint count;
};

groupshared float shared_values[64];

float twice(float value)
{
    return 2 * value;
}

[numthreads(64, 1, 1)]
void Scale(uint thread : SV_GroupIndex, uint3 id : SV_DispatchThreadID)
{
    shared_values[thread] = id.x < count ? source[id.x] : 0;
    GroupMemoryBarrierWithGroupSync();
    if (id.x < count)
        scaled[id.x] = twice(shared_values[63 - thread]);
}
"""
BAD = [  # original, replacement, and text of the fault
    ("2 * value", "WaveActiveSum(value)", "WaveActiveSum is a wave or quad intrinsic"),
    ("2 * value", "QuadReadAcrossX(value)", "QuadReadAcrossX is a wave or quad intrinsic"),
    ("float twice", "template<typename T> float twice", "template is a template"),
    ("return 2 * value", "half h = value; return h", "half is a 16-bit type"),
    ("return 2 * value", "min16float h = value; return h", "min16float is a 16-bit type"),
    ("return 2 * value", "double d = value; return float(d)", "double is a 64-bit type"),
    ("#pragma kernel Scale", "#pragma kernel Scale\n#pragma use_dxc", "#pragma use_dxc is use_dxc"),
    ("StructuredBuffer<float> source", "StructuredBuffer<float3> source", "source has elements float3"),
    ("StructuredBuffer<float> source", "Texture2D<float> source", "is no structured buffer"),
    ("StructuredBuffer<float> source;", "StructuredBuffer<float> source;\nStructuredBuffer<uint> rest;", "uses rest"),
    ("uint count;", "uint count; uint rest;", "no kernel uses rest"),
    ("cbuffer Constants", "cbuffer Globals", "cbuffer Globals, expected one cbuffer Constants"),
    ("uint count;", "uint splatCount; uint count;", "splatCount is bound from outside, expected snake_case"),
    ("[numthreads(64, 1, 1)]", "[numthreads(32, 1, 1)]", "32 threads in a group, expected 64 to 256"),
    ("[numthreads(64, 1, 1)]", "[numthreads(32, 32, 1)]", "1024 threads in a group"),
    ("shared_values[64]", "shared_values[64][65]", "16640 bytes groupshared, expected at most 16384"),
    ("#pragma kernel Scale", "#pragma kernel Scale\n#pragma kernel Shift", "Shift is not defined"),
    ("#pragma kernel Scale", "", "Scale has numthreads but no #pragma kernel"),
    (
        "    shared_values[thread] =",
        "    if (id.x >= count)\n        return;\n    shared_values[thread] =",
        "before a barrier",
    ),
    (
        "    GroupMemoryBarrierWithGroupSync();",
        "    GroupMemoryBarrierWithGroupSync();\n    if (count == 0)\n        return;\n"
        "    GroupMemoryBarrierWithGroupSync();",
        "before a barrier",
    ),
    ("    GroupMemory", "    if (id.x < count)\n        GroupMemory", "Scale has a barrier in a branch"),
    (
        "    GroupMemory",
        "    if (id.x < count) { } else { GroupMemoryBarrierWithGroupSync(); }\n    GroupMemory",
        "in a branch",
    ),
    ("float twice(", "float Twice(", "Twice, expected camelCase"),
    ("    GroupMemoryBarrierWithGroupSync();", "", "no barrier between two uses of shared_values"),
    (
        "    shared_values[thread] =",
        "    for (uint i = 0; i < 2; i++)\n    shared_values[63 - thread] += shared_values[thread];\n"
        "    shared_values[thread] =",
        "two uses of shared_values",
    ),
    (
        "    return 2 *",
        "    shared_values[0] = value;\n    GroupMemoryBarrierWithGroupSync();\n    value += shared_values[1];\n"
        "    return 2 *",
        "two uses of shared_values",
    ),
]


def written(tmp_path: Path, text: str) -> shader_source.Shader:
    path = tmp_path / "scale.compute"
    path.write_text(text)
    return shader_source.read(path, tmp_path)


def test_the_shaders_of_this_checkout_keep_the_rules() -> None:
    assert check_shaders.rule_faults() == []


def test_every_kernel_is_in_frame_order() -> None:
    assert set(gen_kernel_table.frame_order()) == {shader.path for shader in check_shaders.kernel_shaders()}


def test_a_good_kernel_has_no_fault(tmp_path: Path) -> None:
    assert shader_rules.kernel_faults(written(tmp_path, GOOD)) == []


@pytest.mark.parametrize(("original", "replacement", "fault"), BAD, ids=[fault for *_, fault in BAD])
def test_reports_a_broken_rule(tmp_path: Path, original: str, replacement: str, fault: str) -> None:
    assert original in GOOD
    found = shader_rules.kernel_faults(written(tmp_path, GOOD.replace(original, replacement)))
    assert any(fault in line for line in found), found


def test_only_what_a_fragment_of_a_shader_computes_is_in_halves(tmp_path: Path) -> None:
    shader, header = tmp_path / "splat.shader", tmp_path / "splat.hlsl"
    allowed = "  #define SHADE half // why\n  #define SHADE4 half4\nSHADE4 color;\n"
    shader.write_text(allowed)
    assert shader_rules.file_faults(shader) == []
    for text in (
        "#define SHADE3 half2",
        "#define LIGHT half",
        "#define SHADE half + 1",
        "half4 color;",
        "min16float x;",
    ):
        shader.write_text(allowed + text)
        assert "is a 16-bit type" in shader_rules.file_faults(shader)[0], text
    header.write_text(allowed)
    assert shader_rules.file_faults(header) == ["splat.hlsl: half is a 16-bit type"]


def test_a_return_after_the_last_barrier_is_no_fault(tmp_path: Path) -> None:
    text = GOOD.replace("    if (id.x < count)\n", "    if (id.x >= count)\n        return;\n    if (id.x < count)\n")
    assert shader_rules.kernel_faults(written(tmp_path, text)) == []


def test_atomic_additions_need_no_barrier_between_them(tmp_path: Path) -> None:
    text = GOOD.replace("float shared_values[64]", "uint shared_value")
    text = text.replace(
        "shared_values[thread] =", "for (uint i = 0; i < 2; i++) InterlockedAdd(shared_value, 1);\n    1;"
    )
    text = text.replace("shared_values[63 - thread]", "shared_value")
    assert shader_rules.kernel_faults(written(tmp_path, text)) == []
    text = text.replace("    for", "    shared_value = 0;\n    for")
    assert "no barrier between two uses of shared_value" in shader_rules.kernel_faults(written(tmp_path, text))[0]


def test_reports_a_ninth_buffer(tmp_path: Path) -> None:
    names = [f"source_{n}" for n in range(8)]
    declared = "".join(f"StructuredBuffer<float> {name};\n" for name in names)
    body = "+".join(f"{name}[0]" for name in names)
    text = declared + GOOD.replace("StructuredBuffer<float> source;", "", 1).replace("source[id.x]", body)
    assert any(
        "binds 9 buffers, expected at most 8" in line for line in shader_rules.kernel_faults(written(tmp_path, text))
    )


def test_reports_faults_between_files(tmp_path: Path) -> None:
    first = written(tmp_path, GOOD)
    (tmp_path / "other.compute").write_text(GOOD.replace("<float> source", "<uint> source"))
    second = shader_source.read(tmp_path / "other.compute", tmp_path)
    first.functions["idle"] = shader_source.Function("idle", "float idle(float x)", "{ return x; }")
    assert shader_rules.package_faults([first, second], [], tmp_path) == [
        "scale.compute: there is no reference python/mua/kernels/scale.py",
        "scale.compute: tests/parity/test_scale.py does not run Scale",
        "other.compute: source is uint, but float in scale.compute",
        "other.compute: there is no reference python/mua/kernels/other.py",
        "other.compute: tests/parity/test_other.py does not run Scale",
        "idle: a function that nothing calls",
    ]


def test_text_and_compiled_code_agree() -> None:
    shaders = check_shaders.kernel_shaders()
    assert all(shader.kernels for shader in shaders)
    assert shaders
    for shader in shaders:
        for entry in shader.kernels:
            seen = reflect(compile.spirv(shader.path, entry))
            assert shader.threads(entry) == seen.threads
            writable = {(slot.name, not slot.read_only) for slot in seen.buffers}
            assert {(buffer.name, buffer.writable) for buffer in shader.used(entry)} == writable


def test_distinguishes_reads_from_writes(tmp_path: Path) -> None:
    body = "a[0] = b[c[1]]; d[0] += 1; InterlockedAdd(e[0], 1); f[0].xy = 0; if (a[0] == 1) g[(1 + 2)] = s.b;"
    text = "#pragma kernel Main\n" + "".join(f"RWStructuredBuffer<uint2> {name};" for name in "abcdefg")
    shader = written(tmp_path, f"{text} [numthreads(64, 1, 1)] void Main() {{ {body} }}")
    assert {name: shader.accesses("Main", name) for name in "abcdefg"} == {
        "a": (True, True),
        "b": (True, False),
        "c": (True, False),
        "d": (True, True),
        "e": (True, True),
        "f": (False, True),
        "g": (False, True),
    }
