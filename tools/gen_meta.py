"""Write the .meta file of every asset of the UPM packages in this repository; --check says whether all are right.

A package that Unity installs from git or a tarball is immutable: an asset without a .meta file is ignored there. GUIDs
are the md5 of "package name:path in the package", so that they never change while a file keeps its place.
"""

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = (ROOT / "ComputeShaders", ROOT / "unity-package")

# The blank after a colon is Unity's own: a file that it would write itself is left as it is.
TAIL = "  userData: \n  assetBundleName: \n  assetBundleVariant: \n"
PLAIN = "  externalObjects: {}\n"
SCRIPT = "  serializedVersion: 2\n  defaultReferences: []\n  executionOrder: 0\n  icon: {instanceID: 0}\n"
NATIVE = "  mainObjectFileID: 11400000\n"
IMPORTERS = {
    "package.json": ("PackageManifestImporter", PLAIN),
    ".asmdef": ("AssemblyDefinitionImporter", PLAIN),
    ".asset": ("NativeFormatImporter", PLAIN + NATIVE),
    ".compute": ("ComputeShaderImporter", PLAIN),
    ".cs": ("MonoImporter", PLAIN + SCRIPT),
    ".hlsl": ("ShaderIncludeImporter", PLAIN),
    ".json": ("TextScriptImporter", PLAIN),
    ".mat": ("NativeFormatImporter", PLAIN + NATIVE.replace("11400000", "2100000")),
    ".md": ("TextScriptImporter", PLAIN),
    ".prefab": ("PrefabImporter", PLAIN),
    ".shader": ("ShaderImporter", PLAIN + "  defaultTextures: []\n  nonModifiableTextures: []\n"),
    ".txt": ("TextScriptImporter", PLAIN),
    ".unity": ("DefaultImporter", PLAIN),
}


def assets(folder: Path) -> Iterator[Path]:
    """Every file and folder below a package's folder that Unity imports, and what it copies out of Samples~."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith(".") or path.suffix == ".meta":
            continue
        hidden = path.name.endswith("~")
        if hidden and path.name != "Samples~":
            continue
        below = list(assets(path)) if path.is_dir() else []
        if not hidden and (path.is_file() or below):  # git keeps no empty folder
            yield path
        yield from below


def guid(package: str, path: str) -> str:
    """The GUID of `path`, relative to the package of that name."""
    return hashlib.md5(f"{package}:{path}".encode()).hexdigest()


def meta(package: str, path: str, *, folder: bool) -> str:
    """Text of the .meta file of `path`, relative to the package; a type not listed gets Unity's default importer."""
    name = Path(path).name
    importer, settings = IMPORTERS.get(name) or IMPORTERS.get(Path(path).suffix) or ("DefaultImporter", PLAIN)
    if folder:
        importer, settings = "DefaultImporter", PLAIN
    kind = "folderAsset: yes\n" if folder else ""
    return f"fileFormatVersion: 2\nguid: {guid(package, path)}\n{kind}{importer}:\n{settings}{TAIL}"


def expected(folder: Path) -> dict[Path, str]:
    """Path and text of every .meta file that a package should hold."""
    name = json.loads((folder / "package.json").read_text())["name"]
    return {
        path.with_name(path.name + ".meta"): meta(name, path.relative_to(folder).as_posix(), folder=path.is_dir())
        for path in assets(folder)
    }


def faults(folder: Path) -> list[str]:
    """One line for each .meta file of a package that is missing, wrong or without its asset."""
    wanted = expected(folder)
    wrong = [path for path, text in wanted.items() if not path.is_file() or path.read_text() != text]
    orphans = [path for path in folder.rglob("*.meta") if path not in wanted]
    return [f"{path.relative_to(folder)} is missing or wrong" for path in wrong] + [
        f"{path.relative_to(folder)} has no asset" for path in orphans
    ]


def write(folder: Path) -> None:
    """Write what `expected` says and remove .meta files without an asset."""
    wanted = expected(folder)
    for path in folder.rglob("*.meta"):
        if path not in wanted:
            path.unlink()
    for path, text in wanted.items():
        path.write_text(text)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="exit 1 where a committed file differs")
    check = parser.parse_args().check
    for folder in PACKAGES:
        if not (folder / "package.json").is_file():
            continue
        if not check:
            write(folder)
        elif found := faults(folder):
            sys.exit("\n".join([*found, "run tools/gen_meta.py"]))


if __name__ == "__main__":
    main()
