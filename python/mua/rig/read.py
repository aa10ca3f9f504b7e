"""One way in for characters of any file format."""

from pathlib import Path
from typing import Literal

from mua.errors import InputError
from mua.rig.assemble import Surfaces
from mua.rig.character import Character
from mua.rig.gltf import read_gltf
from mua.rig.usd import read_usd
from mua.rig.uv import build_atlas

READERS = {".glb": read_gltf, ".gltf": read_gltf} | dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), read_usd)


def read_surfaces(path: Path) -> Surfaces:
    """Read a rigged character by its suffix; raises an InputError where that is unknown or the file is missing."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: the suffix is {path.suffix or 'missing'}, expected one of {', '.join(READERS)}")
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    return reader(path)


def read_character(path: Path, uv: Literal["keep", "unwrap", "auto"] = "auto", *, atlas_size: int = 2048) -> Character:
    """Read a rigged, textured character and bring its materials into one atlas of `atlas_size` texels a side."""
    return build_atlas(read_surfaces(path), uv=uv, size=atlas_size)
