"""Morph targets of glTF meshes as expressions: by their names, or as a VRM's expressions combine them."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.characters.gltf.document import Document
from mua.characters.gltf.vrm import Vrm
from mua.characters.messages import Messages
from mua.pose.expression_vocabulary import ARKIT, known_expression
from mua.scene import Target


class Morphs:
    """The morph targets of a node's mesh."""

    def __init__(self, document: Document, node: int, vrm: Vrm) -> None:
        source = document.gltf.nodes[node]
        mesh = document.gltf.meshes[source.mesh]
        self._document, self._where = document, f"meshes[{source.mesh}]"
        self._title = mesh.name or f"mesh{source.mesh}"
        self._rest = source.weights or mesh.weights or []
        self._names = stated_names(mesh)
        self._expressions = None
        if vrm.expressions:
            self._expressions = [(e.name, e.weights_of(node, source.mesh)) for e in vrm.expressions]

    def applied(
        self,
        primitive: Any,
        positions: Array,  # [N, 3]
        where: str,
        messages: Messages,
    ) -> tuple[Array, tuple[Target, ...]]:
        """The positions [N, 3] of a primitive at the file's weights, and how expressions move them from there."""
        if not primitive.targets:
            return positions, ()
        if not np.isfinite(self._rest).all():
            raise self._document.error(f"{where} is morphed by the weights {self._rest}, expected finite numbers")
        offsets = [self._offsets(t, target, where, len(positions)) for t, target in enumerate(primitive.targets)]
        moved = positions.copy()
        for own, weight in zip(offsets, self._rest, strict=False):
            moved += weight * own
        found = []
        for name, weights in self._sets(len(offsets), messages):
            total = sum((weight * offsets[t] for t, weight in weights.items() if t < len(offsets)), np.zeros((1, 3)))
            at = np.flatnonzero(total.any(axis=1))
            found.append(Target(name, at, total[at]))
        return moved, tuple(found)

    def _offsets(self, t: int, target: Any, where: str, count: int) -> Array:
        """How far [N, 3] a whole target moves the vertices."""
        if target.POSITION is None:
            return np.zeros((count, 3))
        field = f"{where}.targets[{t}].POSITION"
        offsets = self._document.accessor(target.POSITION, field=field, types=("VEC3",))
        if len(offsets) != count:
            raise self._document.error(f"{field} holds {len(offsets)} elements for {count} vertices")
        return offsets

    def _sets(self, count: int, messages: Messages) -> list[tuple[str, Mapping[int, float]]]:
        """Each expression with the weights of its targets; weight 1 of a target is the file's 1, wherever it rests."""
        names = [name or f"{self._title}.target {t}" for t, name in enumerate(self._listed(count))]
        rest = [*self._rest, *[0.0] * count][:count]
        own = {}
        for t, name in enumerate(names):
            if name in own:
                messages.add("Of morph targets of one name in a mesh the first is taken: {}.", f"{self._title} {name}")
            else:
                own[name] = {t: 1 - rest[t]}
        if self._expressions is None:
            return [*own.items()]
        stated = {known_expression(name) for name, _ in self._expressions}
        tracked = {name: w for name, w in own.items() if known_expression(name) in {*ARKIT} - stated}
        return [*self._expressions, *tracked.items()]

    def _listed(self, count: int) -> list[str]:
        """The names of `count` targets, empty where the file states none."""
        return [*self._names, *[""] * count][:count]


def stated_names(mesh: Any) -> list[str]:
    """The names that a mesh, or UniVRM in its first primitive, gives its targets; empty ones where it gives none."""
    for holder in (mesh, *(mesh.primitives or [])):
        names = holder.extras.get("targetNames") if isinstance(holder.extras, dict) else None
        if isinstance(names, list):
            return [name if isinstance(name, str) else "" for name in names]
    return []
