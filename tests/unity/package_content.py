"""What the compiled assemblies of the Unity package hold: what they declare, by reflection, and their texts."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from csharp import PROGRAMS, CSharp
from package_compiler import Compiler, assemblies


@dataclass(frozen=True)
class Content:
    """Of the editor's assemblies, with all optional packages."""

    declared: Mapping[str, list[str]]  # by kind: serialized and lost fields, menus, commands, members; in order
    assemblies: tuple[bytes, ...]

    def says(self, text: str) -> bool:
        """Whether a text is part of a string of the code, constants joined as the compiler joins them."""
        return any(text.encode("utf-16-le") in assembly for assembly in self.assemblies)


def read_content(csharp: CSharp) -> Content:
    compiler = Compiler(csharp, "editor", packages=True)
    built = [compiler.built(name) for name, assembly in assemblies().items() if compiler.has(assembly)]
    engine = [compiler.built(name) for name in ("UnityEngine", "UnityEditor")]
    program = csharp.build([PROGRAMS / "PackageProgram.cs"], references=engine)
    declared = defaultdict[str, list[str]](list)
    for line in csharp.run(program, *built).splitlines():
        kind, name = line.split("\t")
        declared[kind].append(name)
    return Content(declared, tuple(Path(path).read_bytes() for path in built))
