"""The assemblies of the Unity package, compiled against stand-ins of the engine."""

import json
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from csharp import ROOT, STAND_INS, CSharp

PACKAGE = ROOT / "unity-package"

ENGINES = {  # an engine has the symbols of all before it; stand-ins say in these what came, and what was deprecated
    "6000.0": ("UNITY_2022_3_OR_NEWER", "UNITY_6000_0_OR_NEWER"),
    "6000.3": ("UNITY_6000_1_OR_NEWER", "UNITY_6000_2_OR_NEWER", "UNITY_6000_3_OR_NEWER"),
    "6000.5": ("UNITY_6000_4_OR_NEWER", "UNITY_6000_5_OR_NEWER"),
}

OLDEST = next(iter(ENGINES))

PLAYERS = {
    "editor": ("UNITY_EDITOR", "UNITY_EDITOR_WIN", "UNITY_STANDALONE_WIN"),
    "quest": ("UNITY_ANDROID",),
    "pc": ("UNITY_STANDALONE_WIN",),
}

# Assemblies of each optional package, by the symbol that says that it is there.
OPTIONAL = {
    "MUA_URP": "Unity.RenderPipelines.",
    "MUA_XR_MANAGEMENT": "Unity.XR.Management",
    "MUA_OPENXR": "Unity.XR.OpenXR",
    "MUA_TIMELINE": "Unity.Timeline",
}


def engine_symbols(engine: str) -> tuple[str, ...]:
    """Those that every assembly is compiled with on an engine."""
    names = list(ENGINES)
    return tuple(symbol for name in names[: names.index(engine) + 1] for symbol in ENGINES[name])


ALWAYS = ("UnityEngine", "UnityEditor", "UnityEngine.TestRunner", "UnityEditor.TestRunner", "nunit.framework")


@dataclass(frozen=True)
class Assembly:
    """An asmdef and what it compiles."""

    definition: dict[str, Any]
    folder: Path

    @property
    def name(self) -> str:
        return str(self.definition["name"])

    @property
    def references(self) -> list[str]:
        """By name; the engine's own come with every assembly that does not forbid it."""
        engine = [] if self.definition.get("noEngineReferences") else ["UnityEngine"]
        compiled = [name.removesuffix(".dll") for name in self.definition.get("precompiledReferences", [])]
        return [*engine, *self.definition.get("references", []), *compiled]

    def defines(self, platform: str, *, packages: bool) -> tuple[str, ...]:
        """Symbols on a platform; `packages`: whether those that are optional are installed."""
        optional = [rule["define"] for rule in self.definition.get("versionDefines", [])] if packages else []
        keys = "ENABLE_INPUT_SYSTEM" if packages else "ENABLE_LEGACY_INPUT_MANAGER"  # as a project without the package
        return (*PLAYERS[platform], *optional, keys)

    def sources(self) -> list[Path]:
        """The folder's files, less those below another asmdef."""
        others = [path.parent for path in self.folder.rglob("*.asmdef") if path.parent != self.folder]
        files = sorted(self.folder.rglob("*.cs"))
        return [file for file in files if not any(other in file.parents for other in others)]


def assemblies() -> dict[str, Assembly]:
    """By name."""
    found = [Assembly(json.loads(path.read_text()), path.parent) for path in sorted(PACKAGE.rglob("*.asmdef"))]
    return {assembly.name: assembly for assembly in found}


class Compiler:
    """Compiles assemblies and what they refer to."""

    def __init__(
        self,
        csharp: CSharp,
        platform: str,
        *,
        packages: bool,
        without: Collection[str] = (),
        engine: str = OLDEST,
        symbols: Collection[str] = (),  # what the project defines
    ) -> None:
        self._csharp, self._platform, self._packages, self._without = csharp, platform, packages, without
        self._engine = (*engine_symbols(engine), *symbols)
        self._known, self._built = assemblies(), dict[str, Path]()

    def has(self, assembly: Assembly) -> bool:
        """Whether Unity compiles an assembly here."""
        only = assembly.definition.get("includePlatforms", [])
        wanted = set(assembly.definition.get("defineConstraints", [])) - {"UNITY_INCLUDE_TESTS"}
        defined = set(self.defines(assembly))
        return wanted <= defined and (only != ["Editor"] or self._platform == "editor")

    def defines(self, assembly: Assembly) -> list[str]:
        """Symbols that an assembly is compiled with."""
        symbols = (*self._engine, *assembly.defines(self._platform, packages=self._packages))
        return [symbol for symbol in symbols if symbol not in self._without]

    def built(self, name: str) -> Path:
        """The .dll of an assembly or of a folder of stand-ins; what is neither is no reference that Unity knows."""
        if name not in self._built:
            self._built[name] = self._own(self._known[name]) if name in self._known else self._stand_in(name)
        return self._built[name]

    def _own(self, assembly: Assembly) -> Path:
        symbols = self.defines(assembly)
        names = assembly.references
        if self._platform == "editor" and "UnityEngine" in names:
            names = [*names, "UnityEditor"]  # in the editor it comes with the engine
        references = list(dict.fromkeys(path for name in names for path in self._closed(name)))
        return self._csharp.build(
            assembly.sources(), library=True, name=assembly.name, references=references, defines=symbols
        )

    def _stand_in(self, name: str) -> Path:
        folder = STAND_INS / name
        assert folder.is_dir(), f"{name} is no assembly of the package and has no stand-ins in {STAND_INS}"
        below = folder / "references.txt"
        references = [self.built(other) for other in below.read_text().split()] if below.exists() else []
        return self._csharp.build([folder], library=True, name=name, references=references, defines=self._engine)

    def _closed(self, name: str) -> Iterator[Path]:
        """A reference; optional ones are absent where their package is not installed."""
        known = self._known.get(name)
        if known is None and not self._packages and name not in ALWAYS:
            return
        if any(name.startswith(OPTIONAL[symbol]) for symbol in self._without):
            return
        yield self.built(name)
