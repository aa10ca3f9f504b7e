"""Hold UPM packages to what Unity asks and no compiler here sees, a line a fault; by default those of this repository.

Exits 1 if there is any fault. .meta files are those of tools/gen_meta.py; references of assemblies are compiled by
tests/unity. A package that tools/pack_upm.py wrote is checked as it unpacks.
"""

import argparse
import json
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from gen_meta import PACKAGES

LONGEST_PATH = 140  # Windows takes 260: a project and its Library/PackageCache take some 110, .meta takes 5
NAMES = re.compile(r"[A-Za-z0-9 ._~+-]*[A-Za-z0-9_~+-]")
RESERVED = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?", re.IGNORECASE)  # devices of Windows

YAML = (".asset", ".mat", ".prefab", ".unity")
REFERENCE = re.compile(r"\{fileID: (-?\d+), guid: ([^,}]*), type: \d+\}")
GUID = re.compile(r"^guid: (.*)$", re.MULTILINE)
BUILT_IN = ("0000000000000000e000000000000000", "0000000000000000f000000000000000")
FILE_ID = {".cs": "11500000", ".compute": "7200000", ".shader": "4800000", ".asset": "11400000", ".mat": "2100000"}

SHADERS = (".shader", ".hlsl", ".cginc", ".compute")
INCLUDE = re.compile(r'^\s*#\s*include(?:_with_pragmas)?\s+"([^"]*)"', re.MULTILINE)
BUILT_IN_INCLUDE = re.compile(r"(Unity\w+|HLSLSupport|Lighting|AutoLight|TerrainEngine)\.(cginc|hlsl|glslinc)")

REQUIRED = ("name", "version", "displayName", "description", "unity", "license")
PAGES = ("README.md",)
PAGES_OF_SCRIPTS = ("CHANGELOG.md", "LICENSE.md")  # of a package that people install on its own

# Packages of Unity's assemblies that ours may refer to, by how the assemblies begin.
OPTIONAL = {
    "Unity.RenderPipelines.": "com.unity.render-pipelines.universal",
    "Unity.InputSystem": "com.unity.inputsystem",
    "Unity.Timeline": "com.unity.timeline",
    "Unity.XR.Management": "com.unity.xr.management",
    "Unity.XR.OpenXR": "com.unity.xr.openxr",
}
# The engine's own parts that a project may have switched off, by the words that need them.
MODULES = {
    r"Animator|AnimationClip|HumanBodyBones": "com.unity.modules.animation",
    r"AndroidJava\w+": "com.unity.modules.androidjni",
    r"AudioSource|AudioClip": "com.unity.modules.audio",
    r"AssetBundle": "com.unity.modules.assetbundle",
    r"LoadImage|EncodeToPNG|ImageConversion": "com.unity.modules.imageconversion",
    r"GUILayout|GUIStyle|OnGUI": "com.unity.modules.imgui",
    r"JsonUtility": "com.unity.modules.jsonserialize",
    r"Collider|Rigidbody|Physics": "com.unity.modules.physics",
    r"ScreenCapture": "com.unity.modules.screencapture",
    r"UnityWebRequest|DownloadHandler\w*": "com.unity.modules.unitywebrequest",
    r"XRSettings|XRStats|XRDevice": "com.unity.modules.vr",
    r"InputDevices|XRNode|XRDisplaySubsystem|XRInputSubsystem": "com.unity.modules.xr",
}
GONE = {"com.unity.modules.vr": "6000.5"}  # Unity's own packages that newer editors lack
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
BY_FILE = re.compile(r"\bclass (\w+)\s*:\s*(MonoBehaviour|ScriptableObject|ScriptedImporter|EditorWindow)\b")
# Symbols that Unity 6 may define, and ours of versionDefines; one that nothing defines hides code for ever.
SYMBOLS = re.compile(
    r"true|false|DEBUG|DEVELOPMENT_BUILD|TRACE|URP_COMPATIBILITY_MODE|UNITY_\d+_\d+_OR_NEWER|UNITY_INCLUDE_TESTS"
    r"|ENABLE_(IL2CPP|INPUT_SYSTEM|LEGACY_INPUT_MANAGER|MONO|PROFILER|VR)"
    r"|UNITY_(64|ANDROID|ASSERTIONS|SERVER|WEBGL|(EDITOR|STANDALONE)(_WIN|_OSX|_LINUX)?)"
)
CONDITION = re.compile(r"^\s*#\s*(?:el)?if\s+(.*)$", re.MULTILINE)
DEFINED = re.compile(r"^\s*#\s*define\s+(\w+)", re.MULTILINE)


@dataclass(frozen=True)
class Package:
    """A package's folder."""

    root: Path

    @cached_property
    def manifest(self) -> dict[str, Any]:
        return dict(json.loads((self.root / "package.json").read_text(encoding="utf-8")))

    @property
    def needed(self) -> dict[str, str]:
        return dict(self.manifest.get("dependencies", {}))

    @cached_property
    def paths(self) -> list[Path]:
        return sorted(self.root.rglob("*"))

    def where(self, path: Path) -> str:
        """A file's name in faults."""
        return f"{self.manifest['name']}/{path.relative_to(self.root).as_posix()}"

    def texts(self, *suffixes: str) -> Iterator[tuple[Path, str]]:
        """Files that end so, with their text."""
        for path in self.paths:
            if path.suffix in suffixes and path.is_file():
                yield path, path.read_text(encoding="utf-8", errors="replace")

    @cached_property
    def assemblies(self) -> dict[Path, dict[str, Any]]:
        """Assembly definitions by their folder."""
        return {path.parent: json.loads(text) for path, text in self.texts(".asmdef")}


def faults(folders: Sequence[Path]) -> list[str]:
    """Faults of packages that belong together, one sentence each: file, field, value and what was expected."""
    packages = [Package(folder) for folder in folders]
    found = [*reference_faults(packages), *include_faults(packages), *manifest_faults(packages)]
    for package in packages:
        found += [*path_faults(package), *assembly_faults(package), *script_faults(package)]
    return sorted(found)


def path_faults(package: Package) -> Iterator[str]:
    """Paths that some system cannot hold."""
    seen: dict[str, Path] = {}
    for path in package.paths:
        where, inside = package.where(path), path.relative_to(package.root).as_posix()
        if path.is_symlink():
            yield f"{where}: a link, expected a file or folder of its own"
        if len(inside.removesuffix(".meta")) > LONGEST_PATH:
            yield f"{where}: {len(inside)} characters, expected at most {LONGEST_PATH}"
        if not NAMES.fullmatch(path.name) or RESERVED.fullmatch(path.name):
            yield f"{where}: name {path.name!a}, expected letters, digits, blanks and ._~+-, and no device of Windows"
        if seen.setdefault(inside.lower(), path) != path:
            yield f"{where}: differs from another path in case only"


def reference_faults(packages: Sequence[Package]) -> Iterator[str]:
    """References of assets lead to files of these packages, with the number that Unity gives a file of that kind."""
    metas = [(path, text) for package in packages for path, text in package.texts(".meta")]
    known = {guid: path.with_suffix("") for path, text in metas for guid in GUID.findall(text)}
    for package in packages:
        for path, text in package.texts(*YAML):
            for number, guid in REFERENCE.findall(text):
                target = known.get(guid)
                wanted = FILE_ID.get(target.suffix) if target else None
                if target is None and guid not in BUILT_IN:
                    yield f'{package.where(path)}: guid "{guid}" is of no file here'
                elif target is not None and wanted not in (None, number):
                    yield f"{package.where(path)}: fileID {number}, expected {wanted} for {target.name}"


def include_faults(packages: Sequence[Package]) -> Iterator[str]:
    """Includes of shaders lead to files of these packages, or to those that come with the editor."""
    files = {f"Packages/{package.where(path)}" for package in packages for path, _ in package.texts(*SHADERS)}
    for package in packages:
        for path, text in package.texts(*SHADERS):
            for include in INCLUDE.findall(text):
                if BUILT_IN_INCLUDE.fullmatch(include) or (path.parent / include).is_file():
                    continue
                if include not in files:
                    yield f'{package.where(path)}: include "{include}", expected a file of a package here'
                elif include.split("/")[1] not in (package.manifest["name"], *package.needed):
                    yield f'{package.where(path)}: include "{include}", expected the package in dependencies'


def manifest_faults(packages: Sequence[Package]) -> Iterator[str]:
    """The manifest says what the package manager asks, of samples and pages that are there."""
    versions = {package.manifest["name"]: package.manifest.get("version") for package in packages}
    for package in packages:
        where, manifest = package.where(package.root / "package.json"), package.manifest
        yield from (f"{where}: {key}: not there, expected a text" for key in REQUIRED if not manifest.get(key))
        for name, version in package.needed.items():
            if name in GONE:
                yield f"{where}: {name}: gone from Unity {GONE[name]} on, where the package could not be installed"
            elif name not in versions and not name.startswith("com.unity."):
                yield f"{where}: {name}: expected only packages of Unity's own registry and of this repository"
            elif name in versions and version != versions[name]:
                yield f'{where}: {name}: "{version}", expected "{versions[name]}", the version of that package here'
        listed = {sample["path"] for sample in manifest.get("samples", [])}
        there = {f"Samples~/{path.name}" for path in package.root.glob("Samples~/*") if path.is_dir()}
        yield from (f"{where}: {path}: listed or there, expected both" for path in sorted(listed ^ there))
        yield from page_faults(package)


def page_faults(package: Package) -> Iterator[str]:
    """The pages that the package manager shows are there, and the changelog knows the version."""
    pages = {name: package.root / name for name in (*PAGES, *(PAGES_OF_SCRIPTS if package.assemblies else ()))}
    for path in pages.values():
        if not path.is_file():
            yield f"{package.where(path)}: not there, expected a page beside package.json"
        elif path.name == "CHANGELOG.md" and f"## {package.manifest.get('version')}" not in path.read_text("utf-8"):
            yield f'{package.where(path)}: no heading "## {package.manifest.get("version")}"'


def assembly_faults(package: Package) -> Iterator[str]:
    """What an assembly refers to is installed with the package, or the assembly asks whether it is there."""
    for folder, definition in package.assemblies.items():
        there = {rule["name"] for rule in definition.get("versionDefines", [])} | {*package.needed}
        for name in definition.get("references", []):
            owner = next((OPTIONAL[start] for start in OPTIONAL if name.startswith(start)), None)
            if owner is not None and owner not in there:
                yield f"{package.where(folder)}: references {name} of {owner}, in no dependencies or versionDefines"


def script_faults(package: Package) -> Iterator[str]:
    """Scripts use what the package depends on, under symbols that can be; Unity finds components by their file."""
    for path, text in package.texts(".cs"):
        where, code = package.where(path), NO_CODE.sub('""', text)
        folder = next((folder for folder in path.parents if folder in package.assemblies), None)
        if folder is None:
            yield f"{where}: in no assembly, expected an .asmdef in its folder or above"
            continue
        own = {rule["define"] for rule in package.assemblies[folder].get("versionDefines", [])} | {
            *DEFINED.findall(code)
        }
        for symbol in sorted(set(re.findall(r"[A-Za-z_]\w*", " ".join(CONDITION.findall(code)))) - own):
            if not SYMBOLS.fullmatch(symbol):
                yield f"{where}: #if {symbol}: nothing defines it, expected a symbol of Unity or of versionDefines"
        for words, module in MODULES.items():
            if (found := re.search(rf"\b({words})\b", code)) and module not in package.needed:
                yield f"{where}: {found[0]} of {module}, which is not in dependencies"
        for name, base in BY_FILE.findall(code):
            if name != path.stem:
                yield f"{where}: type {name}: {base}, which Unity looks for in {name}.cs"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, default=PACKAGES, help="packages that belong together")
    if found := faults(parser.parse_args().folders):
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
