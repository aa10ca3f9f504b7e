"""Triangles over the texels, as a `.muaavatar` file holds them: a code for each block of texels, strips for the rest.

Section 8 of schemas/README.md is its description; `triangulate` makes it.
"""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.rig.texel_map import TexelMap

FIRST, SECOND, RISING, TURNED = 1, 2, 4, 8  # bits of a block's code
LONGEST_RUN = 16  # most blocks of one code that a byte counts
END = -1  # end of a strip


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles over the texels, counter-clockwise seen from outside."""

    runs: Array  # [R] uint8, the blocks' codes by runs
    strips: Array  # [S] int32 into the texels; END ends a strip

    def triangles(self, texels: TexelMap) -> Array:
        """Triangles [T, 3] int64 into the texels of their map: first the blocks', then the strips'."""
        return np.concatenate([block_triangles(blocks(texels), codes_of(self.runs)), strip_triangles(self.strips)])


def blocks(texels: TexelMap) -> Array:
    """Corners [K, 4] of the 2 x 2 blocks of which at least three are valid: which texel is at a, b over c, d, or -1."""
    size, known = texels.size, texels.texels.astype(np.int64)
    column = known % size
    left = known[column > 0] - 1
    starts = np.sort(np.concatenate([known[column < size - 1], left[_find(known, left) < 0]]), kind="stable")
    corners = _find(known, starts[:, None] + np.array([0, 1, size, size + 1]))
    return np.asarray(corners[(corners >= 0).sum(axis=1) >= 3])


def _find(known: Array, wanted: Array) -> Array:
    """Index of each number among the ascending known ones, or -1."""
    at = np.searchsorted(known, wanted)
    return np.where(np.append(known, -1)[at] == wanted, at, -1)


def count_codes(runs: Array) -> int:
    """How many blocks the runs describe."""
    return int((runs >> 4).sum(dtype=np.int64)) + len(runs)


def codes_of(runs: Array) -> Array:
    """Codes [K] of runs."""
    return np.repeat(runs & 15, (runs >> 4) + 1)


def runs_of(codes: Array) -> Array:
    """Runs [R] of the blocks' codes [K]."""
    number = np.arange(len(codes))
    new = np.append(True, codes[1:] != codes[:-1])[: len(codes)]
    since = number - np.maximum.accumulate(np.where(new, number, 0))
    starts = np.flatnonzero(since % LONGEST_RUN == 0)
    return np.asarray(codes[starts] | (np.diff(starts, append=len(codes)) - 1) << 4).astype(np.uint8)


def block_triangles(
    corners: Array,  # [K, 4]
    codes: Array,  # [K]
) -> Array:
    """Triangles [T, 3], block by block; -1 where one has a corner that is no valid texel."""
    a, b, c, d = corners.T
    rising = (codes & RISING) > 0
    first = np.stack([a, b, np.where(rising, c, d)], axis=1)
    second = np.stack([np.where(rising, b, a), d, c], axis=1)
    both = np.stack([first, second], axis=1)
    both = np.where(((codes & TURNED) > 0)[:, None, None], both[..., ::-1], both)
    drawn = np.stack([codes & FIRST, codes & SECOND], axis=1) > 0
    return np.asarray(both[drawn])


def strip_triangles(strips: Array) -> Array:
    """Triangles [T, 3] of strips: each corner after the first two forms one with the last edge."""
    triangles: list[tuple[int, int, int]] = []
    edge: list[int] = []
    for entry in strips.tolist():
        corner, keeps_first = divmod(entry, 2)
        if entry == END:
            edge = []
        elif len(edge) < 2:
            edge.append(corner)
        else:
            triangles.append((edge[0], edge[1], corner))
            edge = [edge[0], corner] if keeps_first else [corner, edge[1]]
    return np.array(triangles, np.int64).reshape(-1, 3)


def strips_of(triangles: Array) -> Array:
    """Strips [S] of triangles [T, 3], begun at triangles with the fewest neighbours."""
    strips: list[int] = []
    beside: dict[tuple[int, int], int] = {}  # the corner that makes a triangle with a directed edge
    for a, b, c in triangles.tolist():
        if beside.keys().isdisjoint(((a, b), (b, c), (c, a))):
            beside |= {(a, b): c, (b, c): a, (c, a): b}
        else:  # another one has an edge of it in the same direction
            strips += [2 * a, 2 * b, 2 * c, END]
    sides = [sum(edge in beside for edge in ((b, a), (c, b), (a, c))) for a, b, c in triangles.tolist()]
    for a, b, c in triangles[np.argsort(sides, kind="stable")].tolist():
        if beside.get((a, b)) == c:
            strip = max((_strip(beside, start) for start in ((a, b, c), (b, c, a), (c, a, b))), key=len)
            for p, q, v in strip_triangles(np.array(strip)).tolist():
                del beside[p, q], beside[q, v], beside[v, p]
            strips += [*strip, END]
    return np.array(strips, np.int32)


def _strip(beside: dict[tuple[int, int], int], start: tuple[int, int, int]) -> list[int]:
    """The strip that begins with a triangle and goes on until no free neighbour is left."""
    p, q, corner = start
    strip, met = [2 * p, 2 * q], {(p, q)}
    while True:
        strip.append(2 * corner)
        met |= {(q, corner), (corner, p)}
        ways = enumerate(((corner, q), (p, corner)))
        way = next(((keeps_first, edge) for keeps_first, edge in ways if edge in beside and edge not in met), None)
        if way is None:
            return strip
        keeps_first, (p, q) = way
        strip[-1] += keeps_first
        met.add((p, q))
        corner = beside[p, q]
