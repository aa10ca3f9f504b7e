"""The source character in a pose: its own nodes, its own weights, linear blend skinning as file formats define it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.assemble import weighted
from mua.characters.rigid_skeleton import rest_pose
from mua.pose.clip import REST, Clip, Stretches
from mua.pose.descriptor import heading_of
from mua.pose.skeleton import Pose, Skeleton
from mua.scene import Part, Scene, Source

AGREED = 0.5  # share of the surface that must turn alike to have a heading of its own
ALIKE = 30.0  # degrees


@dataclass(frozen=True, eq=False)
class Moment:
    """One pose of the character's skeleton and of its source's nodes."""

    name: str
    pose: Pose
    nodes: Array  # [nodes, 4, 4] node to world, metres
    yaw: float  # turn of the body since the bind pose about +Y, radians
    stretches: Stretches | None = None  # stretches in this frame
    face: Mapping[str, float] | None = None  # expressions that move the meshes, and their weights


class Poser:
    """Brings poses of a character to the nodes of its source."""

    def __init__(self, source: Source, skeleton: Skeleton, expressions: Sequence[str] = ()) -> None:
        self._source, self._skeleton, self._expressions = source, skeleton, expressions
        self._rest = rest_pose(source, skeleton)
        self._to_bind = np.linalg.inv(self._carried(self._rest))
        self._holders = _holders(source)
        self._mass = _mass(source.scene, self._holders, len(skeleton.names))

    def rest(self) -> Moment:
        """The pose in which the file's nodes stand."""
        return Moment(REST, self._rest, self._source.scene.rest, self._yaw(self._rest))

    def of_clip(self, clip: Clip, frame: int) -> Moment:
        """A frame of a clip: the file's own nodes where the clip is from the file, else nodes moved by the joints."""
        pose = clip.pose(frame)
        own = [m for m in self._source.scene.motions if m.name == clip.name and len(m.worlds) == len(clip)]
        nodes = own[0].worlds[frame] if own and own[0].rate == clip.rate else self.by_joints(pose)
        stretches = clip.cut(slice(frame, frame + 1)).stretches
        return Moment(f"{clip.name}, frame {frame}", pose, nodes, self._yaw(pose), stretches, self._face(pose))

    def _face(self, pose: Pose) -> dict[str, float]:
        weights = () if pose.expressions is None else pose.expressions
        return {name: float(weight) for name, weight in zip(self._expressions, weights, strict=False) if weight}

    def by_joints(self, pose: Pose) -> Array:
        """The nodes [nodes, 4, 4] at rest, moved by what each joint does between rest and `pose`."""
        moves = self._carried(pose) @ self._to_bind
        nodes = self._source.scene.rest.copy()
        held = self._holders >= 0
        nodes[held] = moves[self._holders[held]] @ nodes[held]
        return nodes

    def _carried(self, pose: Pose) -> Array:
        """Matrices [J, 4, 4] that carry points of the bind pose to the posed world."""
        dual = self._skeleton.skinning(pose.rotations, pose.translations)
        matrices = np.tile(np.eye(4), (len(dual), 1, 1))
        matrices[:, :3, :3] = rotation.to_matrix(dual[:, :4])
        matrices[:, :3, 3] = rotation.dual_translation(dual)
        return matrices

    def _yaw(self, pose: Pose) -> float:
        """The turn of most of the surface; the root's turn where its parts do not agree."""
        dual = self._skeleton.skinning(pose.rotations, pose.translations)
        headings = heading_of(dual[:, :4])
        angles = 2 * np.arctan2(headings[:, 2], headings[:, 0])
        alike = np.cos(angles[:, None] - angles) > np.cos(np.radians(ALIKE))
        agreeing = alike @ self._mass
        most = int(np.argmax(agreeing))
        root = self._skeleton.root
        return float(angles[most if agreeing[most] > AGREED * self._mass.sum() else root])


def skinned(scene: Scene, part: Part, nodes: Array, face: Mapping[str, float] | None = None) -> Array:
    """A part's vertices [N, 3] in the world, for nodes [nodes, 4, 4]: the weighted mean of what each joint makes.

    Expressions of `face` move them first, each by its weight.
    """
    skin, positions = scene.skins[part.skin], expressed(part, face or {})
    spaces = nodes[skin.joints] @ skin.inverse_binds
    weights = weighted(part.weights)
    placed = np.zeros_like(positions)
    for k in np.flatnonzero(weights.any(axis=0)):
        space = spaces[part.joints[:, k]]
        moved = np.einsum("nij,nj->ni", space[:, :3, :3], positions) + space[:, :3, 3]
        placed += weights[:, k, None] * moved
    return placed


def expressed(part: Part, face: Mapping[str, float]) -> Array:
    """A part's vertices [N, 3] moved by expressions, each by its weight, before any joint moves them."""
    positions = part.positions.copy()
    for target in part.targets:
        if target.name in face:
            positions[target.vertices] += face[target.name] * target.offsets
    return positions


def dominant_joints(scene: Scene, part: Part) -> Array:
    """The node [N] that each of a part's vertices follows most."""
    heaviest = np.argmax(part.weights, axis=1)[:, None]
    return np.asarray(scene.skins[part.skin].joints[np.take_along_axis(part.joints, heaviest, axis=1)[:, 0]])


def _holders(source: Source) -> Array:
    """The joint [nodes] that each node is or hangs below, -1 for none."""
    holders = np.full(len(source.scene.parents), -1)
    holders[source.nodes] = np.arange(len(source.nodes))
    for node, parent in enumerate(source.scene.parents):
        if holders[node] < 0 and parent >= 0:
            holders[node] = holders[parent]
    return holders


def _mass(scene: Scene, holders: Array, joints: int) -> Array:
    """The weights [J] that each joint has in the surface."""
    mass = np.zeros(joints)
    for part in scene.parts:
        held = holders[scene.skins[part.skin].joints][part.joints]
        np.add.at(mass, held[held >= 0], weighted(part.weights)[held >= 0])
    return mass
