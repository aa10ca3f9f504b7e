"""Expressions: what moves a face besides its joints, as linear targets over the vertices of a mesh."""

from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array
from mua.pose.expression_rules import held_back


@dataclass(frozen=True, eq=False)
class Expressions:
    """For each expression, how far its whole weight 1 moves some vertices in the bind pose (linear blendshapes).

    Weights are 0 to 1; vertices that none names stay exactly where they are.
    """

    names: tuple[str, ...]  # [E] as in the file that they come from, no two equal
    starts: Array  # [E + 1] int32 into the entries: those of expression e are starts[e] to starts[e + 1] - 1
    vertices: Array  # [P] int32 of the mesh, ascending within an expression
    offsets: Array  # [P, 3] float32, metres
    gains: Array | None = None  # [P] float32: how much brighter colours there become, a share of them; None: all 0
    rules: Array | None = None  # [E] int32 of mua.pose.expression_rules; None: all 0

    def __len__(self) -> int:
        return len(self.names)

    @property
    def changes(self) -> Array:
        """Offset and gain [P, 4] of each entry."""
        gains = np.zeros(len(self.vertices), np.float32) if self.gains is None else self.gains
        return np.column_stack([self.offsets, gains])

    def shown(
        self,
        weights: Array,  # [..., E] 0 to 1
    ) -> Array:
        """The weights [..., E] that show, as the rules hold them back; given these again, less may show."""
        return held_back(self.rules, weights)

    def displacement(
        self,
        weights: Array,  # [E]
        *,
        vertices: int,
    ) -> Array:
        """How far [V, 3] the weights move the vertices of the mesh, metres."""
        moved = np.zeros((vertices, 3), dtype=np.result_type(weights, np.float32))
        some, weight = self._weighted(weights)
        np.add.at(moved, self.vertices[some], weight[:, None] * self.offsets[some])
        return moved

    def moved(
        self,
        weights: Array,  # [E]
    ) -> Array:
        """The vertices that the weights move or brighten, some of them more than once."""
        return self.vertices[self._weighted(weights)[0]]

    def brightening(
        self,
        weights: Array,  # [E]
        *,
        vertices: int,
    ) -> Array:
        """How much brighter [V] the weights make the colours about the vertices, as a share of them."""
        gain = np.zeros(vertices, dtype=np.result_type(weights, np.float32))
        if self.gains is not None:
            some, weight = self._weighted(weights)
            np.add.at(gain, self.vertices[some], weight * self.gains[some])
        return gain

    def _weighted(self, weights: Array) -> tuple[Array, Array]:
        """The entries of expressions whose weight is not 0, and their weights."""
        weight = np.repeat(weights, np.diff(self.starts))
        some = np.flatnonzero(weight)
        return some, weight[some]

    def at(
        self,
        kept: Array,  # [T] int, vertices of the mesh, each at most once
    ) -> "Expressions":
        """These expressions on a mesh that has some of the vertices, in another order."""
        row = np.full(max(self.vertices.max(initial=-1), kept.max(initial=-1)) + 1, -1)
        row[kept] = np.arange(len(kept))
        expression = np.repeat(np.arange(len(self)), np.diff(self.starts))
        at = row[self.vertices]
        order = np.lexsort((at, expression))
        order = order[at[order] >= 0]
        counts = np.bincount(expression[order], minlength=len(self))
        return replace(
            self,
            starts=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
            vertices=at[order].astype(np.int32),
            offsets=self.offsets[order],
            gains=None if self.gains is None else self.gains[order],
        )
