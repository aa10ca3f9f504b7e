"""The members of the engine and of other packages that the Unity package's assemblies use.

They are compiled against the tests' stand-ins, which declare exactly what is used.
"""

import shutil
import sys
import tempfile
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from csharp_source import accesses, syntax

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests" / "unity"), str(ROOT / "tests" / "fixtures")]

from csharp import CSharp  # noqa: E402 with the tests' modules on the path
from package_compiler import PLAYERS, STAND_INS, Compiler, assemblies, engine_symbols  # noqa: E402

LISTER = Path(__file__).with_name("used_members.cs")


@dataclass(frozen=True)
class Used:
    """A member as the stand-ins declare it."""

    kind: str  # type, constructor, method, get, set, field, add, remove, enum or const
    type: str
    name: str
    is_static: bool
    value: str
    parameters: tuple[str, ...]

    def __str__(self) -> str:
        inside = f"({', '.join(self.parameters)})" if self.kind in ("method", "constructor") else ""
        word = f"{self.kind} " if self.kind in ("get", "set", "add", "remove") else ""
        return f"{word}{self.type}{'.' * bool(self.name)}{self.name}{inside}"


def used_members(csharp: CSharp, engine: str) -> list[Used]:
    """The members of the stand-ins that the package's assemblies use, on every platform."""
    lister = csharp.build([LISTER])
    lines: set[str] = set()
    for platform in PLAYERS:
        compiler = Compiler(csharp, platform, packages=True, engine=engine)
        ours = [name for name, assembly in assemblies().items() if compiler.has(assembly)]
        theirs = sorted({path.parent.name for path in STAND_INS.rglob("*.cs")})
        with tempfile.TemporaryDirectory() as folder:
            for name in (*ours, *theirs):
                shutil.copy(compiler.built(name), folder)
            lines |= set(csharp.run(lister, folder, *ours, "--", *theirs).splitlines())
    return sorted({_parsed(line) for line in lines}, key=str)


def _parsed(line: str) -> Used:
    kind, owner, name, static, value, more = line.split("\t")
    parameters = tuple(more.split("|")) if more and kind not in ("enum", "const") else ()
    return Used(kind, owner, name, static == "static", more if kind in ("enum", "const") else value, parameters)


def named(members: Collection[Used], engine: str) -> list[Used]:
    """Without those values, which a compiler puts in place, that no source of the package names on an engine."""
    accessed = {
        access
        for platform in PLAYERS
        for assembly in assemblies().values()
        for file in assembly.sources()
        for access in accesses(
            syntax(file.read_text(), {*engine_symbols(engine), *assembly.defines(platform, packages=True)})
        )
    }
    return [
        used
        for used in members
        if used.kind not in ("enum", "const") or f"{used.type.split('.')[-1]}.{used.name}" in accessed
    ]
