"""The bind pose of a scene: which nodes are joints and where each stands when the mesh is undeformed.

glTF and USD keep inverse bind matrices in the mesh's own space, whose place in the world no file states: it follows
from the rest pose where that equals the bind pose, and is estimated where it does not.
"""

import itertools
from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array
from mua.characters.rest_pose import plausible_rest
from mua.characters.skin_groups import alike, grouped
from mua.scene import Scene, Skin

ANIMATED = 1e-4  # change of a local matrix, relative to the character, below which a node counts as static
STRETCHED = 1e-3  # scale of a joint between bind and rest pose below which nothing is folded into the mesh
OFFSET_TRUST = 0.02  # of the character's size: how far a joint without weights may bind from its place at rest


@dataclass(frozen=True, eq=False)
class Bind:
    """Joints in parent-before-child order, with the matrices that the mesh was bound to."""

    nodes: Array  # [J] int nodes of the scene
    parents: Array  # [J] int32 into joints, -1 for none
    matrices: Array  # [J, 4, 4] joint to bind-pose world, any scale; metres
    stretch: Array  # [J, 3, 3] scale in bind-pose axes that the rest pose adds to the joint; folded into the mesh
    places: Array  # [J, 3] bind-pose positions with the stretch folded in, metres
    mass: Array  # [J] summed skin weights
    trusted: (
        Array  # [J] bool: weights or the hierarchy vouch for the joint's inverse bind; else only the rest pose does
    )


def bind_pose(scene: Scene) -> Bind:
    """Find the scene's joints and their bind pose."""
    nodes = _joint_nodes(scene)
    index = {int(node): j for j, node in enumerate(nodes)}
    parents = np.array([_kept_parent(scene, node, index) for node in nodes], np.int32)
    mass = np.zeros(len(nodes))
    for s, skin in enumerate(scene.skins):
        np.add.at(mass, [index[int(node)] for node in skin.joints], scene.masses(s))
    binds = _file_binds(scene, index)
    if binds is None:
        scene = replace(scene, rest=plausible_rest(scene, nodes))
        binds = _rest_binds(scene, index)
    matrices, trusted = _bind_matrices(scene, nodes, *binds, index=index, parents=parents)
    stretch = _stretch(scene.rest[nodes] @ np.linalg.inv(matrices))
    places = matrices[:, :3, 3].copy()
    for j, parent in enumerate(parents):
        if parent >= 0:
            offset = matrices[j, :3, 3] - matrices[parent, :3, 3]
            places[j] = places[parent] + stretch[parent] @ offset
    return Bind(nodes, parents, matrices, stretch, places, mass, trusted)


def rotations_of(matrices: Array) -> Array:
    """The rotations [..., 3, 3] nearest to the linear part of matrices [..., 4, 4]."""
    u, _, vt = np.linalg.svd(matrices[..., :3, :3])
    mirrored = np.linalg.det(u) * np.linalg.det(vt) < 0
    u[..., :, 2] = np.where(mirrored[..., None], -u[..., :, 2], u[..., :, 2])
    return u @ vt


def _joint_nodes(scene: Scene) -> Array:
    """Nodes of all skins, and those of their ancestors that a clip moves."""
    kept = {int(node) for skin in scene.skins for node in skin.joints}
    ancestors = {above for node in kept for above in scene.upwards(node)}
    return np.array(sorted(kept | {node for node in ancestors - kept if _is_animated(scene, node)}))


def _is_animated(scene: Scene, node: int) -> bool:
    parent = scene.parents[node]
    size = np.ptp(scene.rest[:, :3, 3], axis=0).max() + 1e-9
    for motion in scene.motions:
        local = motion.worlds[:, node]
        if parent >= 0:
            local = np.linalg.inv(motion.worlds[:, parent]) @ local
        change = np.abs(local - local[:1])
        if max(change[:, :3, :3].max(), change[:, :3, 3].max() / size) > ANIMATED:
            return True
    return False


def _kept_parent(scene: Scene, node: int, index: dict[int, int]) -> int:
    return next((index[above] for above in scene.upwards(int(scene.parents[node])) if above in index), -1)


def _bind_matrices(
    scene: Scene,
    nodes: Array,
    bound: dict[int, Array],
    proposed: dict[int, Array],
    *,
    index: dict[int, int],
    parents: Array,
) -> tuple[Array, Array]:
    """Joint-to-bind-world matrices [J, 4, 4] and which [J] of them are the file's own.

    Inverse binds of joints without weights are often left at the identity: such a joint takes the file's only where
    it agrees with the place that the rest pose gives it beside its neighbours. A joint that only carries rigid meshes
    stands beside its neighbours as in the rest pose, which is where the file puts those meshes.
    """
    carries = _rigid_holders(scene, index)
    size = np.ptp([matrix[:3, 3] for matrix in bound.values()], axis=0).max() if bound else 0.0
    trusted = np.array([j in bound or j in carries for j in range(len(nodes))])
    towards = _by_descendants(bound, parents)
    for j in [*sorted(towards, reverse=True), *range(len(nodes))]:  # first up from the bound joints, then down
        if j in bound:
            continue
        beside = towards.get(j, int(parents[j]))
        derived = scene.rest[nodes[j]]
        if beside >= 0:
            derived = bound[beside] @ np.linalg.inv(scene.rest[nodes[beside]]) @ derived
        own = proposed.get(j)
        if own is not None and np.linalg.norm(own[:3, 3] - derived[:3, 3]) <= OFFSET_TRUST * size:
            bound[j], trusted[j] = own, True
        else:
            bound[j] = derived
    return np.stack([bound[j] for j in range(len(nodes))]), trusted


def _rigid_holders(scene: Scene, index: dict[int, int]) -> set[int]:
    """The joints that meshes without weights hang on."""
    return {index[int(scene.skins[part.skin].joints[0])] for part in scene.parts if scene.skins[part.skin].rigid}


def _file_binds(scene: Scene, index: dict[int, int]) -> tuple[dict[int, Array], dict[int, Array]] | None:
    """Joint-to-bind-world matrices by the file's inverse binds: of joints with weights, and of those without.

    None where there are no skins, where skins that are bound apart from the rest pose do not say how they stand to
    one another, or where these are the smaller part of the character: the rest pose then serves as bind pose, in
    which the file itself puts all together.
    """
    bound: dict[int, Array] = {}
    proposed: dict[int, Array] = {}
    groups = grouped(scene)
    skinned = sum(float(mass.sum()) for _, mass in groups)
    if not groups:
        return None
    minor = 2 * skinned < sum(scene.masses(s).sum() for s in range(len(scene.skins)))
    for skin, mass in groups:
        space = _rest_space(scene, skin, mass=mass)
        beside = np.eye(4) if space is None or not bound else _moved_with(scene, skin, mass, bound, index)
        if (space is None and (bound or minor)) or beside is None:
            return None
        space = _upright_space(scene, skin, mass=mass, kept=index) if space is None else beside @ space
        for node, matrix, joint_mass in zip(skin.joints, space @ np.linalg.inv(skin.inverse_binds), mass, strict=True):
            (bound if joint_mass > 0 else proposed).setdefault(index[int(node)], matrix)
    return bound, proposed


def _rest_binds(scene: Scene, index: dict[int, int]) -> tuple[dict[int, Array], dict[int, Array]]:
    """Joints with weights bound where they stand at rest; those without have nothing to propose."""
    used = {int(node) for s, skin in enumerate(scene.skins) for node in skin.joints[scene.masses(s) > 0]}
    return {index[node]: scene.rest[node] for node in sorted(used)}, {}


def _by_descendants(bound: dict[int, Array], parents: Array) -> dict[int, int]:
    """For each joint above a bound one, the child towards it."""
    towards: dict[int, int] = {}
    for j in sorted(bound):
        parent = int(parents[j])
        while parent >= 0 and parent not in bound and parent not in towards:
            towards[parent] = j
            j, parent = parent, int(parents[parent])
    return towards


def _rest_space(
    scene: Scene,
    skin: Skin,
    *,
    mass: Array,  # [n]
) -> Array | None:
    """The mesh's space [4, 4] where it is bound in the rest pose: more than half of its weight agrees on one matrix."""
    spaces, used = _spaces(scene, skin, mass)
    mass = mass[used]
    scale = np.abs(np.linalg.det(spaces[:, :3, :3])) ** (1 / 3)
    size = np.ptp(scene.rest[skin.joints[used], :3, 3], axis=0).max() + 1e-9
    agreeing = alike(spaces, scale, size=size) @ mass
    return spaces[int(np.argmax(agreeing))] if agreeing.max() > 0.5 * mass.sum() else None


def _moved_with(scene: Scene, skin: Skin, mass: Array, bound: dict[int, Array], index: dict[int, int]) -> Array | None:
    """How far [4, 4] the nearest bound joint above a skin stands from its rest pose; None where none is bound above."""
    above = scene.upwards(int(skin.joints[int(np.argmax(mass))]))
    node = next((node for node in above if index.get(node) in bound), None)
    return None if node is None else bound[index[node]] @ np.linalg.inv(scene.rest[node])


def _spaces(scene: Scene, skin: Skin, mass: Array) -> tuple[Array, Array]:
    """The spaces [n, 4, 4] in which joints with weights put the mesh at rest, and these [n] among the skin's joints."""
    used = np.flatnonzero(mass)
    return scene.rest[skin.joints[used]] @ skin.inverse_binds[used], used


def _upright_space(
    scene: Scene,
    skin: Skin,
    *,
    mass: Array,  # [n]
    kept: dict[int, int],
) -> Array:
    """The mesh's space where rest and bind pose differ: the skeleton's own frame, turned by quarter turns only.

    Modelling tools bind in the skeleton's frame up to a change of axes and units; the joints' mean shows which.
    """
    spaces, used = _spaces(scene, skin, mass)
    scale = np.abs(np.linalg.det(spaces[:, :3, :3])) ** (1 / 3)
    top = [node for node in scene.upwards(int(skin.joints[used[0]])) if node in kept][-1]
    frame = int(scene.parents[top])
    frame_matrix = scene.rest[frame] if frame >= 0 else np.eye(4)
    frame_rotation = rotations_of(frame_matrix)
    mean = np.tensordot(mass[used] / scale, spaces[:, :3, :3], axes=1)
    quarters = [
        np.diag(signs) @ np.eye(3)[list(order)]
        for order in itertools.permutations(range(3))
        for signs in itertools.product((1.0, -1.0), repeat=3)
    ]
    rotation = max((frame_rotation @ quarter for quarter in quarters), key=lambda r: float(np.sum(r * mean)))
    space = np.eye(4)
    space[:3, :3] = np.median(scale) * rotation
    space[:3, 3] = frame_matrix[:3, 3]
    if skin.quantised:  # its origin says nothing: the topmost joint is where it is at rest
        first = int(np.argmin(skin.joints))
        space[:3, 3] += (scene.rest[skin.joints[first]] - space @ np.linalg.inv(skin.inverse_binds[first]))[:3, 3]
    return space


def _stretch(deformation: Array) -> Array:
    """The symmetric factors [J, 3, 3] of bind-to-rest matrices [J, 4, 4]; identity where they are rigid."""
    _, scales, vt = np.linalg.svd(deformation[:, :3, :3])
    stretch = np.swapaxes(vt, -1, -2) @ (scales[..., None] * vt)
    rigid = np.abs(scales - 1).max(axis=-1) < STRETCHED
    return np.where(rigid[:, None, None], np.eye(3), stretch)
