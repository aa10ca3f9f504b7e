"""The triangles between the texels: section 8."""

import numpy as np
from oracle.file import Array, Record
from oracle.quaternions import LEAST


def blocks(texels: Array, size: int) -> Array:
    """8.1: the texels (a, b, c, d) of each block [K, 4], -1 for one that is not valid."""
    grid = np.full((size, size), -1)
    grid.flat[texels] = np.arange(len(texels))
    corners = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1], grid[1:, 1:]], axis=-1).reshape(-1, 4)
    return corners[np.sum(corners >= 0, axis=-1) >= 3]


def triangles(avatar: Record) -> Array:
    """8.2, then 8.3: [M, 3] corners among the texels."""
    runs, found = avatar.surface.runs, []
    corners = blocks(avatar.texels.texels, avatar.texels.size).tolist()
    for code, (a, b, c, d) in zip(np.repeat(runs % 16, runs // 16 + 1), corners, strict=True):
        for bit, triangle in enumerate([(a, b, c), (b, d, c)] if code & 4 else [(a, b, d), (a, d, c)]):
            if code >> bit & 1:
                found.append(triangle[::-1] if code & 8 else triangle)
    edge: list[int] = []
    for entry in avatar.surface.strips.tolist():
        if entry >= 0 and len(edge) == 2:
            found.append((*edge, entry // 2))
            edge[entry % 2] = entry // 2
        else:
            edge = [*edge, entry // 2] if entry >= 0 else []
    return np.array(found, int).reshape(-1, 3)


def normals(centres: Array, triangles: Array) -> Array:
    """8.4: [N, 3], 0 where a texel has no triangle."""
    a, b, c = centres[triangles].swapaxes(0, 1)
    total = np.zeros_like(centres)
    np.add.at(total, triangles.ravel(), np.repeat(np.cross(b - a, c - a), 3, axis=0))
    return total / np.maximum(np.linalg.norm(total, axis=-1, keepdims=True), LEAST)
