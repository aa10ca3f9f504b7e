"""The node hierarchy of a scene file: parents, what the file shows, matrices at rest."""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array


@dataclass(frozen=True, eq=False)
class Tree:
    """The node hierarchy of a file."""

    parents: dict[int, int]  # child to parent
    order: list[int]  # nodes of the whole file, parents first
    shown: set[int]  # nodes of the scene that the file shows
    hidden: set[int]  # nodes of that scene which the file switches off, with all below
    world: Array  # [nodes, 4, 4] by the file's index

    def upwards(self, node: int) -> Iterator[int]:
        """The node, its parent, and so on to the top."""
        above: int | None = node
        while above is not None:
            yield above
            above = self.parents.get(above)

    def nearest(self, node: int, among: Collection[int]) -> int | None:
        """The node itself or its nearest ancestor that is one of `among`."""
        return next((above for above in self.upwards(node) if above in among), None)

    def common(self, nodes: Collection[int]) -> int | None:
        """The lowest node that is at or above all of `nodes`; None where they have none."""
        paths = [list(self.upwards(node))[::-1] for node in nodes]
        shared = None
        for level in zip(*paths, strict=False):
            if len(set(level)) > 1:
                break
            shared = level[0]
        return shared

    def followed(self, joints: Iterable[int]) -> tuple[list[int], Array]:
        """The joints and all nodes above them, parents first, and the parent [n] of each among them, -1 for none."""
        above = {node for joint in joints for node in self.upwards(int(joint))}
        nodes = [node for node in self.order if node in above]
        index = {node: n for n, node in enumerate(nodes)}
        parents = [index[self.parents[node]] if node in self.parents else -1 for node in nodes]
        return nodes, np.array(parents, np.int32)


def compose(translation: Array, quaternion: Array, scale: Array) -> Array:
    """Matrices [..., 4, 4] of a translation [..., 3], a rotation [..., 4] xyzw and a scale [..., 3]."""
    matrix = np.zeros((*translation.shape[:-1], 4, 4))
    matrix[..., :3, :3] = rotation.to_matrix(np.roll(quaternion, 1, axis=-1)) * scale[..., None, :]
    matrix[..., :3, 3] = translation
    matrix[..., 3, 3] = 1
    return matrix


def chain(local: Array, parents: Array) -> Array:
    """Node-to-world matrices of local ones [..., nodes, 4, 4], parents before children."""
    world = local.copy()
    for node, parent in enumerate(parents):
        if parent >= 0:
            world[..., node, :, :] = world[..., parent, :, :] @ local[..., node, :, :]
    return world
