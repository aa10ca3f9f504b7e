"""One way in for characters of any file format."""

from collections.abc import Sequence
from pathlib import Path

from mua.atlas.detail import Detail, UvMode
from mua.atlas.surfaces import Surfaces
from mua.atlas.uv import build_atlas
from mua.characters.animation import Animation
from mua.characters.facing import AS_SHOWN, Facing
from mua.characters.fbx.read import read_fbx, read_fbx_animation
from mua.characters.figure_size import AS_FOUND, FigureSize
from mua.characters.gltf.read import read_gltf, read_gltf_animation
from mua.characters.resize import resized
from mua.characters.skeletool.read import read_skeletool, read_skeletool_motion
from mua.errors import InputError
from mua.files.signature import refuse_foreign, require_kind
from mua.rig.character import Character

GLTF = (".glb", ".gltf", ".vrm")
GLTF_MOTION = (".vrma",)  # motion of a VRM avatar, without a mesh
FBX = ".fbx"
USD = (".usd", ".usda", ".usdc", ".usdz")
SKELETOOL, SKELETOOL_MOTION = ".character", ".motion"  # of DDC, ASH, TriHuman and UMA


def read_surfaces(
    path: Path, *, size: FigureSize = AS_FOUND, leave_out: Sequence[str] = (), facing: Facing = AS_SHOWN
) -> Surfaces:
    """Read a rigged character by its suffix, less the meshes, nodes or materials that `leave_out` names.

    Raises an InputError where the suffix is unknown, the file is missing or nothing has such a name.
    """
    suffix = _checked_suffix(path, (*GLTF, FBX, *USD, SKELETOOL))
    if suffix in GLTF:
        return resized(read_gltf(path, leave_out=leave_out, facing=facing), size, path)
    if suffix == FBX:
        return resized(read_fbx(path, leave_out=leave_out, facing=facing), size, path)
    if suffix == SKELETOOL:
        return resized(read_skeletool(path, leave_out=leave_out, facing=facing), size, path)
    from mua.characters.usd.read import read_usd  # with USD's library, which takes long to load

    return resized(read_usd(path, leave_out=leave_out, facing=facing), size, path)


def read_animation(path: Path) -> Animation:
    """Read a file's skeleton and clips by its suffix, with or without a mesh; raises as `read_surfaces` does."""
    suffix = _checked_suffix(path, (*GLTF, *GLTF_MOTION, FBX, *USD, SKELETOOL_MOTION))
    if suffix == SKELETOOL_MOTION:
        return read_skeletool_motion(path)
    if suffix == FBX:
        return read_fbx_animation(path)
    if suffix not in USD:
        return read_gltf_animation(path)
    from mua.characters.usd.read import read_usd_animation

    return read_usd_animation(path)


def _checked_suffix(path: Path, known: Sequence[str]) -> str:
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


def read_character(
    path: Path,
    uv: UvMode = "auto",
    *,
    atlas_size: int = 2048,
    detail: Detail | None = None,
    size: FigureSize = AS_FOUND,
    leave_out: Sequence[str] = (),
    facing: Facing = AS_SHOWN,
) -> Character:
    """Read a rigged, textured character and bring its materials into one atlas of `atlas_size` texels a side."""
    surfaces = read_surfaces(path, size=size, leave_out=leave_out, facing=facing)
    return build_atlas(surfaces, uv=uv, size=atlas_size, detail=detail)
