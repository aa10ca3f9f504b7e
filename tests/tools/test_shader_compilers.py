"""Compilers are found where the environment points, and slangc's output keeps its meaning in wgpu."""

import sys
from pathlib import Path

import numpy as np
import pytest
import shader_compilers
import slang_output

from mua.errors import InputError

HEADER = [0x07230203, 0x00010300, 0, 9, 0]
MERGE = [3 << 16 | slang_output.OP_SELECTION_MERGE, 5, 0]
LONE_SWITCH = [3 << 16 | slang_output.OP_SWITCH, 6, 7]
SWITCH = [5 << 16 | slang_output.OP_SWITCH, 6, 7, 1, 8]
BRANCH = [2 << 16 | slang_output.OP_BRANCH, 7]
RETURN = [1 << 16 | 253]
LOOP = """#pragma kernel Sum
StructuredBuffer<uint> source;
RWStructuredBuffer<uint> sums;
[numthreads(64, 1, 1)] void Sum(uint3 id : SV_DispatchThreadID)
{
    uint sum = 0;
    [loop] for (uint i = 0; i < id.x; i++) sum += source[i];
    sums[id.x] = sum + missing;
}
"""


def code(*instructions: list[int]) -> bytes:
    return np.array([*HEADER, *(word for words in instructions for word in words)], "<u4").tobytes()


@pytest.fixture(autouse=True)
def forgotten() -> None:
    shader_compilers.find.cache_clear()


def test_a_switch_without_a_case_becomes_a_branch() -> None:
    assert slang_output.without_lone_switches(code(MERGE, LONE_SWITCH, RETURN)) == code(BRANCH, RETURN)


def test_every_other_selection_stays() -> None:
    kept = code(MERGE, SWITCH, MERGE, [4 << 16 | 250, 6, 7, 8], RETURN)
    assert slang_output.without_lone_switches(kept) == kept


@pytest.mark.parametrize("name", ["glslang", "slang"])
def test_an_error_is_reported_with_the_shaders_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / "sum.compute"
    path.write_text(LOOP)
    compiler = shader_compilers.find(name)
    assert compiler is not None
    with pytest.raises(InputError, match=r"sum\.compute: Sum does not compile: .*(missing|undefined)"):
        shader_compilers.spirv(compiler, path, "Sum")


@pytest.mark.parametrize("name", ["fxc", "dxc"])
def test_a_command_may_have_arguments_of_its_own(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setenv(f"MUA_{name.upper()}", f"'{sys.executable}' -c 'print(\"1.2.3\")' wrapped")
    found = shader_compilers.find(name)
    assert found is not None
    command = found.command(Path("/shaders/a.compute"), "Main", "comp", Path("code"))
    assert command[:4] == [sys.executable, "-c", 'print("1.2.3")', "wrapped"]
    assert "Main" in command


def test_fxc_is_given_no_path_that_looks_like_an_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUA_FXC", "fxc")
    found = shader_compilers.find("fxc")
    assert found is not None
    assert found.command(Path("/shaders/a.compute"), "Main", "vert", Path("code")) == [
        *("fxc", "-nologo", "-T", "vs_5_0", "-E", "Main", "-Fo", "code", "a.compute")
    ]


def test_a_machine_without_compilers_finds_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shader_compilers.shutil, "which", lambda *_, **__: None)
    monkeypatch.setattr(shader_compilers, "_wheel", lambda *_: None)
    assert shader_compilers.FINDERS
    for name in shader_compilers.FINDERS:
        monkeypatch.delenv(f"MUA_{name.upper()}", raising=False)
        assert shader_compilers.find(name) is None, name
    shader_compilers.find.cache_clear()
