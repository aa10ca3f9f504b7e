"""One way in for characters of any file format."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypedDict, Unpack

from mua.atlas.character_surfaces import Surfaces
from mua.atlas.detail import Detail, UvMode
from mua.atlas.uv import build_atlas
from mua.characters.alpha import Alphas
from mua.characters.animation import Animation
from mua.characters.assemble import assemble
from mua.characters.facing import Facing
from mua.characters.fbx.read import read_fbx, read_fbx_animation
from mua.characters.figure_size import AS_FOUND, FigureSize
from mua.characters.formats import ANIMATIONS, FBX, GLTF, SKELETOOL, SKELETOOL_MOTION, USD, require_scene
from mua.characters.gltf.read import read_gltf, read_gltf_animation
from mua.characters.resize import resized
from mua.characters.skeletool.read import read_skeletool, read_skeletool_motion
from mua.rig.character import Character
from mua.scene import Scene


class Reading(TypedDict, total=False):
    """How a character's file is to be read, besides as it stands."""

    leave_out: Sequence[str]  # meshes, nodes or materials that are no part of the character
    alphas: Alphas  # how materials are transparent where the file is wrong
    facing: Facing
    expression_names: Mapping[str, str] | None  # what expressions are to be called
    smplx: Path | None  # the model of SMPL-X whose expressions the mesh gets


def read_surfaces(
    path: Path,
    *,
    size: FigureSize = AS_FOUND,
    **reading: Unpack[Reading],
) -> Surfaces:
    """Read a rigged character by its suffix.

    Raises an InputError where the suffix is unknown, the file is missing, holds no mesh on a skeleton, or nothing has
    such a name.
    """
    return resized(assemble(_scene(path), path, **reading), size, path)


def _scene(path: Path) -> Scene:
    suffix = require_scene(path)
    if suffix in GLTF:
        return read_gltf(path)
    if suffix == FBX:
        return read_fbx(path)
    if suffix == SKELETOOL:
        return read_skeletool(path)
    from mua.characters.usd.read import read_usd  # with USD's library, which takes long to load

    return read_usd(path)


def read_animation(path: Path) -> Animation:
    """Read a file's skeleton and clips by its suffix, with or without a mesh; raises as `read_surfaces` does."""
    suffix = require_scene(path, ANIMATIONS)
    if suffix == SKELETOOL_MOTION:
        return read_skeletool_motion(path)
    if suffix == FBX:
        return read_fbx_animation(path)
    if suffix not in USD:
        return read_gltf_animation(path)
    from mua.characters.usd.read import read_usd_animation

    return read_usd_animation(path)


def read_character(
    path: Path,
    uv: UvMode = "auto",
    *,
    atlas_size: int = 2048,
    detail: Detail | None = None,
    size: FigureSize = AS_FOUND,
    read: Callable[[Surfaces], None] = lambda surfaces: None,
    **reading: Unpack[Reading],
) -> Character:
    """Read a rigged, textured character and bring its materials into one atlas of `atlas_size` texels a side.

    `read` is called with what the file holds before that is laid out anew.
    """
    surfaces = read_surfaces(path, size=size, **reading)
    read(surfaces)
    return build_atlas(surfaces, uv=uv, size=atlas_size, detail=detail)
