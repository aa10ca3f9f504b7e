"""The animation stacks of an FBX file: local matrices of the nodes that they move, at the file's rate."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import ufbx

from mua.arrays import Array
from mua.characters.clip_frames import frame_times
from mua.characters.fbx.bindings import get, items
from mua.characters.fbx.nodes import Nodes
from mua.characters.fbx.shapes import keyed_channels, read_weights
from mua.characters.messages import Messages
from mua.characters.node_tree import compose
from mua.errors import InputError

RATES = (1.0, 240.0)  # frames per second; beyond these a file's rate is no rate of motion
MOVES = 1e-4  # change of a local matrix, and of a place relative to its distance, below which a node stands still
PLACED = ("Lcl Translation", "Lcl Rotation", "Lcl Scaling")  # properties that move a node


@dataclass(frozen=True, eq=False)
class Take:
    """One animation stack."""

    name: str
    rate: float  # frames per second
    start: float  # seconds of the first frame
    frames: int
    local: dict[int, Array]  # by node with keys, [F, 4, 4] to its parent, of the topmost to the world
    weights: dict[str, Array]  # by expression that has keys, [F] 0 to 1

    @property
    def moved(self) -> set[int]:
        """The nodes that do not stand still."""
        return {node for node, local in self.local.items() if _moves(local)}


def read_takes(scene: Any, nodes: Nodes, path: Path, messages: Messages) -> list[Take]:
    """All stacks of a file that have keys for a node, their layers blended as the file asks for.

    Raises InputError where a stack is longer than any motion or its numbers are not finite.
    """
    rate = float(np.clip(np.nan_to_num(get(scene, "settings.frames_per_second"), nan=30.0), *RATES))
    takes = []
    for stack in items(scene, "anim_stacks"):
        name = str(get(stack, "name"))
        keyed = _keyed_nodes(stack, nodes)
        start, end = _range(scene, stack)
        face = keyed_channels(scene, stack)
        if not keyed and not face:
            messages.add("Clips that move no joint are left out: {}.", name)
        elif not end - start >= 0.5 / rate:
            messages.add("Clips of a single pose are left out: {}.", name)
        else:
            where = f"{path}: animation stack {name}"
            times = frame_times(start, end, rate, nodes=len(keyed) + len(face), where=where)
            local = {node: _sampled(stack, node, nodes, times) for node in sorted(keyed)}
            if not all(np.isfinite(matrices).all() for matrices in local.values()):
                raise InputError(f"{where} holds a number that is not finite")
            takes.append(Take(name, rate, start, len(times), local, read_weights(stack, face, times)))
    return takes


def _range(scene: Any, stack: Any) -> tuple[float, float]:
    """Start and end in seconds: as the file says, else of its keys."""
    start, end = float(get(stack, "time_begin")), float(get(stack, "time_end"))
    if end > start:
        return start, end
    baked = ufbx.bake_anim(scene, get(stack, "anim"))
    return float(get(baked, "key_time_min")), float(get(baked, "key_time_max"))


def _keyed_nodes(stack: Any, nodes: Nodes) -> set[int]:
    """Nodes with keys in some layer, and the nodes that ufbx made to hold their scale."""
    of_element = {int(get(source, "element_id")): number for number, source in enumerate(nodes.sources)}
    keyed = set()
    for layer in items(stack, "layers"):
        for prop in items(layer, "anim_props"):
            node = of_element.get(int(get(prop, "element.element_id")))
            if node and get(prop, "prop_name") in PLACED:
                keyed.add(node)
    return keyed | {helper for helper in nodes.helpers if nodes.tree.parents.get(helper) in keyed}


def _sampled(stack: Any, node: int, nodes: Nodes, times: Array) -> Array:
    """Local matrices [F, 4, 4] of a node at times [F]."""
    anim, source = get(stack, "anim"), nodes.sources[node]
    values = np.empty((len(times), 10))
    for frame, time in enumerate(times.tolist()):
        moved, turned, scaled = ufbx.evaluate_transform(anim, source, time)
        values[frame] = (*moved, *turned, *scaled)
    local = compose(values[:, :3], values[:, 3:7], values[:, 7:])
    return local if node in nodes.tree.parents else nodes.root @ local


def _moves(local: Array) -> bool:
    change = np.ptp(local, axis=0)
    size = max(float(np.abs(local[:, :3, 3]).max()), 1e-9)
    return bool(
        max(change[:3, :3].max() / max(np.abs(local[:, :3, :3]).max(), 1e-9), change[:3, 3].max() / size) > MOVES
    )
