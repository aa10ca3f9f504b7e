"""Triangles that expressions bend, and what rounding may leave of the texels on them."""

from dataclasses import dataclass

import numpy as np
from golden_case import UNTOUCHED
from skinned_cases import ULP

from mua.arrays import Array
from mua.kernels.expressions import STILL, Targets, by_vertex

SIDES = (0.2, 2.0)  # metres, of edges and heights before and after
EXTENT = 4.0  # metres, of coordinates
LARGEST = 65535  # barycentric of 1
# Edges are differences of coordinates that were rounded three times; what follows is at most 64 roundings more.
BENT_BOUND = (3 * EXTENT / SIDES[0] + 64) * ULP * SIDES[1] / SIDES[0]
WEIGHED_BOUND = 2 * SIDES[1] ** 2 * BENT_BOUND  # times an area of at most SIDES[1] ** 2, which is rounded as well
STAR = 12  # triangles about a vertex at most
MOST_BENT = 3.0  # stretches in cases for vertices and texels
MEAN_BOUND = 2 * (STAR + 4) * ULP * MOST_BENT
# A colour of at most 4 and the middle, brightened by a gain of at most 1: 8 products and sums.
LIT_BOUND = 8 * ULP * 8
# Offsets of at most 2 metres, quaternions of at most 2 and logarithms, of 48 products and sums whose roundings partly
# cancel: on every device so far 32 sufficed.
TURNED_BOUND = 2 * 32 * ULP
# Gradients of colours, of at most 2 each way, turn by twice the angle between two normals, each as exact as a turned
# offset of 1 metre; the turn itself rounds as that of an offset does.
MIRRORED_BOUND = 2 * (2 * 2) * TURNED_BOUND / 2 * np.sqrt(3) + TURNED_BOUND


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


def random_bends(rng: np.random.Generator, count: int, *, still: int = 0) -> Array:
    """Rows of vertices [count, 12]: turns of at most 60 degrees, of either sign, stretches; the last do not bend."""
    rows = np.zeros((count, 12))
    axis, half = rng.normal(size=(count, 3)), rng.uniform(0, np.pi / 6, (count, 1))
    rows[:, 0:4] = np.hstack([np.cos(half), np.sin(half) * axis / np.linalg.norm(axis, axis=1, keepdims=True)])
    rows[:, 0:4] *= rng.uniform(0.8, 1, (count, 1)) * rng.choice([-1, 1], (count, 1))
    axes = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    stretch = (axes * rng.uniform(1 / MOST_BENT, MOST_BENT, (count, 1, 3))) @ axes.swapaxes(1, 2)
    rows[:, 4:10] = stretch[:, [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    rows[:, 10:] = 1
    rows[count - still :] = STILL
    return rows.astype(np.float32)


def random_stars(rng: np.random.Generator, count: int) -> tuple[Array, Array, Array]:
    """Rows of triangles [T, 12], and which of them are about vertices: some have no area, some do not move."""
    rows = random_bends(rng, 3 * count)
    rows *= rng.uniform(0.1, 2, (3 * count, 1)) * (rng.random((3 * count, 1)) < 0.8)
    rows[:, 11] = rng.random(3 * count) < 0.4
    counts = rng.integers(0, STAR + 1, count)
    starts = np.concatenate([[0], np.cumsum(counts)])
    return rows.astype(np.float32), starts.astype(np.uint32), rng.integers(0, 3 * count, starts[-1]).astype(np.uint32)


def random_light(rng: np.random.Generator, count: int, *, dark: int = 0) -> tuple[Array, Array]:
    """Vertices [count] of a mesh in any order, and its gains in [count, 4]; the last vertices have none."""
    vertices, changes = rng.permutation(count), np.full((count, 4), UNTOUCHED)
    changes[vertices, 3] = np.where(np.arange(count) < count - dark, rng.uniform(-1, 1, count), 0)
    return vertices.astype(np.uint32), changes.astype(np.float32)


def random_places(rng: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Words of texels [count, 2] on any triangle, and the barycentrics that they are."""
    first = np.sort(rng.integers(0, LARGEST + 1, (count, 2)), axis=1)
    first[:, 1] -= first[:, 0]
    words = np.stack([rng.integers(0, 1 << 32, count, np.uint64), first[:, 0] | first[:, 1] << 16], axis=1)
    shares = first / LARGEST
    return words.astype(np.uint32), np.column_stack([shares, 1 - shares.sum(axis=1)])


def random_texture(rng: np.random.Generator, count: int) -> Array:
    """Raw channels [count, 24] as half floats hold them, geometry's last of no use; rotations of any length but 0."""
    texture = rng.normal(size=(count, 24))
    texture[:, 3:7] *= (rng.uniform(0.5, 2, count) / np.linalg.norm(texture[:, 3:7], axis=1))[:, None]
    texture[:, :3] = np.clip(texture[:, :3], -2, 2)
    texture[:, 12:15] = np.clip(texture[:, 12:15], -4, 4)
    texture[:, 15:] = np.clip(texture[:, 15:], -2, 2)
    return texture.astype(np.float16).astype(np.float32)


def random_targets(rng: np.random.Generator, vertices: Array, expressions: int) -> Targets:
    """Entries of about half of all pairs of a vertex and an expression."""
    held = rng.random((expressions, len(vertices))) < 0.5
    held[0] = True  # each vertex is moved by one
    starts = np.concatenate([[0], np.cumsum(held.sum(axis=1))])
    at = np.concatenate([vertices[row] for row in held])
    return by_vertex(starts, at, rng.normal(0, 0.1, (len(at), 4)).astype(np.float32))
