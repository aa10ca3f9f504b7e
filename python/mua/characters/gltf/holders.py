"""Which node carries a mesh that has no skin: a joint, or a node that clips move as part of the character."""

from collections.abc import Sequence

import numpy as np

from mua.arrays import Array
from mua.characters.gltf.animation import moved_nodes
from mua.characters.gltf.document import Document
from mua.characters.gltf.nodes import Tree

NEAR = 0.5  # of the skeleton's size: a moved mesh this far around the joints is still part of the character


class Holders:
    """The nodes that rigid meshes of one file hang on."""

    def __init__(self, document: Document, tree: Tree, joints: Sequence[int]) -> None:
        """`joints` are the glTF nodes of all skins and humanoid bones, maybe none."""
        self._document, self._tree = document, tree
        self._joints = set(joints)
        self._moved = set(moved_nodes(document)) & tree.shown
        self._box = _box(tree.world[sorted(self._joints)][:, :3, 3]) if self._joints else None
        self._base = None if self._joints else self._base_of_rigid_parts()

    def of(self, node: int) -> int | None:
        """The node that carries the mesh of `node`, or None where it is no part of the character."""
        holder = self._tree.nearest(node, self._joints | self._moved)
        if holder is None:
            below_base = self._base is not None and self._base in self._tree.upwards(node)
            return self._base if below_base else None
        if self._tree.nearest(holder, self._joints) is None and not self._is_near(node):
            return None
        return holder

    def _base_of_rigid_parts(self) -> int | None:
        """The lowest node above all meshes that clips move, where nothing is skinned; still meshes below hang on it.

        Where a single part moves, it is the node above it; and always the highest node above that is itself a mesh:
        what hangs on a mesh is a part of it.
        """
        nodes = self._document.gltf.nodes or []
        held = [n for n in self._tree.shown if nodes[n].mesh is not None]
        found = {self._tree.nearest(n, self._moved) for n in held} - {None}
        moved = {int(n) for n in found if n is not None}
        base = self._tree.common(moved) if moved else None
        if base is None:
            return None
        if len(moved) == 1:
            base = self._tree.parents.get(base, base)
        return [base, *(n for n in self._tree.upwards(base) if nodes[n].mesh is not None)][-1]

    def _is_near(self, node: int) -> bool:
        """Whether a mesh, by the bounds in its file, lies at the skeleton; always where there is none."""
        if self._box is None:
            return True
        corners = self._corners(node)
        low, high = self._box
        reach = NEAR * float(np.max(high - low))
        own_low, own_high = _box(corners)
        small = np.max(own_high - own_low) <= np.max(high - low) + 2 * reach  # a sky or a floor is larger
        return bool(small and (own_low <= high + reach).all() and (own_high >= low - reach).all())

    def _corners(self, node: int) -> Array:
        """The bounds' corners [n, 3] of a node's mesh in the world at rest."""
        gltf = self._document.gltf
        mesh = self._document.item("meshes", gltf.nodes[node].mesh, field=f"nodes[{node}].mesh")
        points = [np.zeros((1, 3))]
        for primitive in mesh.primitives or []:
            index = primitive.attributes.POSITION if primitive.attributes else None
            accessor = self._document.item("accessors", index, field=f"nodes[{node}].mesh POSITION")
            if accessor.min and accessor.max:
                ends = np.array([accessor.min, accessor.max], float)
                points.append(np.stack(np.meshgrid(*ends.T), axis=-1).reshape(-1, 3))
        local = np.concatenate(points[1:] or points)
        world = self._tree.world[node]
        return local @ world[:3, :3].T + world[:3, 3]


def _box(points: Array) -> tuple[Array, Array]:
    return points.min(axis=0), points.max(axis=0)
