"""Animated expressions of glTF files: weights of morph targets, and nodes of a VRM animation that stand for them."""

from dataclasses import replace
from typing import Any

import numpy as np

from mua.characters.gltf.document import Document
from mua.characters.gltf.keys import KeyTrack, read_keys
from mua.characters.gltf.morphs import stated_names
from mua.characters.gltf.vrm import Vrm
from mua.characters.gltf.vrm_look import gaze_weights


def weight_tracks(document: Document, animation: Any, where: str, vrm: Vrm) -> list[tuple[str, KeyTrack]]:
    """Each expression that an animation moves, once, with the keys of its weight as values [K, 1].

    Weights count from those at rest: 0 is the file's own shape, 1 is the whole target.
    """
    found: dict[str, KeyTrack] = {}
    for c, channel in enumerate(animation.channels or []):
        target = channel.target
        if target is None or target.node is None:
            continue
        if target.path == "weights":
            for name, track in _of_mesh(document, animation, where, c):
                found.setdefault(name, track)
        elif target.path == "translation" and target.node in vrm.expression_nodes:
            track = read_keys(document, animation, where, c, types=("VEC3",))
            found.setdefault(vrm.expression_nodes[target.node], replace(track, values=track.values[:, :1]))
        elif target.path == "rotation" and target.node == vrm.look_node:
            for name, track in _of_gaze(read_keys(document, animation, where, c, types=("VEC4",))):
                found.setdefault(name, track)
    return [*found.items()]


def _of_gaze(track: KeyTrack) -> list[tuple[str, KeyTrack]]:
    """The expressions that look where a node is turned, straight from key to key."""
    keys = track.values[1::3] if track.kind == "CUBICSPLINE" else track.values
    kind = "LINEAR" if track.kind == "CUBICSPLINE" else track.kind
    weights = gaze_weights(keys[:, [3, 0, 1, 2]])
    return [(name, KeyTrack(track.times, own[:, None], kind)) for name, own in weights.items()]


def _of_mesh(document: Document, animation: Any, where: str, c: int) -> list[tuple[str, KeyTrack]]:
    """The targets of a mesh that a channel moves away from where they rest."""
    node = document.item("nodes", animation.channels[c].target.node, field=f"{where}.channels[{c}].target.node")
    if node.mesh is None:
        return []
    mesh = document.item("meshes", node.mesh, field=f"nodes[{animation.channels[c].target.node}].mesh")
    count = max((len(primitive.targets or []) for primitive in mesh.primitives or []), default=0)
    if not count:
        return []
    track = read_keys(document, animation, where, c, types=("SCALAR",), width=count)
    rest = np.array([*(node.weights or mesh.weights or []), *[0.0] * count][:count])
    names = [*stated_names(mesh), *[""] * count][:count]
    title = mesh.name or f"mesh{node.mesh}"
    moved = []
    for t, name in enumerate(names):
        values, whole = track.values[:, t : t + 1] - rest[t], 1 - rest[t]
        if whole > 0 and values.any():
            moved.append((name or f"{title}.target {t}", replace(track, values=values / whole)))
    return moved
