"""Rules for the files of a UPM package, as faults: paths, .meta files, references by GUID and includes of shaders."""

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

import gen_meta
from upm_package import FOLDED, GUID, Package, is_imported, needs_meta

LONGEST_PATH = 140  # Windows takes 260: a project and its Library/PackageCache take some 110, .meta takes 5
NAMES = re.compile(r"[A-Za-z0-9 ._~+-]+")
RESERVED = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?", re.IGNORECASE)  # devices of Windows
HIDDEN = ("Samples~", "Documentation~", "Tests/Golden~")

YAML = (".asset", ".mat", ".prefab", ".unity", ".controller", ".anim", ".lighting", ".renderTexture")
REFERENCE = re.compile(r"\{fileID: (-?\d+), guid: ([^,}]*), type: (\d+)\}")
BUILT_IN = ("0000000000000000e000000000000000", "0000000000000000f000000000000000")
FILE_ID = {".cs": "11500000", ".compute": "7200000", ".shader": "4800000", ".asset": "11400000", ".mat": "2100000"}

SHADERS = (".shader", ".hlsl", ".cginc", ".compute")
INCLUDE = re.compile(r'^\s*#\s*include(?:_with_pragmas)?\s+"([^"]*)"', re.MULTILINE)
BUILT_IN_INCLUDE = re.compile(r"(Unity\w+|HLSLSupport|Lighting|AutoLight|TerrainEngine)\.(cginc|hlsl|glslinc)")


def path_faults(package: Package) -> Iterator[str]:
    """Paths that some system cannot hold, and files that no package should."""
    seen: dict[str, PurePosixPath] = {}
    for path in package.entries:
        if path.suffix == ".meta" and (package.root / path.with_suffix("")).exists():
            continue  # named by its asset
        where = package.where(path)
        if (package.root / path).is_symlink():
            yield f"{where}: a link, expected a file or folder of its own"
        if len(str(path)) > LONGEST_PATH:
            yield f"{where}: {len(str(path))} characters, expected at most {LONGEST_PATH}"
        if not NAMES.fullmatch(path.name) or path.name.endswith((".", " ")) or RESERVED.fullmatch(path.name):
            yield f"{where}: name {path.name!a}, expected letters, digits, blanks and ._~+-, and no device of Windows"
        other = seen.setdefault(str(path).lower(), path)
        if other != path:
            yield f"{where}: differs from {other} in case only"


def meta_faults(package: Package) -> Iterator[str]:
    """Every asset has its .meta file with the GUID of its place, and every .meta file has its asset."""
    entries, assets = set(package.entries), package.assets()
    for path in assets:
        meta = path.with_name(path.name + ".meta")
        if meta not in entries:
            yield f"{package.where(path)}: no .meta file, so that Unity ignores it in an installed package"
        else:
            yield from _meta(package, path, meta)
    for meta in package.entries:
        path = meta.with_suffix("")
        if meta.suffix != ".meta":
            continue
        if not needs_meta(path):
            yield f"{package.where(meta)}: a .meta file of what Unity does not import"
        elif path not in entries:
            yield f"{package.where(meta)}: a .meta file without its asset"
        elif path not in assets:
            yield f"{package.where(meta)}: a .meta file of an empty folder, which git does not keep"


def _meta(package: Package, path: PurePosixPath, meta: PurePosixPath) -> Iterator[str]:
    text, where = package.text(meta), package.where(meta)
    found = GUID.findall(text)
    if not text.startswith("fileFormatVersion: 2\n"):
        yield f'{where}: fileFormatVersion: not in line one, expected "fileFormatVersion: 2"'
    if len(found) != 1 or not re.fullmatch(r"[0-9a-f]{32}", found[0]) or not found[0].strip("0"):
        yield f'{where}: guid: "{" ".join(found)}", expected one of 32 hexadecimal digits, not all zero'
    elif found[0] != (wanted := stable_guid(package, path)):
        yield f'{where}: guid: "{found[0]}", expected "{wanted}", that of its place: run tools/gen_meta.py'
    if ("folderAsset: yes" in text) != package.is_folder(path):
        yield f"{where}: folderAsset: expected yes for a folder and none for a file"


def stable_guid(package: Package, path: PurePosixPath) -> str:
    """The GUID that an asset has for good: of its package's name and its path there."""
    owner = FOLDED.get(path.parts[0])
    if owner is None or len(path.parts) == 1 or owner == package.name:
        return gen_meta.guid(package.name, path.as_posix())
    return gen_meta.guid(owner, PurePosixPath(*path.parts[1:]).as_posix())


def guid_faults(packages: Sequence[Package]) -> Iterator[str]:
    """No GUID stands for two assets, in one package or in two."""
    first: dict[str, str] = {}
    for package in packages:
        for meta in package.entries:
            if meta.suffix != ".meta":
                continue
            for guid in GUID.findall(package.text(meta)):
                other = first.setdefault(guid, package.where(meta))
                if other != package.where(meta):
                    yield f'{package.where(meta)}: guid: "{guid}" is also that of {other}'


def reference_faults(packages: Sequence[Package]) -> Iterator[str]:
    """References of assets lead to files of these packages, with the number that Unity gives a file of that kind."""
    known = {guid: package.where(path) for package in packages for guid, path in package.guids.items()}
    for package in packages:
        for path in package.files(*YAML):
            for line, text in enumerate(package.text(path).splitlines(), start=1):
                found = REFERENCE.findall(text)
                where = f"{package.where(path)}:{line}: {text.split(':')[0].strip(' -')}"
                if text.count("guid:") != len(found):
                    yield f"{where}: {text.strip()!a}, expected references like {{fileID: 1, guid: ..., type: 3}}"
                for number, guid, _ in found:
                    target = known.get(guid)
                    wanted = FILE_ID.get(PurePosixPath(target).suffix) if target else None
                    if target is None and guid not in BUILT_IN:
                        yield f'{where}: guid "{guid}" is of no file here'
                    elif wanted is not None and number != wanted:
                        yield f"{where}: fileID {number}, expected {wanted} for {target}"


def include_faults(packages: Sequence[Package]) -> Iterator[str]:
    """Includes of shaders lead to files of these packages, or to those that come with the editor."""
    files = {f"Packages/{package.name}/{path}" for package in packages for path in package.files(*SHADERS)}
    for package in packages:
        for path in package.files(*SHADERS):
            for include in INCLUDE.findall(package.text(path)):
                if BUILT_IN_INCLUDE.fullmatch(include):
                    continue
                beside = f"Packages/{package.name}/{(path.parent / include).as_posix()}"
                if include not in files and beside not in files:
                    yield f'{package.where(path)}: include "{include}", expected a file of a package here'
                if include in files and include.split("/")[1] not in (
                    package.name,
                    *package.manifest.get("dependencies", {}),
                ):
                    yield f'{package.where(path)}: include "{include}", expected the package in dependencies'


def hidden_faults(package: Package) -> Iterator[str]:
    """Folders that end in ~ are those that Unity's layout has: another is a slip."""
    for path in package.entries:
        if path.name.endswith("~") and path.as_posix() not in HIDDEN:
            yield f"{package.where(path)}: hidden from Unity, expected only {', '.join(HIDDEN)}"
        if path.name.startswith(".") and is_imported(path.parent):
            yield f"{package.where(path)}: hidden from Unity, expected only what belongs to the package"
