"""The nodes of an FBX file: hierarchy, what is shown, which are bones."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.characters.fbx.bindings import get, items, matrix
from mua.characters.node_tree import Tree


@dataclass(frozen=True, eq=False)
class Nodes:
    """All nodes of a file but its root, whose place is part of those below it."""

    sources: list[Any]  # by node number
    names: list[str]
    tree: Tree
    local: Array  # [nodes, 4, 4] to the parent, of the topmost to the world
    bones: set[int]
    helpers: set[int]  # nodes that ufbx adds to hold a scale which children do not inherit
    details: set[int]  # lower levels of detail, with all below

    @property
    def root(self) -> Array:
        """The matrix [4, 4] from the file's axes and unit to Y up and metres."""
        return matrix(self.sources[0], "node_to_world")


def read_nodes(scene: Any) -> Nodes:
    """The nodes of a scene by ufbx, numbered as there; its root is number 0."""
    sources = list(items(scene, "nodes"))
    parents: dict[int, int] = {}
    for number, source in enumerate(sources):
        above = get(source, "parent")
        if above is not None and get(above, "typed_id"):
            parents[number] = int(get(above, "typed_id"))
    order = sorted(range(1, len(sources)), key=lambda number: get(sources[number], "node_depth"))
    root = matrix(sources[0], "node_to_world")
    local = np.array([matrix(source, "node_to_parent") for source in sources])
    tops = [number for number in order if number not in parents]
    local[tops] = root @ local[tops]
    world = np.array([matrix(source, "node_to_world") for source in sources])
    names = [str(get(source, "name")) for source in sources]
    bones = {number for number in order if get(sources[number], "bone") is not None}
    switched = {number for number in order if not get(sources[number], "visible") and number not in bones}
    tree = Tree(parents, order, set(order), _with_below(switched, parents, order), world)
    helpers = {number for number in order if get(sources[number], "is_scale_helper")}
    return Nodes(sources, names, tree, local, bones, helpers, _with_below(_lower_details(scene), parents, order))


def _lower_details(scene: Any) -> set[int]:
    """The children of groups of levels of detail, but for the first, which is the finest."""
    lower = set()
    for group in items(scene, "lod_groups"):
        for node in items(group, "instances"):
            lower |= {int(get(child, "typed_id")) for child in list(items(node, "children"))[1:]}
    return lower


def _with_below(nodes: set[int], parents: dict[int, int], order: list[int]) -> set[int]:
    found = set(nodes)
    for number in order:
        if parents.get(number) in found:
            found.add(number)
    return found
