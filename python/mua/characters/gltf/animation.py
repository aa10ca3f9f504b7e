"""Sampling of glTF animations: node-to-world matrices at a steady rate."""

from typing import Any

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.gltf.document import Document
from mua.characters.messages import Messages
from mua.characters.node_tree import chain, compose
from mua.scene import Motion

RATE = 30.0  # frames per second that clips of a file are sampled at
WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}
INTERPOLATIONS = ("STEP", "LINEAR", "CUBICSPLINE")


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
) -> tuple[tuple[Motion, ...], tuple[str, ...]]:
    """All clips of a file that move one of `nodes`, and a sentence for each that is left out."""
    index = {node: n for n, node in enumerate(nodes)}
    motions, messages = [], Messages()
    for a, animation in enumerate(document.gltf.animations or []):
        name = animation.name or f"animation{a}"
        tracks = _tracks(document, animation, f"animations[{a}]", index=index)
        if _morphs(document, animation, f"animations[{a}]"):
            messages.add("Animated morph targets, such as facial expressions, are left out in these clips: {}.", name)
        if not tracks:
            messages.add("Clips that move no joint are left out: {}.", name)
            continue
        start = min(times[0] for _, _, times, _, _ in tracks)
        end = max(times[-1] for _, _, times, _, _ in tracks)
        if end - start < 0.5 / RATE:
            messages.add("Clips of a single pose are left out: {}.", name)
            continue
        frames = start + np.arange(int(np.floor((end - start) * RATE + 1e-3)) + 1) / RATE
        local = _local(document, tracks, frames, nodes=nodes, rest=rest)
        motions.append(Motion(name, RATE, chain(local, parents), float(start)))
    return tuple(motions), messages.notes()


def _morphs(document: Document, animation: Any, where: str) -> bool:
    """Whether a clip changes the weights of morph targets."""
    samplers = animation.samplers or []
    for channel in animation.channels or []:
        known = isinstance(channel.sampler, int) and 0 <= channel.sampler < len(samplers)
        if known and channel.target is not None and channel.target.path == "weights":
            field = f"{where}.samplers[{channel.sampler}].output"
            if np.ptp(document.accessor(samplers[channel.sampler].output, field=field, types=("SCALAR",))) > 0:
                return True
    return False


def _tracks(document: Document, animation: Any, where: str, *, index: dict[int, int]) -> list[tuple]:
    """(node, path, times [K], values [K or 3 K, n], interpolation) of each channel that moves a followed node."""
    tracks = []
    for c, channel in enumerate(animation.channels or []):
        target = channel.target
        if target is None or target.node not in index or target.path not in WIDTHS:
            continue
        samplers = animation.samplers or []
        if not isinstance(channel.sampler, int) or not 0 <= channel.sampler < len(samplers):
            raise document.error(f"{where}.channels[{c}].sampler is {channel.sampler}, of {len(samplers)} samplers")
        sampler, at = samplers[channel.sampler], f"{where}.samplers[{channel.sampler}]"
        times = document.accessor(sampler.input, field=f"{at}.input", types=("SCALAR",))[:, 0].astype(float)
        types = ("VEC4",) if target.path == "rotation" else ("VEC3",)
        values = document.accessor(sampler.output, field=f"{at}.output", types=types).astype(float)
        kind = sampler.interpolation or "LINEAR"
        if kind not in INTERPOLATIONS:
            raise document.error(f"{at}.interpolation is {kind}, expected {', '.join(INTERPOLATIONS)}")
        expected = len(times) * (3 if kind == "CUBICSPLINE" else 1)
        if len(values) != expected:
            raise document.error(f"{at}.output holds {len(values)} elements, expected {expected} for its {kind} keys")
        if target.path == "rotation" and kind != "CUBICSPLINE" and not values.any(axis=1).all():
            raise document.error(f"{at}.output holds the rotation 0 0 0 0, expected unit quaternions")
        if (np.diff(times) <= 0).any():
            raise document.error(f"{at}.input holds times that do not increase")
        tracks.append((index[target.node], target.path, times, values, kind))
    return tracks


def _local(document: Document, tracks: list[tuple], frames: Array, *, nodes: list[int], rest: Array) -> Array:
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
        for target, path, times, keys, kind in tracks:
            if target == node:
                values[path] = sample(times, keys, frames, kind=kind, spherical=path == "rotation")
        quaternion = rotation.normalize(values["rotation"])
        local[:, node] = compose(values["translation"], quaternion, values["scale"])
    return local


def sample(times: Array, keys: Array, at: Array, *, kind: str, spherical: bool) -> Array:
    """Values [F, n] of keyframes at times [F]; glTF 2.0, appendix C. Times outside the keys hold the nearest."""
    if kind == "CUBICSPLINE":
        return _cubic(times, keys, at)
    if len(times) == 1:
        return np.repeat(keys[:1], len(at), axis=0)
    before = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 1)
    if kind == "STEP":
        return keys[before]
    before = np.minimum(before, len(times) - 2)
    fraction = np.clip((at - times[before]) / (times[before + 1] - times[before]), 0, 1)
    if spherical:
        keys = rotation.normalize(keys)
        return rotation.slerp(keys[before], keys[before + 1], fraction)
    return keys[before] + fraction[:, None] * (keys[before + 1] - keys[before])


def _cubic(times: Array, keys: Array, at: Array) -> Array:
    into, value, out = keys[0::3], keys[1::3], keys[2::3]
    if len(times) == 1:
        return np.repeat(value[:1], len(at), axis=0)
    k = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    span = (times[k + 1] - times[k])[:, None]
    t = np.clip((at - times[k])[:, None] / span, 0, 1)
    return (
        (2 * t**3 - 3 * t**2 + 1) * value[k]
        + span * (t**3 - 2 * t**2 + t) * out[k]
        + (3 * t**2 - 2 * t**3) * value[k + 1]
        + span * (t**3 - t**2) * into[k + 1]
    )
