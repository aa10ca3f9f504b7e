"""Unchanged shaders need no compiler: every entry point comes compiled from the text of this checkout."""

import shutil
from dataclasses import replace
from pathlib import Path

import check_shaders
import gen_spirv
import pytest

from mua.errors import InputError
from mua.gpu import compile, glslang, packaged_spirv, sources
from mua.gpu.reflect import reflect

ENTRIES = check_shaders.entry_points()


@pytest.fixture
def without_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine without a shader compiler."""
    monkeypatch.setattr(glslang, "find", lambda: None)


@pytest.fixture
def copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The shaders' directory, as of a checkout in which they are edited."""
    directory = tmp_path / "shaders"
    shutil.copytree(sources.directory(), directory)
    monkeypatch.setenv("MUA_SHADERS", str(directory))
    return directory


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of what comes compiled."""
    return Path(shutil.copytree(packaged_spirv.FOLDER, tmp_path / "compiled"))


@pytest.mark.parametrize(("path", "entry", "stage"), ENTRIES, ids=[entry for _, entry, _ in ENTRIES])
def test_every_entry_point_runs_without_a_compiler(without_compiler: None, path: Path, entry: str, stage: str) -> None:
    interface = reflect(compile.spirv(path, entry, stage=stage))
    assert (interface.threads != (1, 1, 1)) == (stage == "comp")


def test_what_comes_compiled_is_up_to_date() -> None:
    assert gen_spirv.SPIRV.faults() == []


def test_shaders_elsewhere_with_the_same_text_come_compiled_too(without_compiler: None, copied: Path) -> None:
    path = sources.find("mlp_matmul.compute")
    assert path.parent == copied
    assert compile.spirv(path, "MlpMatmul") == (packaged_spirv.FOLDER / "mlp_matmul.MlpMatmul.comp.spv").read_bytes()


@pytest.mark.parametrize("edited", ["mlp_matmul.compute", "common.hlsl"])
def test_a_changed_shader_asks_for_a_compiler_in_one_sentence(
    without_compiler: None, copied: Path, edited: str
) -> None:
    with (copied / edited).open("a") as file:
        file.write("// edited\n")
    path = copied / "mlp_matmul.compute"
    message = r"mlp_matmul\.compute: MlpMatmul as it stands here does not come compiled, and .* glslang-tools"
    with pytest.raises(InputError, match=message):
        compile.spirv(path, "MlpMatmul")


def test_a_changed_shader_is_compiled_anew(copied: Path) -> None:
    path = copied / "mlp_matmul.compute"
    path.write_text(path.read_text().replace("numthreads(LANES, ROWS", "numthreads(ROWS, LANES"))
    assert reflect(compile.spirv(path, "MlpMatmul")).threads == (8, 32, 1)


def _flip(folder: Path) -> None:
    content = bytearray((folder / "splat.SplatVert.vert.spv").read_bytes())
    content[-1] ^= 1
    (folder / "splat.SplatVert.vert.spv").write_bytes(content)


def _of_another_text(folder: Path) -> None:
    index = folder / packaged_spirv.INDEX
    name = "splat.SplatVert.vert.spv"
    made_from = replace(gen_spirv.SPIRV, path=folder).index()["made from"]
    index.write_text(index.read_text().replace(made_from[name], 64 * "0"))


@pytest.mark.parametrize(
    ("damage", "fault"),
    [
        (_flip, "splat.SplatVert.vert.spv is not what the compiler makes"),
        (_of_another_text, "splat.SplatVert.vert.spv was made from another text"),
        (lambda folder: (folder / "splat.SplatVert.vert.spv").unlink(), "splat.SplatVert.vert.spv is missing"),
        (lambda folder: (folder / "old.Old.comp.spv").touch(), "old.Old.comp.spv belongs to no shader"),
    ],
    ids=["code", "text", "missing", "left over"],
)
def test_the_check_names_what_is_out_of_date(folder: Path, damage, fault: str) -> None:  # type: ignore[no-untyped-def]
    damage(folder)
    assert replace(gen_spirv.SPIRV, path=folder).faults() == [fault]


def test_writing_mends_what_is_out_of_date(folder: Path) -> None:
    _flip(folder)
    (folder / "old.Old.comp.spv").touch()
    spirv = replace(gen_spirv.SPIRV, path=folder)
    spirv.write()
    assert spirv.faults() == []
    assert (folder / packaged_spirv.INDEX).read_bytes() == (packaged_spirv.FOLDER / packaged_spirv.INDEX).read_bytes()
