"""The node hierarchy of a glTF file: parents, what the scene shows, rest matrices."""

import numpy as np

from mua.arrays import Array
from mua.characters.gltf.document import Document
from mua.characters.node_tree import Tree, compose

VISIBILITY = "KHR_node_visibility"


def read_tree(document: Document) -> Tree:
    """The hierarchy of a file; an InputError names a node that is broken or is its own ancestor."""
    nodes = document.gltf.nodes or []
    parents: dict[int, int] = {}
    for n, node in enumerate(nodes):
        for child in node.children or []:
            document.item("nodes", child, field=f"nodes[{n}].children")
            if child in parents:
                raise document.error(f"nodes[{child}] is a child of both nodes[{parents[child]}] and nodes[{n}]")
            parents[child] = n
    order = below(document, [n for n in range(len(nodes)) if n not in parents])
    if len(order) < len(nodes):
        raise document.error(f"nodes[{min(set(range(len(nodes))) - set(order))}] is its own ancestor")
    world = np.zeros((len(nodes), 4, 4))
    for n in order:
        local = local_matrix(document, n)
        world[n] = world[parents[n]] @ local if n in parents else local
    shown = _shown(document, order)
    switched = [n for n in shown if ((nodes[n].extensions or {}).get(VISIBILITY) or {}).get("visible") is False]
    return Tree(parents, order, set(shown), set(below(document, switched)), world)


def _shown(document: Document, order: list[int]) -> list[int]:
    """The nodes of the file's default scene, or all where it has none."""
    if not document.gltf.scenes:
        return order
    scene = document.item("scenes", document.gltf.scene or 0, field="scene")
    for root in scene.nodes or []:
        document.item("nodes", root, field="scenes.nodes")
    return below(document, list(scene.nodes or []))


def below(document: Document, roots: list[int]) -> list[int]:
    """The nodes and all below them, parents first."""
    order = []
    waiting = roots[::-1]
    while waiting:
        node = waiting.pop()
        order.append(node)
        waiting += (document.gltf.nodes[node].children or [])[::-1]
    return order


def local_matrix(document: Document, node: int) -> Array:
    """A node's matrix [4, 4] at rest, relative to its parent."""
    source = document.gltf.nodes[node]
    fields = {"matrix": 16, "translation": 3, "rotation": 4, "scale": 3}
    for name, count in fields.items():
        value = getattr(source, name)
        if value and (len(value) != count or not all(isinstance(v, int | float) and np.isfinite(v) for v in value)):
            raise document.error(f"nodes[{node}].{name} is {value}, expected {count} finite numbers")
    if source.matrix:
        return np.array(source.matrix, float).reshape(4, 4).T
    quaternion = np.array(source.rotation or [0, 0, 0, 1], float)
    length = np.linalg.norm(quaternion)
    if length == 0:
        raise document.error(f"nodes[{node}].rotation is {source.rotation}, expected a unit quaternion")
    translation = np.array(source.translation or [0, 0, 0], float)
    return compose(translation, quaternion / length, np.array(source.scale or [1, 1, 1], float))


def node_name(document: Document, node: int) -> str:
    """A node's name, or its number where it has none."""
    return document.gltf.nodes[node].name or f"node{node}"
