"""Every program of the package's shaders compiles without a warning in every variant that Unity asks for."""

import re
from pathlib import Path

import pytest
import shader_compilers
import shader_rules
from check_shaders import kernel_shaders, messages
from engine_shaders import GAMMA, STEREO, VULKAN, Engine, words_as_floats
from engine_shaders import VARIANTS as ENGINE_VARIANTS
from shader_compilers import Compiler
from shader_programs import SAMPLES, SHADERS, VARIANTS, Program, programs
from shader_source import Shader, closing

from mua.gpu import sources

PROGRAMS = [program for path in (*SHADERS, *SAMPLES) for program in programs(path)]
COMPILERS = ["glslang", *(name for name in ("dxc", "fxc") if shader_compilers.find(name))]  # one there must be
COLOR_SPACES = {"linear": (), "gamma": ("UNITY_COLORSPACE_GAMMA",)}
ENGINE_WORDS = re.compile(r"\b(?:unity_\w+|_ProjectionParams|_ScreenParams|UNITY_UV_STARTS_AT_TOP|UNITY_MATRIX_\w+)\b")


@pytest.fixture(params=COMPILERS)
def compiler(request: pytest.FixtureRequest) -> Compiler:
    found = shader_compilers.find(request.param)
    assert found is not None, f"needs {request.param}: {shader_compilers.INSTALL[request.param]} (tools/README.md)"
    return found


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("program", PROGRAMS, ids=str)
def test_every_variant_compiles_without_a_warning(
    tmp_path: Path, compiler: Compiler, program: Program, variant: str
) -> None:
    for space in COLOR_SPACES.values() if variant == "mono" else [()]:
        path = program.write(tmp_path, *VARIANTS[variant], *space)
        for entry, stage in ((program.vertex, "vert"), (program.fragment, "frag")):
            assert messages(compiler, path, entry, stage) == [], f"{entry} {space}"


@pytest.mark.parametrize("program", PROGRAMS, ids=str)
def test_every_variant_compiles_with_the_engines_own_includes(tmp_path: Path, engine: Engine, program: Program) -> None:
    path = engine.write(program, tmp_path)
    for defines in ENGINE_VARIANTS:
        for entry, stage in ((program.vertex, "vert"), (program.fragment, "frag")):
            compiled, printed = engine.bytecode(path, entry, stage, defines)
            assert compiled.is_file(), f"{entry} {defines}: {printed}"
            assert printed == [], f"{entry} {defines}"


@pytest.mark.parametrize("program", PROGRAMS, ids=str)
def test_draws_keep_words_that_are_no_numbers_as_integers(tmp_path: Path, engine: Engine, program: Program) -> None:
    """A float of such bits may be a denormal, which devices flush to zero."""
    path = engine.write(program, tmp_path)
    for stereo in STEREO.values():
        for entry, stage in ((program.vertex, "vert"), (program.fragment, "frag")):
            assert words_as_floats(engine.glsl(path, entry, stage, (*VULKAN, *stereo, *GAMMA))) == [], (
                f"{entry} {stereo}"
            )


@pytest.mark.parametrize("shader", kernel_shaders(), ids=lambda shader: shader.path.stem)
def test_kernels_keep_words_that_are_no_numbers_as_integers(tmp_path: Path, engine: Engine, shader: Shader) -> None:
    path = tmp_path / shader.path.name
    path.write_text(shader.path.read_text())
    for entry, defines in sources.kernels(shader.path.read_text()).items():
        assert words_as_floats(engine.glsl(path, entry, "comp", (*VULKAN, *defines))) == [], entry


def test_only_words_that_every_compiler_takes() -> None:
    """No wave operation, no 16-bit type, no use_dxc, which loses the eye of a multiview pass."""
    files = [path for shader in (*SHADERS, *SAMPLES) for path in (shader, *shader.parent.glob("*.hlsl"))]
    assert [fault for path in files for fault in shader_rules.file_faults(path)] == []


@pytest.mark.parametrize("program", PROGRAMS, ids=str)
def test_the_eye_the_rows_and_the_screen_come_from_one_place(program: Program) -> None:
    """target.hlsl; a shader that asked the engine itself could disagree with it."""
    assert ENGINE_WORDS.findall(program.text) == []


@pytest.mark.parametrize("program", [program for program in PROGRAMS if program.name != "ShadowCaster"], ids=str)
def test_every_stage_is_told_its_eye_first_and_tells_the_next(program: Program) -> None:
    assert re.search(r"\{\s*UNITY_SETUP_INSTANCE_ID\(attributes\);\n", program.text)  # in the entry or what it calls
    assert _body(program.text, program.fragment).startswith("UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(")
    assert "UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(varyings);\n" in program.text


def _body(text: str, entry: str) -> str:
    """What stands in the braces of an entry point."""
    start = re.search(rf"\b{entry}\(", text)
    assert start is not None, entry
    opened = text.index("{", start.end())
    return text[opened + 1 : closing(text, opened)].strip()


def test_letters_of_the_sample_stand_among_the_things_of_the_scene() -> None:
    """Opaque to avatars, which are drawn after the queue of opaque objects and test depth."""
    (path,) = [path for path in SAMPLES if path.stem == "text"]
    (program,) = programs(path)
    assert (program.state["ZTest"], program.state["ZWrite"]) == ("LEqual", "On")
    assert '"Queue" = "AlphaTest"' in path.read_text()
