"""UPM packages as the rules see them: files, what Unity imports, .meta files and assembly definitions."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path, PurePosixPath
from typing import Any

GUID = re.compile(r"^guid: (.*)$", re.MULTILINE)
# Folders of one package that were another package once, and kept the GUIDs that they had there.
FOLDED = {"ComputeShaders": "com.mua.kernels"}


@dataclass(frozen=True)
class Package:
    """A package's folder; paths are relative to it, with slashes."""

    root: Path
    entries: Sequence[PurePosixPath] = field(init=False)  # all files and folders, sorted

    def __post_init__(self) -> None:
        found = sorted(path.relative_to(self.root).as_posix() for path in self.root.rglob("*"))
        object.__setattr__(self, "entries", [PurePosixPath(path) for path in found])

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """package.json; empty where it is not there or is no object, which `upm_manifest` reports."""
        try:
            read = json.loads((self.root / "package.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}
        return read if isinstance(read, dict) else {}

    @property
    def name(self) -> str:
        """The name in package.json, else the folder's."""
        return str(self.manifest.get("name") or self.root.name)

    def where(self, path: PurePosixPath) -> str:
        """A file's name in faults."""
        return f"{self.name}/{path}"

    def is_folder(self, path: PurePosixPath) -> bool:
        """Whether a path is a folder."""
        return (self.root / path).is_dir()

    def files(self, *suffixes: str) -> list[PurePosixPath]:
        """Files that end so, hidden ones left out; those of Samples~ count."""
        return [path for path in self.entries if path.suffix in suffixes and is_imported(path)]

    def text(self, path: PurePosixPath) -> str:
        """A file's text, bytes that are no UTF-8 replaced."""
        return (self.root / path).read_text(encoding="utf-8", errors="replace")

    def assets(self) -> list[PurePosixPath]:
        """Files and folders that need a .meta file; git keeps no empty folder, so they need none."""
        return [path for path in self.entries if needs_meta(path) and not self._is_empty(path)]

    def _is_empty(self, path: PurePosixPath) -> bool:
        return self.is_folder(path) and not any(file.is_file() for file in (self.root / path).rglob("*"))

    @cached_property
    def guids(self) -> Mapping[str, PurePosixPath]:
        """Assets by the GUID in their .meta file; of two with the same one, which is a fault, the last."""
        metas = [path for path in self.entries if path.suffix == ".meta" and not self.is_folder(path)]
        found = {guid: path.with_suffix("") for path in metas for guid in GUID.findall(self.text(path))}
        return {guid: path for guid, path in found.items() if (self.root / path).exists()}

    @cached_property
    def assemblies(self) -> Sequence["Assembly"]:
        """Assembly definitions that are JSON objects; the others are faults of `upm_assemblies`."""
        found = []
        for path in self.files(".asmdef"):
            try:
                read = json.loads(self.text(path))
            except ValueError:
                continue
            if isinstance(read, dict):
                found.append(Assembly(self, path, read))
        return found


@dataclass(frozen=True)
class Assembly:
    """An assembly definition."""

    package: Package
    path: PurePosixPath
    definition: dict[str, Any]

    @property
    def name(self) -> str:
        return str(self.definition.get("name", ""))

    def items(self, key: str) -> list[Any]:
        """A field that is a list, empty where it is not there."""
        value = self.definition.get(key, [])
        return value if isinstance(value, list) else []

    @property
    def symbols(self) -> set[str]:
        """Symbols that its version defines may define."""
        return {str(rule.get("define")) for rule in self.items("versionDefines") if isinstance(rule, dict)}


def is_imported(path: PurePosixPath) -> bool:
    """Whether Unity imports a path, or copies it out of Samples~."""
    return not any(part.startswith(".") or (part.endswith("~") and part != "Samples~") for part in path.parts)


def needs_meta(path: PurePosixPath) -> bool:
    """Whether a path that exists must have a .meta file."""
    return is_imported(path) and path.name != "Samples~" and path.suffix != ".meta"
