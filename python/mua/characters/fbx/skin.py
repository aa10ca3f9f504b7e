"""Joints and weights of FBX meshes: the clusters of a skin deformer, or the node that a rigid mesh hangs on."""

from typing import Any

import numpy as np
import ufbx

from mua.arrays import Array
from mua.characters.fbx.bindings import array, get, items, matrix
from mua.characters.fbx.mesh import Geometry
from mua.characters.fbx.nodes import Nodes
from mua.characters.messages import Messages
from mua.errors import InputError
from mua.scene import Skin

STRAY = "Weights of vertices that the mesh does not have are left out, of meshes: {}."
MOST_STRAY = 0.1  # share of such weights; with more, another mesh was skinned
LINEAR = (int(ufbx.SkinningMethod.LINEAR), int(ufbx.SkinningMethod.RIGID))


def bones_of(mesh: Any, nodes: Nodes) -> list[tuple[Any, int]]:
    """The clusters of a mesh that name a bone, each with its node; those of several skin deformers act as of one."""
    found = []
    for deformer in items(mesh, "skin_deformers"):
        for cluster in items(deformer, "clusters"):
            if get(cluster, "bone_node") is not None:
                found.append((cluster, _scaled(cluster, nodes)))
    return found


def _scaled(cluster: Any, nodes: Nodes) -> int:
    """The node of a cluster's bone: the one beside it that holds its scale, where ufbx made one for that."""
    bone = get(cluster, "bone_node")
    helper = get(bone, "scale_helper")
    return int(get(bone if helper is None else helper, "typed_id"))


def read_skin(geometry: Geometry, node: int, nodes: Nodes, messages: Messages) -> tuple[Skin, Array, Array]:
    """The skin of a node's mesh, and for each vertex joints [V, K] of the skin with their weights [V, K].

    Vertices without weights hang rigidly on the joint above the node, else on the topmost one. Raises InputError where
    matrices or weights do not fit.
    """
    clusters = sorted(bones_of(geometry.source, nodes), key=lambda pair: nodes.tree.order.index(pair[1]))
    binds = np.array([matrix(cluster, "geometry_to_bone") for cluster, _ in clusters])
    singular = ~np.isfinite(binds).all(axis=(1, 2)) | (np.abs(np.linalg.det(binds)) < np.finfo(np.float32).tiny)
    if singular.any():
        name = nodes.names[clusters[int(singular.argmax())][1]]
        raise InputError(f"{geometry.where}: the cluster of {name} has a bind matrix that cannot be inverted")
    _note_method(geometry, messages)
    influences = [_influences(cluster, j, geometry) for j, (cluster, _) in enumerate(clusters)]
    kept = _without_strays(np.concatenate(influences), clusters, geometry, messages)
    joints, weights = _by_vertex(kept, len(geometry.positions))
    bones = [bone for _, bone in clusters]
    bare = ~weights.any(axis=1)
    if bare.any():
        messages.add("Vertices without weights are attached rigidly to a joint, of meshes: {}.", geometry.name)
        rigid = rigid_skin(node, nodes.tree.nearest(node, bones) or bones[0], nodes)
        joints[bare, 0], weights[bare, 0] = len(bones), 1
        bones, binds = [*bones, int(rigid.joints[0])], np.concatenate([binds, rigid.inverse_binds])
    return Skin(np.array(bones), binds), joints, weights


def rigid_skin(node: int, holder: int, nodes: Nodes) -> Skin:
    """The skin of a mesh that hangs on one node, as it does at rest."""
    placed = nodes.tree.world[node] @ matrix(nodes.sources[node], "geometry_to_node")
    return Skin(np.array([holder]), (np.linalg.inv(nodes.tree.world[holder]) @ placed)[None], rigid=True)


def _note_method(geometry: Geometry, messages: Messages) -> None:
    methods = {int(get(deformer, "skinning_method")) for deformer in items(geometry.source, "skin_deformers")}
    if not methods <= set(LINEAR):
        messages.add("Meshes skinned by dual quaternions are skinned linearly, as avatars are: {}.", geometry.name)


def _influences(cluster: Any, joint: int, geometry: Geometry) -> Array:
    """Rows [n, 3] of vertex, joint and weight."""
    vertices, weights = array(cluster, "vertices").ravel(), array(cluster, "weights").ravel()
    where = f"{geometry.where}: the cluster of {get(cluster, 'bone_node.name')}"
    if len(vertices) != len(weights) or not np.isfinite(weights).all():
        raise InputError(f"{where} has {len(weights)} weights for {len(vertices)} vertices, expected a finite one each")
    return np.stack([vertices, np.full(len(vertices), joint), weights], axis=1)[weights > 0]


def _without_strays(
    influences: Array, clusters: list[tuple[Any, int]], geometry: Geometry, messages: Messages
) -> Array:
    """Rows [n, 3] as `_influences` has them, of vertices that are there: cutting a mesh up leaves others behind."""
    count = len(geometry.positions)
    strays = influences[influences[:, 0] >= count]
    if len(strays) > MOST_STRAY * len(influences):
        vertex, joint = strays[strays[:, 0].argmax(), :2].astype(int)
        where = f"{geometry.where}: the cluster of {get(clusters[joint][0], 'bone_node.name')}"
        raise InputError(f"{where} has weights for vertex {vertex}, of {count} vertices")
    if len(strays):
        messages.add(STRAY, geometry.name)
    return influences[influences[:, 0] < count]


def _by_vertex(influences: Array, count: int) -> tuple[Array, Array]:
    """Joints [V, K] and weights [V, K] of rows [n, 3] of vertex, joint and weight."""
    influences = influences[np.argsort(influences[:, 0], kind="stable")]
    vertices = influences[:, 0].astype(int)
    per_vertex = np.bincount(vertices, minlength=count)
    slots = np.arange(len(vertices)) - np.repeat(np.cumsum(per_vertex) - per_vertex, per_vertex)
    joints = np.zeros((count, max(1, int(per_vertex.max(initial=0)))), int)
    weights = np.zeros(joints.shape)
    joints[vertices, slots], weights[vertices, slots] = influences[:, 1], influences[:, 2]
    return joints, weights
