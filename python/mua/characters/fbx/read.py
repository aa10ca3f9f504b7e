"""Characters and motion from .fbx files, by ufbx."""

from collections.abc import Sequence
from pathlib import Path

from mua.atlas.surfaces import Surfaces
from mua.characters.animation import Animation, whole_animation
from mua.characters.assemble import assemble
from mua.characters.facing import AS_SHOWN, Facing
from mua.characters.fbx.process import scenes_of


def read_fbx(path: Path, *, leave_out: Sequence[str] = (), facing: Facing = AS_SHOWN) -> Surfaces:
    """Read all skinned meshes of a file, with what hangs rigidly on their joints, and its animation stacks as clips.

    Where nothing is skinned, meshes on animated nodes are taken, each rigid on its node. `leave_out` names meshes,
    nodes or materials that are not part of the character.
    Raises an InputError where the file is broken or holds no mesh on a skeleton.
    """
    (scene,) = scenes_of(path, "skinned")
    return assemble(scene, path, leave_out=leave_out, facing=facing)


def read_fbx_animation(path: Path) -> Animation:
    """Read the skeleton and stacks of a file: of its meshes, its bones or its moved nodes, whichever has most limbs.

    Raises an InputError where `read_fbx` does, except that a mesh may be missing where there are joints.
    """
    meshed, *bare = scenes_of(path, "animation")
    return whole_animation(meshed, bare, path)
