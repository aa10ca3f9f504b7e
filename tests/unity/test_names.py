"""What the package's C# calls by name is in the shaders, and all that the kernels declare is set by it."""

import re
from pathlib import Path

import pytest
import shader_source
from csharp import ROOT, RUNTIME

KERNELS = ROOT / "ComputeShaders"
STEMS = sorted(path.stem for path in KERNELS.glob("*.compute"))
PROPERTY = re.compile(r'Shader\.PropertyToID\("(\w+)"\)')
ENTRY = re.compile(r'new Kernel\(\w+, \w+, "(\w+)"\)')
FILE = re.compile(r'const string File = "([\w.]+)"')


def wrapper(stem: str) -> str:
    """The C# beside a .compute file: one stem in two spellings."""
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


def test_no_property_is_looked_up_in_the_frame_path() -> None:
    """PropertyToID takes a string: only a static field may call it."""
    for path in set(RUNTIME.rglob("*.cs")) - set((RUNTIME / "SelfTest").glob("*.cs")):
        for line in path.read_text().splitlines():
            assert "PropertyToID" not in line or "static readonly int" in line, f"{path.name}: {line.strip()}"


def test_every_wrapper_has_its_compute_file() -> None:
    names = {found for path in (RUNTIME / "Kernels").glob("*.cs") for found in FILE.findall(path.read_text())}
    assert names == {f"{stem}.compute" for stem in STEMS}
    assert all((KERNELS / Path(name)).exists() for name in names)
