"""Characters from .glb and .gltf files."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.rig.assemble import Surfaces, assemble
from mua.rig.gltf_animation import chain, compose, read_animations
from mua.rig.gltf_compression import decode_draco
from mua.rig.gltf_document import Document, load
from mua.rig.gltf_materials import Coordinates, read_materials
from mua.rig.scene import Part, Scene, Skin

DRACO = "KHR_draco_mesh_compression"
TRIANGLES, STRIP, FAN = 4, 5, 6


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
    tree = _tree(document)
    materials, coordinates = read_materials(document)
    skins, skin_nodes = _skins(document)
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
        elif skin >= skin_nodes:
            raise document.error(f"nodes[{node}].skin is {skin}, but skins holds {skin_nodes} entries")
        parts += _parts(document, node, skin=skin, bones=len(skins[skin].joints), coordinates=coordinates, notes=notes)
    return assemble(_scene(document, tree, skins, parts=parts, materials=materials, notes=notes), path)


def _scene(
    document: Document, tree: _Tree, skins: list[Skin], *, parts: list[Part], materials: Any, notes: list[str]
) -> Scene:
    """Keep the nodes that joints and their ancestors are, renumbered parents first, and sample the clips on them."""
    used = sorted({part.skin for part in parts})
    followed: set[int] = set()
    for skin in used:
        for node in skins[skin].joints:
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
        skins=tuple(
            Skin(np.array([index[int(node)] for node in skins[s].joints]), skins[s].inverse_binds, skins[s].rigid)
            for s in used
        ),
        parts=tuple(Part(**{**vars(part), "skin": used.index(part.skin)}) for part in parts),
        materials=materials,
        motions=motions,
        notes=(*notes, *left_out),
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


def _skins(document: Document) -> tuple[list[Skin], int]:
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
    return skins, len(skins)


def _parts(
    document: Document,
    node: int,
    *,
    skin: int,
    bones: int,
    coordinates: tuple[Coordinates, ...],
    notes: list[str],
) -> list[Part]:
    source = document.gltf.nodes[node]
    mesh = document.item("meshes", source.mesh, field=f"nodes[{node}].mesh")
    name = mesh.name or f"mesh{source.mesh}"
    parts = []
    for p, primitive in enumerate(mesh.primitives or []):
        where = f"meshes[{source.mesh}].primitives[{p}]"
        mode = TRIANGLES if primitive.mode is None else primitive.mode
        if mode not in (TRIANGLES, STRIP, FAN):
            notes.append(f"Mesh {name} holds points or lines, which are left out.")
            continue
        if primitive.targets:
            notes.append(f"The morph targets of mesh {name} are left out.")
        material = len(coordinates) - 1 if primitive.material is None else primitive.material
        if not 0 <= material < len(coordinates):
            raise document.error(f"{where}.material is {material}, but materials holds {len(coordinates) - 1} entries")
        geometry = _geometry(document, primitive, where)
        faces = _triangles(geometry["indices"], mode)
        rigid = source.skin is None
        joints, weights = _influences(document, geometry, where, bones=bones, rigid=rigid)
        uv = geometry.get(f"TEXCOORD_{coordinates[material].texcoord}")
        if uv is None:
            notes.append(f"Mesh {name} has no texture coordinates.")
        parts.append(
            Part(
                name=name,
                group=node,
                positions=geometry["POSITION"].astype(float),
                faces=faces,
                uv=np.zeros((0, 2)) if uv is None else coordinates[material].apply(uv.astype(float)),
                uv_faces=np.full_like(faces, -1) if uv is None else faces,
                material=material,
                skin=skin,
                joints=joints,
                weights=weights,
            )
        )
    return parts


def _geometry(document: Document, primitive: Any, where: str) -> dict[str, Array]:
    """Attributes [V, n] that matter here, and "indices" [I]; all of one length and in range."""
    wanted = {
        name: accessor
        for name, accessor in vars(primitive.attributes).items()
        if accessor is not None and name.split("_")[0] in ("POSITION", "TEXCOORD", "JOINTS", "WEIGHTS")
    }
    if "POSITION" not in wanted:
        raise document.error(f"{where}.attributes has no POSITION")
    draco = (primitive.extensions or {}).get(DRACO)
    packed = _draco(document, draco, where, wanted=wanted) if draco else {}
    geometry = dict(packed)
    for name, accessor in wanted.items():
        if name not in packed:
            types = {"POSITION": ("VEC3",), "TEXCOORD": ("VEC2",)}.get(name.split("_")[0], ("VEC4",))
            geometry[name] = document.accessor(accessor, field=f"{where}.attributes.{name}", types=types)
    count = len(geometry["POSITION"])
    for name in wanted:
        if len(geometry[name]) != count:
            raise document.error(f"{where}.attributes.{name} holds {len(geometry[name])} elements for {count} vertices")
    if "indices" not in geometry:
        if primitive.indices is None:
            geometry["indices"] = np.arange(count)
        else:
            field = f"{where}.indices"
            geometry["indices"] = document.accessor(primitive.indices, field=field, types=("SCALAR",))[:, 0].astype(int)
    if geometry["indices"].max(initial=-1) >= count:
        raise document.error(f"{where}.indices holds {geometry['indices'].max()}, but there are {count} vertices")
    return geometry


def _draco(document: Document, extension: dict[str, Any], where: str, *, wanted: dict[str, int]) -> dict[str, Array]:
    where = f"{where}.extensions.{DRACO}"
    content = document.view(extension.get("bufferView"), field=f"{where}.bufferView")
    ids = {name: unique for name, unique in (extension.get("attributes") or {}).items() if name in wanted}
    try:
        faces, attributes = decode_draco(content, ids)
    except ValueError as broken:
        raise document.error(f"{where} cannot be decoded: {broken}") from broken
    geometry = {"indices": faces.reshape(-1).astype(int)}
    for name, stored in attributes.items():
        accessor = document.item("accessors", wanted[name], field=f"{where}.attributes.{name}")
        geometry[name] = document.numbers(stored, f"{where}.attributes.{name}", normalized=bool(accessor.normalized))
    return geometry


def _triangles(indices: Array, mode: int) -> Array:
    """Triangles [F, 3] of an index list, a strip or a fan; an incomplete last one is dropped."""
    if mode == TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    count = max(len(indices) - 2, 0)
    steps = np.arange(count)
    if mode == FAN:
        return np.stack([indices[steps + 1], indices[steps + 2], np.repeat(indices[:1], count)], axis=1)
    odd = steps % 2
    return np.stack([indices[steps], indices[steps + 1 + odd], indices[steps + 2 - odd]], axis=1)


def _influences(
    document: Document, geometry: dict[str, Array], where: str, *, bones: int, rigid: bool
) -> tuple[Array, Array]:
    count = len(geometry["POSITION"])
    if rigid:
        return np.zeros((count, 1), int), np.ones((count, 1))
    sets = sorted(name for name in geometry if name.startswith("JOINTS_"))
    if not sets or any(name.replace("JOINTS", "WEIGHTS") not in geometry for name in sets):
        raise document.error(f"{where}.attributes of a skinned mesh lacks JOINTS_0 with WEIGHTS_0, expected both")
    joints = np.concatenate([geometry[name] for name in sets], axis=1).astype(int)
    weights = np.concatenate([geometry[name.replace("JOINTS", "WEIGHTS")] for name in sets], axis=1).astype(float)
    if weights.min() < 0:
        raise document.error(f"{where}.attributes.WEIGHTS holds {weights.min()}, expected no negative weight")
    beyond = (joints >= bones) & (weights > 0)
    if beyond.any():
        raise document.error(f"{where}.attributes.JOINTS holds {joints[beyond].max()}, but the skin has {bones} joints")
    return np.where(weights > 0, joints, 0), weights
