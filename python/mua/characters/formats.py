"""Which files hold characters, by their names and first bytes; asked before anything is read."""

from collections.abc import Sequence
from pathlib import Path

from mua.errors import InputError
from mua.files.inputs import require_file
from mua.files.signature import refuse_foreign, require_kind

GLTF = (".glb", ".gltf", ".vrm")
GLTF_MOTION = (".vrma",)  # motion of a VRM avatar, without a mesh
FBX = ".fbx"
USD = (".usd", ".usda", ".usdc", ".usdz")
SKELETOOL, SKELETOOL_MOTION = ".character", ".motion"  # of DDC, ASH, TriHuman and UMA
CHARACTERS = (*GLTF, FBX, *USD, SKELETOOL)
ANIMATIONS = (*GLTF, *GLTF_MOTION, FBX, *USD, SKELETOOL_MOTION)


def characters_of(directory: Path) -> list[Path]:
    """The character files of a directory, by name; raises InputError where there are none."""
    found = sorted(file for file in directory.iterdir() if file.suffix.lower() in CHARACTERS)
    if not found:
        raise InputError(f"{directory}: expected files that end in {', '.join(CHARACTERS)}, found none")
    return found


def named_characters(paths: Sequence[Path]) -> list[Path]:
    """The files named, and those of directories named; raises InputError where one is not there."""
    found = []
    for path in paths:
        if path.is_dir():
            found += characters_of(path)
        else:
            require_file(path)
            found.append(path)
    return list(dict.fromkeys(found))


def require_scene(path: Path, known: Sequence[str] = CHARACTERS) -> str:
    """The suffix of a file that is there and seems to be what it says; raises InputError where it is another."""
    suffix = path.suffix.lower()
    if suffix not in known:
        refuse_foreign(path)
        raise InputError(f"{path}: the suffix is {path.suffix or 'missing'}, expected one of {', '.join(known)}")
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    if suffix in USD:
        kinds = ("a ZIP archive",) if suffix == ".usdz" else ("a USD file", "a ZIP archive")
        require_kind(path, "a USD stage", kinds=kinds)
    elif suffix == FBX:
        require_kind(path, "an FBX file", kinds=("an FBX file", "a text FBX file"))
    elif suffix in (*GLTF, *GLTF_MOTION):
        require_kind(path, "a glTF file", kinds=("a glTF binary", "JSON"))
    return suffix
