"""Characters from .glb and .gltf files."""

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.rig.animation import Animation, bare_animation
from mua.rig.assemble import Surfaces, assemble
from mua.rig.gltf_animation import chain, compose, moved_nodes, read_animations
from mua.rig.gltf_document import Document, load
from mua.rig.gltf_materials import read_materials
from mua.rig.gltf_mesh import read_parts
from mua.rig.scene import Part, Scene, Skin


@dataclass(frozen=True)
class _Tree:
    """The node hierarchy of a file."""

    parents: dict[int, int]  # child to parent
    order: list[int]  # nodes of the whole file, parents first
    shown: set[int]  # nodes of the scene that the file shows
    world: Array  # [nodes, 4, 4] by glTF index


def read_gltf(path: Path) -> Surfaces:
    """Read all skinned meshes of a .glb or .gltf, with what hangs rigidly on their joints, and its clips.

    Raises an InputError that names the field where the file is broken, needs an extension that is not read, or
    holds no skinned mesh.
    """
    document = load(path)
    return assemble(_meshes(document, _tree(document)), path)


def read_gltf_animation(path: Path) -> Animation:
    """Read the skeleton and clips of a .glb or .gltf: those of its skinned meshes, else of its skins or moved nodes.

    Raises an InputError where `read_gltf` does, except that a mesh may be missing where there are joints.
    """
    document = load(path)
    tree = _tree(document)
    scene = _meshes(document, tree)
    if any(len(part.faces) for part in scene.parts):
        rig = assemble(scene, path)
        return Animation(rig.skeleton, rig.clips, ())
    return bare_animation(_scene(document, tree, _bare_skins(document, tree)), path)


def _meshes(document: Document, tree: _Tree) -> Scene:
    materials, coordinates = read_materials(document)
    skins = _skins(document)
    joints = {int(node) for skin in skins for node in skin.joints}
    parts: list[Part] = []
    notes: list[str] = []
    for node in tree.order:
        if node not in tree.shown or document.gltf.nodes[node].mesh is None:
            continue
        skin = document.gltf.nodes[node].skin
        if skin is None:
            holder = _nearest(node, tree.parents, joints)
            if holder is None:
                notes.append(f"Mesh {_node_name(document, node)} hangs on no joint and is left out.")
                continue
            skins.append(Skin(np.array([holder]), (np.linalg.inv(tree.world[holder]) @ tree.world[node])[None], True))
            skin = len(skins) - 1
        else:
            document.item("skins", skin, field=f"nodes[{node}].skin")
        parts += read_parts(
            document, node, skin=skin, bones=len(skins[skin].joints), coordinates=coordinates, notes=notes
        )
    used = sorted({part.skin for part in parts})
    parts = [replace(part, skin=used.index(part.skin)) for part in parts]
    scene = _scene(document, tree, [skins[s] for s in used])
    return replace(scene, parts=tuple(parts), materials=materials, notes=(*notes, *scene.notes))


def _bare_skins(document: Document, tree: _Tree) -> list[Skin]:
    """The file's skins, bound in the rest pose where they do not say how; without any, the tree that clips move most.

    Nodes that the rest pose scales to nothing are no joints.
    """
    skins = _skins(document)
    found = [
        skin if source.inverseBindMatrices is not None else _at_rest(tree, skin.joints.tolist())
        for skin, source in zip(skins, document.gltf.skins or [], strict=True)
    ]
    if any(len(skin.joints) for skin in found):
        return [skin for skin in found if len(skin.joints)]
    moved = Counter(_top(node, tree.parents) for node in moved_nodes(document))
    if not moved:
        return []
    return [_at_rest(tree, _below(document, [max(moved, key=lambda top: moved[top])]))]


def _at_rest(tree: _Tree, nodes: list[int]) -> Skin:
    solid = [node for node in nodes if abs(np.linalg.det(tree.world[node][:3, :3])) >= np.finfo(np.float32).tiny]
    return Skin(np.array(solid, int), np.linalg.inv(tree.world[solid]))


def _top(node: int, parents: dict[int, int]) -> int:
    while node in parents:
        node = parents[node]
    return node


def _scene(document: Document, tree: _Tree, skins: list[Skin]) -> Scene:
    """Keep the nodes that joints and their ancestors are, renumbered parents first, and sample the clips on them."""
    followed: set[int] = set()
    for skin in skins:
        for node in skin.joints:
            while node is not None and int(node) not in followed:
                followed.add(int(node))
                node = tree.parents.get(int(node))
    nodes = [node for node in tree.order if node in followed]
    index = {node: n for n, node in enumerate(nodes)}
    parents = np.array([index[tree.parents[node]] if node in tree.parents else -1 for node in nodes], np.int32)
    rest = np.array([_local(document, node) for node in nodes]).reshape(-1, 4, 4)
    motions, left_out = read_animations(document, nodes, parents=parents, rest=rest)
    return Scene(
        name=document.path.stem,
        node_names=tuple(_node_name(document, node) for node in nodes),
        parents=parents,
        rest=chain(rest, parents),
        skins=tuple(replace(skin, joints=np.array([index[int(node)] for node in skin.joints])) for skin in skins),
        parts=(),
        materials=(),
        motions=motions,
        notes=left_out,
    )


def _tree(document: Document) -> _Tree:
    nodes = document.gltf.nodes or []
    parents: dict[int, int] = {}
    for n, node in enumerate(nodes):
        for child in node.children or []:
            document.item("nodes", child, field=f"nodes[{n}].children")
            if child in parents:
                raise document.error(f"nodes[{child}] is a child of both nodes[{parents[child]}] and nodes[{n}]")
            parents[child] = n
    order = _below(document, [n for n in range(len(nodes)) if n not in parents])
    if len(order) < len(nodes):
        raise document.error(f"nodes[{min(set(range(len(nodes))) - set(order))}] is its own ancestor")
    scenes = document.gltf.scenes or []
    shown = order
    if scenes:
        scene = document.item("scenes", document.gltf.scene or 0, field="scene")
        for root in scene.nodes or []:
            document.item("nodes", root, field="scenes.nodes")
        shown = _below(document, list(scene.nodes or []))
    world = np.zeros((len(nodes), 4, 4))
    for n in order:
        local = _local(document, n)
        world[n] = world[parents[n]] @ local if n in parents else local
    return _Tree(parents, order, set(shown), world)


def _below(document: Document, roots: list[int]) -> list[int]:
    """The nodes and all below them, parents first."""
    order = []
    waiting = roots[::-1]
    while waiting:
        node = waiting.pop()
        order.append(node)
        waiting += (document.gltf.nodes[node].children or [])[::-1]
    return order


def _local(document: Document, node: int) -> Array:
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


def _node_name(document: Document, node: int) -> str:
    return document.gltf.nodes[node].name or f"node{node}"


def _nearest(node: int, parents: dict[int, int], joints: set[int]) -> int | None:
    """The node itself or its nearest ancestor that is a joint."""
    above: int | None = node
    while above is not None and above not in joints:
        above = parents.get(above)
    return above


def _skins(document: Document) -> list[Skin]:
    skins = []
    for s, skin in enumerate(document.gltf.skins or []):
        joints = skin.joints or []
        for joint in joints:
            document.item("nodes", joint, field=f"skins[{s}].joints")
        binds = np.broadcast_to(np.eye(4), (len(joints), 4, 4))
        if skin.inverseBindMatrices is not None:
            field = f"skins[{s}].inverseBindMatrices"
            columns = document.accessor(skin.inverseBindMatrices, field=field, types=("MAT4",))
            if len(columns) < len(joints):
                raise document.error(f"{field} holds {len(columns)} matrices for {len(joints)} joints")
            binds = columns[: len(joints)].reshape(-1, 4, 4).swapaxes(1, 2)
            singular = np.abs(np.linalg.det(binds)) < np.finfo(np.float32).tiny
            if singular.any():
                raise document.error(f"{field}[{int(singular.argmax())}] cannot be inverted, expected a rigid matrix")
        skins.append(Skin(np.array(joints, int), binds))
    return skins
