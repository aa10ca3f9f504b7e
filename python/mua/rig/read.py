"""One way in for characters of any file format."""

from pathlib import Path

from mua.errors import InputError
from mua.rig.animation import Animation
from mua.rig.assemble import Surfaces
from mua.rig.character import Character
from mua.rig.detail import Detail
from mua.rig.gltf import read_gltf, read_gltf_animation
from mua.rig.usd import read_usd, read_usd_animation
from mua.rig.uv import UvMode, build_atlas

GLTF = (".glb", ".gltf")
USD = (".usd", ".usda", ".usdc", ".usdz")


def read_surfaces(path: Path) -> Surfaces:
    """Read a rigged character by its suffix; raises an InputError where that is unknown or the file is missing."""
    return read_gltf(path) if _checked_suffix(path) in GLTF else read_usd(path)


def read_animation(path: Path) -> Animation:
    """Read a file's skeleton and clips by its suffix, with or without a mesh; raises as `read_surfaces` does."""
    return read_gltf_animation(path) if _checked_suffix(path) in GLTF else read_usd_animation(path)


def _checked_suffix(path: Path) -> str:
    suffix = path.suffix.lower()
    known = (*GLTF, *USD)
    if suffix not in known:
        raise InputError(f"{path}: the suffix is {path.suffix or 'missing'}, expected one of {', '.join(known)}")
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    return suffix


def read_character(
    path: Path, uv: UvMode = "auto", *, atlas_size: int = 2048, detail: Detail | None = None
) -> Character:
    """Read a rigged, textured character and bring its materials into one atlas of `atlas_size` texels a side."""
    return build_atlas(read_surfaces(path), uv=uv, size=atlas_size, detail=detail)
