"""The compiler runs once for each content, and its refusal becomes one sentence."""

from pathlib import Path

import pytest

from mua.errors import InputError
from mua.gpu import compile, glslang
from mua.gpu.reflect import reflect

SHADER = """#pragma kernel Fill
#pragma kernel FillWide WIDE=1
#include "value.hlsl"
#ifdef WIDE
#define THREADS 128
#else
#define THREADS 64
#endif
RWStructuredBuffer<uint> y;
[numthreads(THREADS, 1, 1)] void Fill(uint3 id : SV_DispatchThreadID) { y[id.x] = VALUE; }
[numthreads(THREADS, 1, 1)] void FillWide(uint3 id : SV_DispatchThreadID) { y[id.x] = VALUE; }
"""


@pytest.fixture
def shader(tmp_path: Path) -> Path:
    (tmp_path / "value.hlsl").write_text('#include "deeper.hlsl"\n')
    (tmp_path / "deeper.hlsl").write_text("#define VALUE 7\n")
    path = tmp_path / "fill.compute"
    path.write_text(SHADER)
    return path


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The entries that were compiled, not taken from what this process keeps."""
    entries: list[str] = []
    built = glslang.compile

    def counted(path: Path, options: tuple[str, ...]) -> bytes:
        entries.append(options[0])
        return built(path, options)

    monkeypatch.setattr(glslang, "compile", counted)
    return entries


def test_compiles_once_for_each_content(shader: Path, runs: list[str]) -> None:
    first = compile.spirv(shader, "Fill")
    assert compile.spirv(shader, "Fill") == first
    assert runs == ["Fill"]


@pytest.mark.parametrize("edited", ["value.hlsl", "deeper.hlsl", "fill.compute"])
def test_an_edit_of_the_file_or_an_include_compiles_again(shader: Path, runs: list[str], edited: str) -> None:
    compile.spirv(shader, "Fill")
    with (shader.parent / edited).open("a") as file:
        file.write("// edited\n")
    compile.spirv(shader, "Fill")
    assert runs == ["Fill", "Fill"]


def test_a_kernel_is_compiled_with_the_defines_of_its_pragma(shader: Path) -> None:
    assert reflect(compile.spirv(shader, "Fill")).threads == (64, 1, 1)
    assert reflect(compile.spirv(shader, "FillWide")).threads == (128, 1, 1)


def test_names_the_kernels_that_there_are(shader: Path) -> None:
    with pytest.raises(InputError, match=r"fill\.compute: has no kernel Flil; it has Fill, FillWide"):
        compile.spirv(shader, "Flil")


def test_says_what_does_not_compile(shader: Path) -> None:
    shader.write_text(SHADER.replace("= VALUE", "= missing"))
    with pytest.raises(InputError, match=r"fill\.compute: Fill does not compile: .*'missing'"):
        compile.spirv(shader, "Fill")


def test_an_absent_include_is_named(shader: Path) -> None:
    (shader.parent / "deeper.hlsl").unlink()
    with pytest.raises(InputError, match=r"deeper\.hlsl"):
        compile.spirv(shader, "Fill")


def test_an_absent_compiler_is_reported_with_its_package(shader: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(glslang, "find", lambda: None)
    message = (
        r"Fill as it stands here does not come compiled, and .* is not on this machine; it comes with .* glslang-tools"
    )
    with pytest.raises(InputError, match=message):
        compile.spirv(shader, "Fill")


def test_shaders_are_utf8(shader: Path) -> None:
    shader.write_bytes(b"// \xff\n")
    with pytest.raises(InputError, match="byte 3 is not"):
        compile.spirv(shader, "Fill")
