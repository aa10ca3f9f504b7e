"""Which node carries a mesh that has no skin: a joint, or a node that clips move as part of the character."""

from collections.abc import Callable, Collection, Mapping

import numpy as np

from mua.arrays import Array
from mua.characters.node_tree import Tree

NEAR = 0.5  # of the skeleton's size: a moved mesh this far around the joints is still part of the character


class Holders:
    """The nodes that rigid meshes of one file hang on."""

    def __init__(
        self,
        tree: Tree,
        joints: Collection[int],  # of all skins and humanoid bones, maybe none
        *,
        moved: Collection[int],  # nodes that clips move
        meshes: Mapping[int, Callable[[], Array]],  # by node that has a mesh, points [n, 3] that bound it in its space
    ) -> None:
        self._tree, self._meshes = tree, meshes
        self._joints = set(joints)
        self._moved = set(moved) & tree.shown
        self._box = _box(tree.world[sorted(self._joints)][:, :3, 3]) if self._joints else None
        top = tree.common(self._joints) if self._joints else None
        self._leads = set() if top is None else self._moved.intersection(tree.upwards(top))  # move all joints
        self._base = None if self._joints else self._base_of_rigid_parts()

    def of(self, node: int) -> int | None:
        """The node that carries the mesh of `node`, or None where it is no part of the character."""
        holder = self._tree.nearest(node, self._joints | self._moved)
        if holder is None:
            below_base = self._base is not None and self._base in self._tree.upwards(node)
            return self._base if below_base else None
        led = self._tree.nearest(holder, self._joints | self._leads) is not None
        return holder if led or self._is_near(node) else None

    def _base_of_rigid_parts(self) -> int | None:
        """The lowest node above all meshes that clips move, where nothing is skinned; still meshes below hang on it.

        Where a single part moves, it is the node above it; and always the highest node above that is itself a mesh:
        what hangs on a mesh is a part of it.
        """
        held = [node for node in self._tree.shown if node in self._meshes]
        found = {self._tree.nearest(node, self._moved) for node in held} - {None}
        moved = {int(node) for node in found if node is not None}
        base = self._tree.common(moved) if moved else None
        if base is None:
            return None
        if len(moved) == 1:
            base = self._tree.parents.get(base, base)
        return [base, *(node for node in self._tree.upwards(base) if node in self._meshes)][-1]

    def _is_near(self, node: int) -> bool:
        """Whether a mesh, by the bounds in its file, lies at the skeleton; always where there is none."""
        if self._box is None:
            return True
        world = self._tree.world[node]
        low, high = self._box
        reach = NEAR * float(np.max(high - low))
        own_low, own_high = _box(self._meshes[node]() @ world[:3, :3].T + world[:3, 3])
        small = np.max(own_high - own_low) <= np.max(high - low) + 2 * reach  # a sky or a floor is larger
        return bool(small and (own_low <= high + reach).all() and (own_high >= low - reach).all())


def _box(points: Array) -> tuple[Array, Array]:
    return points.min(axis=0), points.max(axis=0)
