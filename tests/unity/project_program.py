"""The program that sets projects up and builds players in stand-ins of the editor, and what it tells."""

from pathlib import Path

from csharp import PROGRAMS, CSharp, by_name
from package_compiler import Compiler, assemblies

Reports = dict[str, list[str]]
PACKAGES = ("Unity.RenderPipelines.", "Unity.XR.Management", "Unity.XR.OpenXR")


class ProjectProgram:
    """Runs stories of programs/ProjectProgram.cs, with or without the optional packages, with or without the sample."""

    def __init__(self, csharp: CSharp) -> None:
        self._csharp = csharp
        self._built: dict[tuple[bool, bool], Path] = {}

    def tell(self, story: str, *arguments: object, packages: bool = True, sample: bool = True) -> Reports:
        return by_name(self._csharp.run(self._program(packages, sample), story, *arguments))

    def _program(self, packages: bool, sample: bool) -> Path:
        if (packages, sample) not in self._built:
            compiler = Compiler(self._csharp, "editor", packages=packages)
            editor = assemblies()["Mua.Avatar.Editor"]
            wanted = ("Mua.", "UnityE", *(PACKAGES if packages else ()))
            names = [name for name in editor.references if name.startswith(wanted)]
            self._built[packages, sample] = self._csharp.build(
                [PROGRAMS / "ProjectProgram.cs"],
                name="Mua.Avatar.Editor.Tests",  # which may see the package's internals
                references=[compiler.built(name) for name in [*names, "UnityEditor", editor.name]],
                defines=[*compiler.defines(editor), *(["SAMPLE"] if sample else [])],
            )
        return self._built[packages, sample]
