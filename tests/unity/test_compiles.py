"""Every assembly of the package compiles against the stand-ins, with just its own references, as Unity compiles it."""

import pytest
from csharp import CSharp
from package_compiler import ENGINES, OLDEST, PACKAGE, PLAYERS, Assembly, Compiler, assemblies


@pytest.mark.parametrize("packages", [True, False], ids=["with URP and XR", "without"])
@pytest.mark.parametrize("platform", list(PLAYERS))
@pytest.mark.parametrize("assembly", assemblies().values(), ids=lambda assembly: assembly.name)
def test_an_assembly_compiles(csharp: CSharp, assembly: Assembly, platform: str, packages: bool) -> None:
    compiler = Compiler(csharp, platform, packages=packages)
    if compiler.has(assembly):
        assert compiler.built(assembly.name).name == f"{assembly.name}.dll"


@pytest.mark.parametrize("engine", [engine for engine in ENGINES if engine != OLDEST])
@pytest.mark.parametrize("platform", list(PLAYERS))
@pytest.mark.parametrize("assembly", assemblies().values(), ids=lambda assembly: assembly.name)
def test_a_newer_engine_takes_an_assembly_without_a_warning(
    csharp: CSharp, assembly: Assembly, platform: str, engine: str
) -> None:
    """Members that were deprecated meanwhile are errors here."""
    compiler = Compiler(csharp, platform, packages=True, engine=engine)
    if compiler.has(assembly):
        assert compiler.built(assembly.name).name == f"{assembly.name}.dll"


def test_a_project_may_bring_compatibility_mode_back(csharp: CSharp) -> None:
    """By a symbol that URP 17.3 asks for; set-up switches the mode off there too."""
    compiler = Compiler(csharp, "editor", packages=True, engine="6000.3", symbols=("URP_COMPATIBILITY_MODE",))
    assert compiler.built("Mua.Avatar.Editor").exists()


@pytest.mark.parametrize(
    "without",
    [("MUA_URP",), ("MUA_OPENXR",), ("MUA_XR_MANAGEMENT", "MUA_OPENXR")],
    ids=lambda symbols: " ".join(symbols),
)
def test_the_editor_compiles_without_some_packages(csharp: CSharp, without: tuple[str, ...]) -> None:
    assert Compiler(csharp, "editor", packages=True, without=without).built("Mua.Avatar.Editor").exists()


def test_no_source_is_outside_an_assembly() -> None:
    compiled = {file for assembly in assemblies().values() for file in assembly.sources()}
    assert compiled == set(PACKAGE.rglob("*.cs"))
