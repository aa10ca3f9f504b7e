"""Triangles that expressions bend, and what rounding may leave of the texels on them."""

from dataclasses import dataclass

import numpy as np
from skinned_cases import ULP

from mua.arrays import Array
from mua.kernels.expressions import Targets, by_vertex

SIDES = (0.2, 2.0)  # metres, of edges and heights before and after
EXTENT = 4.0  # metres, of coordinates
# Edges are differences of coordinates that were rounded three times; what follows is at most 64 roundings more.
BENT_BOUND = (3 * EXTENT / SIDES[0] + 64) * ULP * SIDES[1] / SIDES[0]
# Offsets of at most 2 metres, quaternions of at most 2 and logarithms, of 32 products and sums.
TURNED_BOUND = 2 * 32 * ULP


@dataclass(frozen=True)
class Bent:
    """Triangles with corners of their own: some bend, some have no area before or after, some do not move."""

    mesh: Array  # [V, 3] float32 before
    moved: Array  # [V, 3] float32
    faces: Array  # [F, 3]
    bending: int  # the first so many triangles


def triangles(rng: np.random.Generator, count: int) -> Bent:
    """`count` triangles that bend and four others."""
    before, after = (_some(rng, count + 4) for _ in range(2))
    before[count] = before[count][0]  # a point
    before[count + 1, 2] = before[count + 1, :2].mean(axis=0)  # a line
    after[count + 2, 1] = after[count + 2, 0]
    after[count + 3] = before[count + 3]
    mesh = before.reshape(-1, 3).astype(np.float32)
    moved = after.reshape(-1, 3).astype(np.float32) - mesh
    return Bent(mesh, moved, np.arange(3 * (count + 4), dtype=np.uint32).reshape(-1, 3), count)


def _some(rng: np.random.Generator, count: int) -> Array:
    """Corners [count, 3, 3] within SIDES and EXTENT."""
    a = rng.uniform(-0.5, 0.5, (count, 3))
    axes = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    length, height, shear = rng.uniform(*SIDES, count), rng.uniform(*SIDES, count), rng.uniform(-1, 1, count)
    b = a + length[:, None] * axes[:, 0]
    c = a + shear[:, None] * axes[:, 0] + height[:, None] * axes[:, 1]
    return np.stack([a, b, c], axis=1)


def random_texture(rng: np.random.Generator, count: int) -> Array:
    """Raw channels [count, 24] as half floats hold them, the last of no use; rotations of any length but 0."""
    texture = rng.normal(size=(count, 24))
    texture[:, 3:7] *= (rng.uniform(0.5, 2, count) / np.linalg.norm(texture[:, 3:7], axis=1))[:, None]
    texture[:, :3] = np.clip(texture[:, :3], -2, 2)
    return texture.astype(np.float16).astype(np.float32)


def random_targets(rng: np.random.Generator, vertices: Array, expressions: int) -> Targets:
    """Entries of about half of all pairs of a vertex and an expression."""
    held = rng.random((expressions, len(vertices))) < 0.5
    held[0] = True  # each vertex is moved by one
    starts = np.concatenate([[0], np.cumsum(held.sum(axis=1))])
    at = np.concatenate([vertices[row] for row in held])
    return by_vertex(starts, at, rng.normal(0, 0.1, (len(at), 3)).astype(np.float32))
