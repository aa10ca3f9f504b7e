"""Characters and motion from .fbx files, by ufbx."""

from pathlib import Path

from mua.characters.animation import Animation, whole_animation
from mua.characters.fbx.process import scenes_of
from mua.scene import Scene


def read_fbx(path: Path) -> Scene:
    """Read all skinned meshes of a file, with what hangs rigidly on their joints, and its animation stacks as clips.

    Where nothing is skinned, meshes on animated nodes are taken, each rigid on its node.
    Raises an InputError where the file is broken.
    """
    (scene,) = scenes_of(path, "skinned")
    return scene


def read_fbx_animation(path: Path) -> Animation:
    """Read the skeleton and stacks of a file: of its meshes, its bones or its moved nodes, whichever has most limbs.

    Raises an InputError where `read_fbx` does, except that a mesh may be missing where there are joints.
    """
    meshed, *bare = scenes_of(path, "animation")
    return whole_animation(meshed, bare, path)
