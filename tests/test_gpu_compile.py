"""The compiler is asked once for each content, and what it refuses is one sentence."""

from dataclasses import replace
from pathlib import Path

import pytest

from mua.errors import InputError
from mua.gpu import compile, compilers
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
def shader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "value.hlsl").write_text('#include "deeper.hlsl"\n')
    (tmp_path / "deeper.hlsl").write_text("#define VALUE 7\n")
    path = tmp_path / "fill.compute"
    path.write_text(SHADER)
    return path


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The entries that were compiled, not taken from the cache."""
    entries: list[str] = []
    compile_entry = compile.compile_entry

    def counted(compiler: compilers.Compiler, path: Path, options: tuple[str, ...]) -> bytes:
        entries.append(options[0])
        return compile_entry(compiler, path, options)

    monkeypatch.setattr(compile, "compile_entry", counted)
    return entries


def test_compiles_once_for_each_content(shader: Path, runs: list[str]) -> None:
    first = compile.spirv(shader, "Fill")
    assert compile.spirv(shader, "Fill") == first
    assert runs == ["Fill"]
    cached = list(compile.cache_directory().iterdir())
    assert [path.read_bytes() for path in cached] == [first]


@pytest.mark.parametrize("edited", ["value.hlsl", "deeper.hlsl", "fill.compute"])
def test_an_edit_of_the_file_or_an_include_compiles_again(shader: Path, runs: list[str], edited: str) -> None:
    compile.spirv(shader, "Fill")
    with (shader.parent / edited).open("a") as file:
        file.write("// edited\n")
    compile.spirv(shader, "Fill")
    assert runs == ["Fill", "Fill"]


def test_a_moved_shader_is_not_compiled_again(shader: Path, runs: list[str], tmp_path: Path) -> None:
    compile.spirv(shader, "Fill")
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    for name in ("fill.compute", "value.hlsl", "deeper.hlsl"):
        (moved / name).write_bytes((tmp_path / name).read_bytes())
    compile.spirv(moved / "fill.compute", "Fill")
    assert runs == ["Fill"]


def test_another_version_of_the_compiler_compiles_again(
    shader: Path, runs: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    compile.spirv(shader, "Fill")
    newer = replace(compile.find_compiler("glslang"), version="99")
    monkeypatch.setattr(compilers, "find", lambda _: newer)
    compile.spirv(shader, "Fill")
    assert runs == ["Fill", "Fill"]


def test_a_kernel_is_compiled_with_the_defines_of_its_pragma(shader: Path) -> None:
    assert reflect(compile.spirv(shader, "Fill")).threads == (64, 1, 1)
    assert reflect(compile.spirv(shader, "FillWide")).threads == (128, 1, 1)


def test_names_the_kernels_that_there_are(shader: Path) -> None:
    with pytest.raises(InputError, match=r"fill\.compute: has no kernel Flil; it has Fill, FillWide"):
        compile.spirv(shader, "Flil")


def test_says_what_does_not_compile_and_caches_nothing(shader: Path) -> None:
    shader.write_text(SHADER.replace("= VALUE", "= missing"))
    with pytest.raises(InputError, match=r"fill\.compute: Fill does not compile: .*'missing'"):
        compile.spirv(shader, "Fill")
    assert not compile.cache_directory().exists()


def test_an_absent_include_is_named(shader: Path) -> None:
    (shader.parent / "deeper.hlsl").unlink()
    with pytest.raises(InputError, match=r"deeper\.hlsl"):
        compile.spirv(shader, "Fill")


def test_an_absent_compiler_is_told_with_its_package(shader: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compilers, "find", lambda _: None)
    with pytest.raises(InputError, match=r"glslang is not on this machine; it comes with .* glslang-tools"):
        compile.spirv(shader, "Fill")


def test_a_cache_that_cannot_be_written_costs_only_time(
    shader: Path, runs: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = shader.parent / "file"
    file.touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(file))
    assert compile.spirv(shader, "Fill") == compile.spirv(shader, "Fill")
    assert runs == ["Fill", "Fill"]


def test_shaders_are_utf8(shader: Path) -> None:
    shader.write_bytes(b"// \xff\n")
    with pytest.raises(InputError, match="byte 3 is not"):
        compile.spirv(shader, "Fill")
