"""Compilers are found where they are said to be, and slangc's output keeps its meaning in wgpu."""

import sys
from pathlib import Path

import numpy as np
import pytest

from mua.errors import InputError
from mua.gpu import compile, compilers, slang

HEADER = [0x07230203, 0x00010300, 0, 9, 0]
MERGE = [3 << 16 | slang.OP_SELECTION_MERGE, 5, 0]
LONE_SWITCH = [3 << 16 | slang.OP_SWITCH, 6, 7]
SWITCH = [5 << 16 | slang.OP_SWITCH, 6, 7, 1, 8]
BRANCH = [2 << 16 | slang.OP_BRANCH, 7]
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
    compilers.find.cache_clear()


def test_a_switch_without_a_case_becomes_a_branch() -> None:
    assert slang.without_lone_switches(code(MERGE, LONE_SWITCH, RETURN)) == code(BRANCH, RETURN)


def test_every_other_selection_stays() -> None:
    kept = code(MERGE, SWITCH, MERGE, [4 << 16 | 250, 6, 7, 8], RETURN)
    assert slang.without_lone_switches(kept) == kept


@pytest.mark.parametrize("name", ["glslang", "slang"])
def test_an_error_is_told_with_the_shaders_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / "sum.compute"
    path.write_text(LOOP)
    with pytest.raises(InputError, match=r"sum\.compute: Sum does not compile: .*(missing|undefined)"):
        compile.spirv(path, "Sum", compiler=name)


@pytest.mark.parametrize("variable", ["MUA_FXC", "MUA_DXC"])
def test_a_command_may_have_arguments_of_its_own(monkeypatch: pytest.MonkeyPatch, variable: str) -> None:
    monkeypatch.setenv(variable, f"'{sys.executable}' -c 'print(\"1.2.3\")' wrapped")
    found = compilers.find_fxc() if variable == "MUA_FXC" else compilers.find("dxc")
    assert found is not None
    command = found.command(Path("/shaders/a.compute"), "Main", "comp", Path("code"))
    assert command[:4] == [sys.executable, "-c", 'print("1.2.3")', "wrapped"]
    assert "Main" in command


def test_fxc_is_given_no_path_that_looks_like_an_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUA_FXC", "fxc")
    found = compilers.find_fxc()
    assert found is not None
    assert found.command(Path("/shaders/a.compute"), "Main", "vert", Path("code")) == [
        *("fxc", "-nologo", "-T", "vs_5_0", "-E", "Main", "-Fo", "code", "a.compute")
    ]


def test_says_what_brings_a_compiler_that_is_absent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compilers.shutil, "which", lambda *_, **__: None)
    monkeypatch.setattr(compilers, "_wheel", lambda *_: None)
    monkeypatch.delenv("MUA_DXC", raising=False)
    for name in compilers.FINDERS:
        compilers.find.cache_clear()
        with pytest.raises(InputError, match=rf"compiler {name} is not on this machine; it comes with"):
            compile.find_compiler(name)
    monkeypatch.delenv("MUA_FXC", raising=False)
    assert compilers.find_fxc() is None
