"""Triangles, texture coordinates and weights of glTF meshes."""

from typing import Any

import numpy as np

from mua.arrays import Array
from mua.characters.gltf.compression import decode_draco
from mua.characters.gltf.document import COMPONENT_TYPES, Document
from mua.characters.gltf.materials import Coordinates
from mua.characters.gltf.morphs import Morphs
from mua.characters.gltf.nodes import node_name
from mua.characters.gltf.vrm import NO_VRM, Vrm
from mua.characters.messages import Messages
from mua.scene import Part

DRACO = "KHR_draco_mesh_compression"
TRIANGLES, STRIP, FAN = 4, 5, 6
FLOAT = 5126  # component type of an accessor
ROUNDED = 1e-3  # weight below zero that a program wrote for none
TYPES = {"POSITION": ("VEC3",), "TEXCOORD": ("VEC2",), "COLOR": ("VEC3", "VEC4")}


def has_unweighted(document: Document, node: int) -> bool:
    """Whether the mesh of a skinned node has primitives without skin weights: they follow the node, as rigid ones."""
    mesh = document.item("meshes", document.gltf.nodes[node].mesh, field=f"nodes[{node}].mesh")
    return not all(_is_weighted(primitive) for primitive in mesh.primitives or [])


def is_quantised(document: Document, node: int) -> bool:
    """Whether the mesh of a node has positions in whole numbers, which are scaled and moved to fit (gltfpack)."""
    mesh = document.gltf.meshes[document.gltf.nodes[node].mesh]
    indices = [primitive.attributes.POSITION for primitive in mesh.primitives or [] if primitive.attributes]
    accessors = [document.item("accessors", index, field="POSITION") for index in indices if index is not None]
    return any(accessor.componentType != FLOAT for accessor in accessors)


def bounds(document: Document, node: int) -> Array:
    """The corners [n, 3] of the boxes that the file states around a node's mesh, in the mesh's own space."""
    mesh = document.item("meshes", document.gltf.nodes[node].mesh, field=f"nodes[{node}].mesh")
    points = [np.zeros((1, 3))]
    for primitive in mesh.primitives or []:
        index = primitive.attributes.POSITION if primitive.attributes else None
        accessor = document.item("accessors", index, field=f"nodes[{node}].mesh POSITION")
        if accessor.min and accessor.max:
            ends = np.array([accessor.min, accessor.max], float)
            points.append(np.stack(np.meshgrid(*ends.T), axis=-1).reshape(-1, 3))
    return np.concatenate(points[1:] or points)


def _is_weighted(primitive: Any) -> bool:
    names = () if primitive.attributes is None else vars(primitive.attributes)
    return any(name.startswith(("JOINTS_", "WEIGHTS_")) for name in names)


def read_parts(
    document: Document,
    node: int,
    *,
    skin: int,
    bones: int | None,
    coordinates: tuple[Coordinates, ...],
    messages: Messages,
    vrm: Vrm = NO_VRM,
) -> list[Part]:
    """The primitives of a node's mesh, on a skin of `bones` joints; what is left out goes to `messages`.

    With None for `bones`, the primitives that are rigid: those without weights on a node with a skin, else all.
    """
    source = document.gltf.nodes[node]
    mesh = document.item("meshes", source.mesh, field=f"nodes[{node}].mesh")
    name = mesh.name or f"mesh{source.mesh}"
    morphs = Morphs(document, node, vrm)
    parts = []
    for p, primitive in enumerate(mesh.primitives or []):
        where = f"meshes[{source.mesh}].primitives[{p}]"
        if source.skin is not None and _is_weighted(primitive) == (bones is None):
            continue
        mode = TRIANGLES if primitive.mode is None else primitive.mode
        if mode not in (TRIANGLES, STRIP, FAN):
            messages.add("Points and lines are left out, of meshes: {}.", name)
            continue
        material = len(coordinates) - 1 if primitive.material is None else primitive.material
        if not 0 <= material < len(coordinates):
            raise document.error(f"{where}.material is {material}, but materials holds {len(coordinates) - 1} entries")
        if primitive.indices is not None:
            indices = document.item("accessors", primitive.indices, field=f"{where}.indices")
            if indices.count == 0:  # a material that no triangle has any more
                continue
        geometry = _geometry(document, primitive, where)
        faces = _triangles(geometry["indices"], mode)
        joints, weights = _influences(document, geometry, where, bones=bones)
        uv = geometry.get(f"TEXCOORD_{coordinates[material].texcoord}")
        if uv is None and coordinates[material].needed:
            messages.add("Meshes without the texture coordinates that their material asks for: {}.", name)
        positions = geometry["POSITION"].astype(float)
        positions, targets = morphs.applied(primitive, positions, where, messages)
        parts.append(
            Part(
                name=name,
                group=node,
                positions=positions,
                faces=faces,
                uv=np.zeros((0, 2)) if uv is None else coordinates[material].apply(uv.astype(float)),
                uv_faces=np.full_like(faces, -1) if uv is None else faces,
                material=material,
                skin=skin,
                joints=joints,
                weights=weights,
                node=node_name(document, node),
                colors=_colors(geometry, faces, coordinates[material]),
                targets=targets,
            )
        )
    return parts


def _colors(geometry: dict[str, Array], faces: Array, reads: Coordinates) -> Array | None:
    """Linear colours and opacity [F, 3, 4] of the triangles' corners; None where there are none but white."""
    colors = geometry.get("COLOR_0")
    if colors is None or not reads.vertex_colors:
        return None
    if colors.dtype.kind in "iu":  # stored without the flag that says so, which the format asks for
        colors = colors / np.iinfo(colors.dtype).max
    rgba = np.ones((len(colors), 4))
    rgba[:, : colors.shape[1]] = np.clip(colors, 0, 1)
    return None if (rgba == 1).all() else rgba[faces]


def _geometry(document: Document, primitive: Any, where: str) -> dict[str, Array]:
    """Attributes [V, n] that matter here, and "indices" [I]; all of one length and in range."""
    if primitive.attributes is None:
        raise document.error(f"{where} has no attributes")
    wanted = {
        name: accessor
        for name, accessor in vars(primitive.attributes).items()
        if accessor is not None
        and (name.split("_")[0] in ("POSITION", "TEXCOORD", "JOINTS", "WEIGHTS") or name == "COLOR_0")
    }
    if "POSITION" not in wanted:
        raise document.error(f"{where}.attributes has no POSITION")
    draco = (primitive.extensions or {}).get(DRACO)
    packed = _draco(document, draco, where, wanted=wanted) if draco else {}
    geometry = dict(packed)
    for name, accessor in wanted.items():
        if name not in packed:
            types = TYPES.get(name.split("_")[0], ("VEC4",))
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
        kind = COMPONENT_TYPES.get(accessor.componentType)
        if kind is not None and stored.dtype.kind in "iu":  # Draco may hold wider numbers, of which 1 is another
            stored = stored.astype(kind)
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
    document: Document, geometry: dict[str, Array], where: str, *, bones: int | None
) -> tuple[Array, Array]:
    count = len(geometry["POSITION"])
    if bones is None:
        return np.zeros((count, 1), int), np.ones((count, 1))
    sets = sorted(name for name in geometry if name.startswith("JOINTS_"))
    if not sets or any(name.replace("JOINTS", "WEIGHTS") not in geometry for name in sets):
        raise document.error(f"{where}.attributes of a skinned mesh lacks JOINTS_0 with WEIGHTS_0, expected both")
    joints = np.concatenate([geometry[name] for name in sets], axis=1).astype(int)
    weights = np.concatenate([geometry[name.replace("JOINTS", "WEIGHTS")] for name in sets], axis=1).astype(float)
    if weights.min() < -ROUNDED:
        raise document.error(f"{where}.attributes.WEIGHTS holds {weights.min()}, expected no negative weight")
    beyond = (joints >= bones) & (weights > 0)
    if beyond.any():
        raise document.error(f"{where}.attributes.JOINTS holds {joints[beyond].max()}, but the skin has {bones} joints")
    return np.where(weights > 0, joints, 0), np.maximum(weights, 0)
