"""What the package's C# calls by name is in the shaders, and all that the shaders declare is set by it."""

import re
from pathlib import Path

import pytest
import shader_source
from csharp import ROOT, RUNTIME
from shader_programs import ENGINE, SHADERS, VARIANTS, Program, programs

from mua.gpu.compile import spirv
from mua.gpu.reflect import reflect

KERNELS = ROOT / "ComputeShaders"
STEMS = sorted(path.stem for path in KERNELS.glob("*.compute"))
PROPERTY = re.compile(r'Shader\.PropertyToID\("(\w+)"\)')
ENTRY = re.compile(r'new Kernel\(\w+, \w+, "(\w+)"\)')
PASS = re.compile(r"\b(\w+)Pass = (\d+)")
FILE = re.compile(r'const string File = "([\w.]+)"')


def wrapper(stem: str) -> str:
    """The C# of a shader: one stem in two spellings."""
    return (RUNTIME / "Kernels" / f"{''.join(word.capitalize() for word in stem.split('_'))}.cs").read_text()


def declared(stem: str) -> set[str]:
    """Buffers and constants of a .compute file."""
    shader = shader_source.read(KERNELS / f"{stem}.compute", KERNELS)
    members = [member for block in shader.blocks.values() for member in block]
    return {*shader.buffers, *(re.sub(r"\[.*", "", member).split()[-1] for member in members)}


@pytest.mark.parametrize("stem", STEMS)
def test_buffers_and_constants_have_the_same_names(stem: str) -> None:
    assert set(PROPERTY.findall(wrapper(stem))) == declared(stem)


@pytest.mark.parametrize("stem", STEMS)
def test_entry_points_have_the_same_names(stem: str) -> None:
    source = wrapper(stem)
    assert FILE.findall(source) == [f"{stem}.compute"]
    assert sorted(ENTRY.findall(source)) == sorted(shader_source.read(KERNELS / f"{stem}.compute", KERNELS).kernels)


def bound(program: Program, folder: Path) -> set[str]:
    """Buffers that a pass of a .shader file reads, and the constants that it declares, of all variants."""
    names = set()
    for defines in VARIANTS.values():
        path = program.write(folder, *defines)
        for entry, stage in ((program.vertex, "vert"), (program.fragment, "frag")):
            interface = reflect(spirv(path, entry, stage=stage))
            names |= {slot.name for slot in interface.buffers} | {constant.name for constant in interface.constants}
    return names


@pytest.mark.parametrize("path", SHADERS, ids=lambda path: path.stem)
def test_what_draws_binds_what_the_shader_declares(tmp_path: Path, path: Path) -> None:
    names = set().union(*(bound(program, tmp_path) for program in programs(path)))
    assert set(PROPERTY.findall(wrapper(f"{path.stem}_draw"))) == names - ENGINE


@pytest.mark.parametrize("path", SHADERS, ids=lambda path: path.stem)
def test_passes_have_their_numbers(path: Path) -> None:
    numbers = {program.name: program.index for program in programs(path)}
    found = {name: int(number) for name, number in PASS.findall(wrapper(f"{path.stem}_draw"))}
    assert found.items() <= numbers.items()
    assert found


def test_no_property_is_looked_up_in_the_frame_path() -> None:
    """PropertyToID takes a string: only a static field may call it."""
    files = set(RUNTIME.rglob("*.cs")) - set((RUNTIME / "SelfTest").glob("*.cs"))
    lookups = [line.strip() for path in files for line in path.read_text().splitlines() if "PropertyToID" in line]
    assert lookups
    assert [line for line in lookups if "static readonly int" not in line] == []


def test_every_wrapper_has_its_compute_file() -> None:
    names = {found for path in (RUNTIME / "Kernels").glob("*.cs") for found in FILE.findall(path.read_text())}
    assert names == {f"{stem}.compute" for stem in STEMS}
    assert all((KERNELS / Path(name)).exists() for name in names)
