"""The package as it unpacks from its tarball compiles: every assembly, and every shader with its folded kernels."""

import shutil
import subprocess
from pathlib import Path

import pack_upm
import package_compiler
import pytest
import shader_programs
from csharp import CSharp
from package_compiler import Compiler, assemblies

STAGES = {"vert": "vertex", "frag": "fragment"}


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with Packages/com.mua.avatar, where a project has it."""
    made = tmp_path_factory.mktemp("project")
    pack_upm.unpack(pack_upm.read(pack_upm.pack(pack_upm.contents())), made / "Packages" / pack_upm.NAME)
    return made


@pytest.mark.parametrize("platform", ["editor", "quest"])
def test_every_assembly_compiles(csharp: CSharp, root: Path, platform: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(package_compiler, "PACKAGE", root / "Packages" / pack_upm.NAME)
    compiler = Compiler(csharp, platform, packages=True)
    found = [assembly for assembly in assemblies().values() if compiler.has(assembly)]
    assert len(found) > 2
    for assembly in found:
        assert root in assembly.folder.parents
        assert compiler.built(assembly.name).name == f"{assembly.name}.dll"


@pytest.mark.skipif(shutil.which("glslangValidator") is None, reason="needs glslangValidator: Debian's glslang-tools")
@pytest.mark.parametrize("name", [path.name for path in shader_programs.SHADERS])
def test_every_shader_finds_its_kernels(root: Path, tmp_path: Path, name: str) -> None:
    folder = root / "Packages" / pack_upm.NAME / "Runtime" / "Shaders"
    found = shader_programs.programs(folder / name)
    assert found
    for program in found:
        path = tmp_path / f"{program.name}.hlsl"
        path.write_text(program.text)
        for stage, kind in STAGES.items():
            includes = [f"-I{place}" for place in (root, folder, shader_programs.STAND_IN)]
            entry = ["-e", getattr(program, kind), "-S", stage]
            command = ["glslangValidator", "-D", "-V", *includes, *entry, "-o", str(tmp_path / "code"), str(path)]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout
