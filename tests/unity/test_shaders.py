"""Every program of the package's shaders compiles without a warning, and binds what C# sets: tests/unity/test_names.py."""

import re
from pathlib import Path

import pytest
import shader_rules
from check_shaders import messages
from shader_programs import SHADERS, VARIANTS, Program, programs

from mua.gpu import compilers

PROGRAMS = [program for path in SHADERS for program in programs(path)]
COMPILERS = ("glslang", "dxc", "fxc")
COLOR_SPACES = {"linear": (), "gamma": ("UNITY_COLORSPACE_GAMMA",)}


@pytest.fixture(params=COMPILERS)
def compiler(request: pytest.FixtureRequest) -> compilers.Compiler:
    found = compilers.find_fxc() if request.param == "fxc" else compilers.find(request.param)
    if found is None:
        pytest.skip(f"needs {request.param}: {compilers.INSTALL[request.param]} (tools/README.md)")
    return found


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: f"{program.shader.split('/')[-1]} {program.name}")
def test_every_variant_compiles_without_a_warning(
    tmp_path: Path, compiler: compilers.Compiler, program: Program, variant: str
) -> None:
    for space in COLOR_SPACES.values():
        path = program.write(tmp_path, *VARIANTS[variant], *space)
        for entry, stage in ((program.vertex, "vert"), (program.fragment, "frag")):
            assert messages(compiler, path, entry, stage) == [], f"{entry} {space}"


def test_only_words_that_every_compiler_takes() -> None:
    """No wave operation, no 16-bit type, no use_dxc, which loses the eye of a multiview pass."""
    files = [*SHADERS, *SHADERS[0].parent.glob("*.hlsl")]
    assert [fault for path in files for fault in shader_rules.file_faults(path)] == []


def test_the_eye_and_the_rows_are_taken_from_unity_in_one_place() -> None:
    for path in SHADERS:
        text = path.read_text()
        assert not re.search(r"unity_StereoEyeIndex|_ProjectionParams|UNITY_UV_STARTS_AT_TOP|UNITY_MATRIX", text), (
            path.name
        )
