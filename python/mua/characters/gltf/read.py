"""Characters from .glb, .gltf and .vrm files."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from mua.characters.animation import Animation, whole_animation
from mua.characters.gltf.animation import moved_nodes, read_animations
from mua.characters.gltf.document import Document, load
from mua.characters.gltf.materials import read_materials
from mua.characters.gltf.mesh import bounds, has_unweighted, is_quantised, read_parts
from mua.characters.gltf.nodes import below, local_matrix, node_name, read_tree
from mua.characters.gltf.vrm import Vrm, read_vrm
from mua.characters.holders import Holders
from mua.characters.messages import STILL, UNHELD, Messages
from mua.characters.node_tree import Tree, chain
from mua.scene import Part, Scene, Skin

INSTANCES = "EXT_mesh_gpu_instancing"
UNWEIGHTED = "Primitives without skin weights, which no joint moves, are left out, of meshes: {}."


def read_gltf(path: Path) -> Scene:
    """Read all skinned meshes of a .glb, .gltf or .vrm, with what hangs rigidly on their joints, and its clips.

    Where nothing is skinned, meshes on animated nodes are taken, each rigid on its node.
    Raises an InputError that names the field where the file is broken or needs an extension that is not read.
    """
    document = load(path)
    return _meshes(document, read_tree(document))


def read_gltf_animation(path: Path) -> Animation:
    """Read the skeleton and clips of a .glb or .gltf: those of its skinned meshes, else of its skins or moved nodes.

    Where the mesh is a part of the body alone, such as a face, that of all skins or moved nodes which names most limbs.
    Raises an InputError where `read_gltf` does, except that a mesh may be missing where there are joints.
    """
    return whole_animation(*gltf_scenes(path), path)


def gltf_scenes(path: Path) -> tuple[Scene, Iterator[Scene]]:
    """The scene of all meshes that hang on joints, and those of skeletons alone that clips move besides."""
    document = load(path)
    tree = read_tree(document)
    scene = _meshes(document, tree)
    joints = {int(node) for skin in _skins(document) for node in skin.joints}
    meshed = any(len(part.faces) for part in scene.parts)
    wholes = [_bare_skins(document, tree)] if joints or not meshed else []
    if meshed and not set(moved_nodes(document)) <= joints:
        wholes.append(_moved_tree(document, tree))
    vrm = read_vrm(document)
    return scene, (_scene(document, tree, skins, vrm=vrm) for skins in wholes)


def _meshes(document: Document, tree: Tree) -> Scene:
    """All that the file shows and that hangs on a joint, and a sentence on what is left out."""
    vrm = read_vrm(document)
    messages = Messages()
    materials, coordinates = read_materials(document, messages)
    skins = _skins(document)
    holders = Holders(
        tree,
        [*vrm.bones.values(), *(int(node) for skin in skins for node in skin.joints)],
        moved=moved_nodes(document),
        meshes={
            n: partial(bounds, document, n) for n, node in enumerate(document.gltf.nodes or []) if node.mesh is not None
        },
    )
    parts: list[Part] = []
    parts_of = partial(read_parts, document, coordinates=coordinates, messages=messages, vrm=vrm)
    for node in _drawn(document, tree, vrm, messages):
        skin = document.gltf.nodes[node].skin
        if skin is not None:
            document.item("skins", skin, field=f"nodes[{node}].skin")
            bones = len(skins[skin].joints)
            parts += parts_of(node, skin=skin, bones=bones)
            skins[skin] = replace(skins[skin], quantised=skins[skin].quantised or is_quantised(document, node))
        if skin is None or has_unweighted(document, node):
            holder = holders.of(node)
            if holder is None:
                messages.add(UNHELD if skin is None else UNWEIGHTED, node_name(document, node))
                continue
            skins.append(Skin(np.array([holder]), (np.linalg.inv(tree.world[holder]) @ tree.world[node])[None], True))
            own = len(skins) - 1
            parts += parts_of(node, skin=own, bones=None)
    if parts and not document.gltf.skins:
        messages.sharpen(UNHELD, STILL, beyond=len(parts))
    used = sorted({part.skin for part in parts})
    parts = [replace(part, skin=used.index(part.skin)) for part in parts]
    humanoid = _at_rest(tree, sorted(set(vrm.bones.values())))  # joints also where no mesh hangs on them
    kept = [skins[s] for s in used] + ([replace(humanoid, rigid=True)] if parts and vrm.bones else [])
    scene = _scene(document, tree, kept, vrm=vrm)
    return replace(scene, parts=tuple(parts), materials=materials, notes=(*vrm.notes, *messages.notes(), *scene.notes))


def _drawn(document: Document, tree: Tree, vrm: Vrm, messages: Messages) -> list[int]:
    """The nodes with a mesh that a viewer shows, parents first."""
    drawn = []
    for node in tree.order:
        source = document.gltf.nodes[node]
        if source.mesh is None:
            continue
        if node not in tree.shown:
            messages.add("Meshes of other scenes than the file's first are left out: {}.", node_name(document, node))
            continue
        if INSTANCES in (source.extensions or {}):
            messages.add("Instanced meshes are drawn once: {}.", node_name(document, node))
        flat = source.skin is None and abs(np.linalg.det(tree.world[node][:3, :3])) < np.finfo(np.float32).tiny
        if flat or node in tree.hidden or node in vrm.hidden_nodes or source.mesh in vrm.hidden_meshes:
            messages.add("Meshes that the file hides are left out: {}.", node_name(document, node))
            continue
        drawn.append(node)
    return drawn


def _bare_skins(document: Document, tree: Tree) -> list[Skin]:
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
    return _moved_tree(document, tree)


def _moved_tree(document: Document, tree: Tree) -> list[Skin]:
    """All nodes of the tree that clips move most, bound as they rest; no skin where no clip moves anything."""
    moved = Counter([*tree.upwards(node)][-1] for node in moved_nodes(document))
    if not moved:
        return []
    return [_at_rest(tree, below(document, [max(moved, key=lambda top: moved[top])]))]


def _at_rest(tree: Tree, nodes: list[int]) -> Skin:
    solid = [node for node in nodes if abs(np.linalg.det(tree.world[node][:3, :3])) >= np.finfo(np.float32).tiny]
    return Skin(np.array(solid, int), np.linalg.inv(tree.world[solid]))


def _scene(document: Document, tree: Tree, skins: list[Skin], *, vrm: Vrm) -> Scene:
    """Keep the nodes that joints and their ancestors are, renumbered parents first, and sample the clips on them."""
    nodes, parents = tree.followed(int(node) for skin in skins for node in skin.joints)
    index = {node: n for n, node in enumerate(nodes)}
    rest = np.array([local_matrix(document, node) for node in nodes]).reshape(-1, 4, 4)
    motions, left_out = read_animations(document, nodes, parents=parents, rest=rest, vrm=vrm)
    return Scene(
        name=document.path.stem,
        node_names=tuple(node_name(document, node) for node in nodes),
        parents=parents,
        rest=chain(rest, parents),
        skins=tuple(replace(skin, joints=np.array([index[int(node)] for node in skin.joints])) for skin in skins),
        parts=(),
        materials=(),
        motions=motions,
        notes=left_out,
        roles={index[node]: role for node, role in vrm.roles.items() if node in index},
        face_rules=vrm.face_rules(index),
    )


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
