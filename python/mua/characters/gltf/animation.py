"""Sampling of glTF animations: node-to-world matrices at a steady rate."""

from typing import Any, TypeAlias

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.clip_frames import frame_times
from mua.characters.gltf.document import Document
from mua.characters.gltf.keys import KeyTrack, read_keys
from mua.characters.gltf.vrm import NO_VRM, Vrm
from mua.characters.gltf.weights import weight_tracks
from mua.characters.messages import Messages
from mua.characters.node_tree import chain, compose
from mua.pose.signed_expressions import as_weights
from mua.scene import Motion

RATE = 30.0  # frames per second that clips of a file are sampled at
Keyed: TypeAlias = tuple[int, str, KeyTrack]  # node, path, keys

WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}


def moved_nodes(document: Document) -> list[int]:
    """The glTF nodes that some clip moves, in order."""
    moved = set()
    for a, animation in enumerate(document.gltf.animations or []):
        for c, channel in enumerate(animation.channels or []):
            if channel.target is not None and channel.target.node is not None and channel.target.path in WIDTHS:
                field = f"animations[{a}].channels[{c}].target.node"
                document.item("nodes", channel.target.node, field=field)
                moved.add(int(channel.target.node))
    return sorted(moved)


def read_animations(
    document: Document,
    nodes: list[int],  # glTF nodes to follow, parents first
    *,
    parents: Array,  # [nodes] into nodes
    rest: Array,  # [nodes, 4, 4] local matrices where nothing is animated
    vrm: Vrm = NO_VRM,
) -> tuple[tuple[Motion, ...], tuple[str, ...]]:
    """All clips of a file that move one of `nodes` or an expression, and a sentence for each that is left out."""
    index = {node: n for n, node in enumerate(nodes)}
    motions, messages = [], Messages()
    for a, animation in enumerate(document.gltf.animations or []):
        name = animation.name or f"animation{a}"
        tracks = _tracks(document, animation, f"animations[{a}]", index=index)
        faces = weight_tracks(document, animation, f"animations[{a}]", vrm)
        if not tracks and not faces:
            messages.add("Clips that move no joint are left out: {}.", name)
            continue
        times = [track.times for track in (*(track for _, _, track in tracks), *(track for _, track in faces))]
        start, end = min(own[0] for own in times), max(own[-1] for own in times)
        if end - start < 0.5 / RATE:
            messages.add("Clips of a single pose are left out: {}.", name)
            continue
        where = f"{document.path}: animations[{a}]"
        frames = frame_times(start, end, RATE, nodes=len(nodes), where=where)
        local = _local(document, tracks, frames, nodes=nodes, rest=rest)
        weights: dict[str, Array] = {}
        for expression, track in faces:
            weights |= as_weights(expression, track.at(frames)[:, 0])
        motions.append(Motion(name, RATE, chain(local, parents), float(start), weights))
    return tuple(motions), messages.notes()


def _tracks(document: Document, animation: Any, where: str, *, index: dict[int, int]) -> list[Keyed]:
    """The node, path and keys of each channel that moves a followed node."""
    tracks = []
    for c, channel in enumerate(animation.channels or []):
        target = channel.target
        if target is None or target.node not in index or target.path not in WIDTHS:
            continue
        types = ("VEC4",) if target.path == "rotation" else ("VEC3",)
        track = read_keys(document, animation, where, c, types=types)
        if target.path == "rotation" and track.kind != "CUBICSPLINE" and not track.values.any(axis=1).all():
            field = f"{where}.samplers[{channel.sampler}].output"
            raise document.error(f"{field} holds the rotation 0 0 0 0, expected unit quaternions")
        tracks.append((index[target.node], target.path, track))
    return tracks


def _local(document: Document, tracks: list[Keyed], frames: Array, *, nodes: list[int], rest: Array) -> Array:
    """Local matrices [F, nodes, 4, 4] of followed nodes at times [F]."""
    local = np.broadcast_to(rest, (len(frames), *rest.shape)).copy()
    for node in {track[0] for track in tracks}:
        source = document.gltf.nodes[nodes[node]]
        parts = {
            "translation": np.asarray(source.translation or [0, 0, 0], float),
            "rotation": np.asarray(source.rotation or [0, 0, 0, 1], float),
            "scale": np.asarray(source.scale or [1, 1, 1], float),
        }
        values = {path: np.broadcast_to(part, (len(frames), len(part))) for path, part in parts.items()}
        for target, path, track in tracks:
            if target == node:
                values[path] = track.at(frames, spherical=path == "rotation")
        quaternion = rotation.normalize(values["rotation"])
        local[:, node] = compose(values["translation"], quaternion, values["scale"])
    return local
