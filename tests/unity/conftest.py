"""Fixtures of the Unity package's tests."""

import functools
import shutil
from collections.abc import Callable
from pathlib import Path

import component
import engine_shaders
import package_content
import pipelines
import pytest
from csharp import PROGRAMS, CSharp
from format_program import program

__all__ = ["program"]  # a fixture, which modules with a program of their own replace


@pytest.fixture(scope="session")
def csharp() -> CSharp:
    """mcs and mono."""
    for tool, package in (("mcs", "mono-mcs"), ("mono", "mono-runtime")):
        if shutil.which(tool) is None:
            pytest.skip(f"needs {tool}: Debian's package {package}, which tools/setup.sh installs, runs this test")
    return CSharp()


@pytest.fixture(scope="session")
def content(csharp: CSharp) -> package_content.Content:
    """What the package's compiled assemblies hold."""
    return package_content.read_content(csharp)


@pytest.fixture(scope="session")
def component_program(csharp: CSharp) -> Path:
    """The program of stories about AvatarRenderer."""
    return component.build_program(csharp)


@pytest.fixture(scope="session")
def frame_program(csharp: CSharp) -> Path:
    """The program that records frames of scenarios."""
    return csharp.runtime(PROGRAMS / "shared", PROGRAMS / "scenario", PROGRAMS / "FrameProgram.cs")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The avatars of these stories; tests add their own."""
    made = tmp_path_factory.mktemp("avatars")
    component.write_avatars(made)
    return made


@pytest.fixture(scope="module")
def story(csharp: CSharp, component_program: Path, folder: Path) -> component.Story:
    """What a story says, by its name and the names of avatars; each is told once."""
    return functools.cache(functools.partial(component.tell, csharp, component_program, folder))


@pytest.fixture(scope="session")
def record(csharp: CSharp, tmp_path_factory: pytest.TempPathFactory) -> Callable[[pipelines.Mode], pipelines.Recorded]:
    """Runs a mode, once for all tests."""
    program = pipelines.built(csharp)
    return functools.cache(lambda mode: pipelines.run(csharp, program, mode, tmp_path_factory.mktemp("pipeline")))


@pytest.fixture(params=pipelines.MODES, ids=pipelines.label)
def recorded(
    request: pytest.FixtureRequest, record: Callable[[pipelines.Mode], pipelines.Recorded]
) -> pipelines.Recorded:
    """A run in each mode."""
    return record(request.param)


@pytest.fixture(params=[mode for mode in pipelines.MODES if mode.pipeline == "urp"], ids=pipelines.label)
def universal(
    request: pytest.FixtureRequest, record: Callable[[pipelines.Mode], pipelines.Recorded]
) -> pipelines.Recorded:
    """A run in each mode of URP."""
    return record(request.param)


@pytest.fixture(scope="session")
def engine() -> engine_shaders.Engine:
    """Unity's own compilers of shaders."""
    found = engine_shaders.find()
    if found is None:
        pytest.skip(f"needs {engine_shaders.NEEDS}: the engine's own include files and translator run this test")
    return found
