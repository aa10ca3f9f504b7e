"""Blend shapes of an FBX file as expressions: how they move a mesh, and their weights over time."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufbx

from mua.arrays import Array
from mua.characters.fbx.bindings import array, get, items
from mua.characters.messages import Messages
from mua.errors import InputError
from mua.pose.signed_expressions import as_weights
from mua.scene import Target

PERCENT = "DeformPercent"  # the property with a channel's weight
BETWEEN = "Shapes in between (in-betweens) are passed over; expressions move straight to the last, of meshes: {}."
DOUBLED = "Of blend shapes of one name in a mesh the first is taken: {}."


def morphed(
    source: Any,
    positions: Array,  # [V, 3]
    name: str,
    where: str,
    messages: Messages,
) -> tuple[Array, tuple[Target, ...]]:
    """The positions [V, 3] at the weights at rest, and how each channel moves them from there to its last shape."""
    moved = positions.copy()
    wholes: dict[str, Array] = {}
    for number, channel in enumerate(_channels(source)):
        at_rest, whole = np.zeros_like(positions), np.zeros_like(positions)
        keys = list(items(channel, "keyframes"))
        if len(keys) > 1:
            messages.add(BETWEEN, name)
        for key in keys:
            whole = _offsets(get(key, "shape"), len(positions), where)
            weight = float(get(key, "effective_weight"))
            at_rest += (weight if np.isfinite(weight) else 0.0) * whole
        moved += at_rest
        expression = str(get(channel, "name")) or f"{name}.target {number}"
        if expression in wholes:
            messages.add(DOUBLED, f"{name} {expression}")
        else:
            wholes[expression] = whole - at_rest
    return moved, tuple(_target(expression, offsets) for expression, offsets in wholes.items())


def keyed_channels(scene: Any, stack: Any) -> list[Any]:
    """The channels that have keys in a stack."""
    channels = {int(get(channel, "element_id")): channel for channel in items(scene, "blend_channels")}
    found = {}
    for layer in items(stack, "layers"):
        for prop in items(layer, "anim_props"):
            element = int(get(prop, "element.element_id"))
            if element in channels and get(prop, "prop_name") == PERCENT:
                found[element] = channels[element]
    return [*found.values()]


def read_weights(stack: Any, channels: Sequence[Any], times: Array) -> dict[str, Array]:
    """The weights [F] of channels that leave where they rest, counted from there, 0 to 1; the first of each name."""
    found: dict[str, Array] = {}
    for channel in channels:
        rest, anim = float(get(channel, "weight")), get(stack, "anim")
        values = np.array([ufbx.evaluate_blend_weight(anim, channel, time) for time in times.tolist()], float)
        weights = np.nan_to_num((values - rest) / (1 - rest)) if rest < 1 else np.zeros(len(times))
        for name, own in as_weights(str(get(channel, "name")), weights).items():
            if own.any():
                found.setdefault(name, own)
    return found


def _channels(source: Any) -> list[Any]:
    return [channel for deformer in items(source, "blend_deformers") for channel in items(deformer, "channels")]


def _offsets(shape: Any, count: int, where: str) -> Array:
    """How far [V, 3] a whole shape moves the vertices of a mesh."""
    vertices, offsets = array(shape, "offset_vertices").astype(int).ravel(), array(shape, "position_offsets")
    found = np.zeros((count, 3))
    if vertices.max(initial=-1) >= count or not np.isfinite(offsets).all():
        raise InputError(f"{where}: blend shape {get(shape, 'name')} does not fit its {count} vertices")
    if len(vertices):
        np.add.at(found, vertices, offsets)
    return found


def _target(name: str, offsets: Array) -> Target:
    at = np.flatnonzero(offsets.any(axis=1))
    return Target(name, at, offsets[at])
