"""The skeleton and clips of a scene whether or not a mesh hangs on it, such as motion exported "without skin"."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.characters.assemble import assemble
from mua.characters.bind_pose import bind_pose
from mua.characters.collapsed import without_collapsed
from mua.characters.correction import corrected
from mua.characters.expressions import moved_expressions, with_weights
from mua.characters.joint_tree import is_hips
from mua.characters.rigid_skeleton import rigid_skeleton, roles_of
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.joint_names import limb_count
from mua.pose.skeleton import Skeleton
from mua.scene import Part, Scene, Skin

LIMBS = 8  # bones of arms and legs of a whole body, as `limb_count` counts them


@dataclass(frozen=True)
class Animation:
    """A skeleton, its clips, and a sentence for each thing that the reader changed or left out."""

    skeleton: Skeleton
    clips: tuple[Clip, ...]
    notes: tuple[str, ...]
    roles: Mapping[str, str] = field(default_factory=dict)  # joint to body part, where the file itself says it
    expressions: tuple[str, ...] = ()  # names of those that the clips hold weights of


def bare_animation(scene: Scene, path: Path) -> Animation:
    """The skeleton and clips of a scene without a mesh, in metres and facing +Z; its skins say which nodes are joints.

    Every joint of the body stands in for the mesh that it would carry, so that all else is as with a mesh.
    Raises an InputError that names `path` where no joint is left.
    """
    if not any(len(skin.joints) for skin in scene.skins):
        raise InputError(f"{path}: no skinned mesh, skeleton or animated nodes were found, expected motion")
    scene = without_collapsed(scene, path)
    scene = replace(scene, skins=tuple(_bound(scene, skin) for skin in scene.skins))
    carries = _body(scene)
    scene = replace(scene, parts=tuple(_stand_in(scene, skin, carries) for skin in range(len(scene.skins))))
    bind = bind_pose(scene)
    scene, change = corrected(scene, bind, points=bind.places[bind.mass > 0], stand=False)
    rigged = rigid_skeleton(scene, bind_pose(scene))
    notes = (*scene.notes, *change.size_notes, *change.notes, *rigged.notes)
    names = moved_expressions(scene.motions)
    clips = with_weights(rigged.clips, scene.motions, names)
    return Animation(rigged.skeleton, clips, notes, roles_of(scene, rigged), names)


def whole_animation(meshed: Scene, bare: Iterable[Scene], path: Path) -> Animation:
    """Of a file's skeleton as its mesh has it, and as scenes without a mesh have it, the one of a whole body.

    A mesh may be a part of the body alone, such as a face, while the clips move the whole: where its joints do not
    name all limbs, the skeleton that names most is taken, and of equal ones one with more than twice the joints.
    """
    found: Animation | None = None
    if any(len(part.faces) for part in meshed.parts):
        rig = assemble(meshed, path)
        names = moved_expressions(meshed.motions)
        found = Animation(rig.skeleton, with_weights(rig.clips, meshed.motions, names), (), rig.roles, names)
    for scene in bare:
        if found is None or limb_count(found.skeleton) < LIMBS:
            other = bare_animation(scene, path)
            found = other if found is None or _is_fuller(other.skeleton, found.skeleton) else found
    return found or bare_animation(meshed, path)


def _is_fuller(skeleton: Skeleton, than: Skeleton) -> bool:
    limbs, fewer = limb_count(skeleton), limb_count(than)
    return limbs > fewer or (limbs == fewer and len(skeleton.names) > 2 * len(than.names))


def _bound(scene: Scene, skin: Skin) -> Skin:
    """A skin of several joints whose matrices are all the identity, which say nothing, bound where it rests."""
    if len(skin.joints) > 1 and _is_identity(skin.inverse_binds).all():
        return replace(skin, inverse_binds=np.linalg.inv(scene.rest[skin.joints]))
    return skin


def _stand_in(scene: Scene, skin: int, carries: Array) -> Part:
    """A part without triangles, with one vertex for each joint of a skin that belongs to the body.

    Tools leave the matrices of joints that carry nothing at the identity; only one joint can truly be bound there.
    """
    source = scene.skins[skin]
    unbound = _is_identity(source.inverse_binds) & ~_is_identity(scene.rest[source.joints])
    joints = np.flatnonzero(carries[source.joints] & ~(unbound & (unbound.sum() > 1)))[:, None]
    return Part(
        name=scene.name,
        group=skin,
        positions=np.zeros((len(joints), 3)),
        faces=np.zeros((0, 3), int),
        uv=np.zeros((0, 2)),
        uv_faces=np.zeros((0, 3), int),
        material=0,
        skin=skin,
        joints=joints,
        weights=np.ones(joints.shape),
    )


def _is_identity(matrices: Array) -> Array:
    return np.asarray(np.isclose(matrices, np.eye(4)).all(axis=(1, 2)))


def _body(scene: Scene) -> Array:
    """Which nodes [nodes] a mesh could hang on: those at and below the hips, found by name, else where limbs begin."""
    below = np.zeros(len(scene.parents), int)
    below[np.unique(np.concatenate([skin.joints for skin in scene.skins]))] = 1
    joints = int(below.sum())
    for node in range(len(below) - 1, -1, -1):
        if scene.parents[node] >= 0:
            below[scene.parents[node]] += below[node]
    most = np.flatnonzero(2 * below >= joints)
    branches = np.bincount(scene.parents[(scene.parents >= 0) & (below > 0)], minlength=len(below))
    hips = [node for node in most if is_hips(scene.node_names[node])]
    limbs = [node for node in most if branches[node] > 1]
    body = np.zeros(len(below), bool)
    body[[*hips, *limbs, *most][:1]] = True
    for node, parent in enumerate(scene.parents):
        body[node] |= parent >= 0 and body[parent]
    return body if body.any() else below > 0
