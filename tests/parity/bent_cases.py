"""Triangles that expressions bend, and what rounding may leave of the texels on them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from dwt_cases import taps, upsampling_bound
from skinned_cases import ULP
from stored import store

from mua import rotation
from mua.arrays import Array
from mua.channels import APPEARANCE, SH_C0
from mua.kernels.expressions import MIDDLE, STILL, Targets, bend_texels, by_vertex, mirror_texels
from mua.kernels.inverse_dwt import pack_planes, texel_tiles, unpack_planes, upsample_texels, upsampling_taps

SIDES = (0.2, 2.0)  # metres, of edges and heights before and after
EXTENT = 4.0  # metres, of coordinates
LARGEST = 65535  # barycentric of 1
# Edges are differences of coordinates that were rounded three times; what follows is at most 64 roundings more.
BENT_BOUND = (3 * EXTENT / SIDES[0] + 64) * ULP * SIDES[1] / SIDES[0]
PER_METRE = 1024  # of the root of an area
WEIGHED_BOUND = 2 * SIDES[1] ** 2 * BENT_BOUND  # of an area of at most SIDES[1] ** 2
ROOT_BOUND = WEIGHED_BOUND / SIDES[0]  # of its root, which is at least SIDES[0] / sqrt(2)
STAR = 12  # triangles about a vertex at most
MOST_BENT = 3.0  # stretches in cases for vertices and texels
MEAN_BOUND = 2 * (STAR + 4) * ULP * MOST_BENT
# A colour of at most 4 and the middle, brightened by a gain of at most 1: 8 products and sums.
LIT_BOUND = 8 * ULP * 8
# Offsets of at most 2 metres, quaternions of at most 2 and logarithms, of 48 products and sums whose roundings partly
# cancel: on every device so far 32 sufficed.
TURNED_BOUND = 2 * 32 * ULP
# The normals by which light is mirrored are as exact as turned offsets of 1 metre, and their products of such vectors.
MIRROR = 2 * np.sqrt(3)
# Gradients of colours, of at most 2.5 each way, turned: 16 products and sums of at most 10.
MIRRORED_BOUND = 16 * ULP * 10
# What the channels lost before, in rotations of length 0.5 and stretches that differ by MOST_BENT squared.
BEFORE = 2 * MOST_BENT**2
GEOMETRY = APPEARANCE.start  # channels


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
    rows[:, 10] = rng.uniform(0.3, 1.4, 3 * count) * (rng.random(3 * count) < 0.8)
    rows[:, 11] = rng.random(3 * count) < 0.4
    counts = rng.integers(0, STAR + 1, count)
    starts = np.concatenate([[0], np.cumsum(counts)])
    stars = rng.integers(0, 3 * count, starts[-1])
    return rounded(rows), starts.astype(np.uint32), stars.astype(np.uint32)


def rounded(values: Array) -> Array:
    """To half floats."""
    return values.astype(np.float16).astype(np.float32)


def triangle_words(
    rows: Array,  # [T, 12]
) -> Array:
    """What the kernels hold of bent triangles, [T, 3, 2]."""
    return _words(np.column_stack([rows[:, :10], PER_METRE * rows[:, 10], rows[:, 11]]))


def vertex_numbers(
    rows: Array,  # [V, 12]
    gains: Array,  # [V]
) -> Array:
    """What half floats of bent vertices are, [V, 12]: the last 0 where one does not bend, 2 where it does not count."""
    return np.column_stack([rows[:, :10], gains, np.where(rows[:, 11] > 0, np.where(rows[:, 10] > 0, 1, 2), 0)])


def _words(numbers: Array) -> Array:
    return numbers.astype("<f2").view("<u4").reshape(-1, 3, 2)


@dataclass(frozen=True)
class BentTexels:
    """A dispatch of BendTexels, and geometry [N, 12] with the gains that it leaves."""

    groups: tuple[int, int, int]
    constants: dict[str, Any]
    buffers: dict[str, Array]  # but for the channels
    plain: Array  # geometry before it bends
    expected: Array
    mirrors: Array  # [N, 4] quaternions that it leaves of texels in reach
    reached: Array  # [N] bool
    bends: Array  # [N] bool
    bound: float


def bent_texels(rng: np.random.Generator, count: int, reach: float = 0.8) -> BentTexels:
    """Some out of reach, some between corners that do not bend or do not count, some that stretch beyond all bounds."""
    side, vertices = int(np.ceil(np.sqrt(count))), 2 * count + 3
    lo, texture = taps("bior4.4")[0], random_texture(rng, count)
    ll = pack_planes(0.02 * rng.normal(size=(GEOMETRY, side, side)))
    texels, reached = np.sort(rng.permutation(4 * side * side)[:count]), rng.random(count) < reach
    static = store(np.ascontiguousarray(texture[:, :GEOMETRY].T), "f32", rows=GEOMETRY)
    filtered, delay = upsampling_taps(lo, 1)
    rows, faces = rounded(random_bends(rng, vertices, still=count + 2)), rng.integers(0, vertices, (count + 4, 3))
    faces[0], faces[1] = 0, vertices - 1
    rows[0, 4:10] *= 100  # beyond MOST_STRETCH
    rows[1, :11] = 0  # it does not count
    gains = rounded(np.where(np.arange(vertices) < vertices - count, rng.uniform(-1, 1, vertices), 0))
    triangles, (words, barycentrics) = rng.integers(0, len(faces), count), random_places(rng, count)
    words[:, 0] = triangles | (rng.random(count) < 0.5).astype(np.uint32) << 31
    plain = upsample_texels(unpack_planes(ll).astype(float), lo, 1, texels=texels, static_offset=static.values).T
    plain = np.pad(plain, ((0, 0), (0, 23 - GEOMETRY)))
    corners = faces[triangles]
    bent = bend_texels(rows.astype(float), corners, barycentrics, plain)
    light = np.einsum("nk,nk->n", barycentrics, gains[corners].astype(float))
    normal, turned = (rotation.to_matrix(rotation.normalize(a[:, 3:7]))[:, :, 2] for a in (plain, bent))
    plain, bent = (np.column_stack([a[:, :GEOMETRY], g]) for a, g in ((plain, 0 * light), (bent, light)))
    largest = float(np.abs(unpack_planes(ll)).max(initial=0))
    tiles = texel_tiles(texels, 2 * side, reached)
    return BentTexels(
        groups=(len(tiles), 1, 1),
        constants={
            **{"static_offset_layout": static.layout, "channels": GEOMETRY, "size": side},
            **{"factor": 2, "reach": len(filtered), "delay": delay, "texel_count": count},
        },
        buffers={
            **{"ll": ll, "upsampling": filtered.astype(np.float32), "tiles": tiles, "static_offset": static.words},
            **{"faces": faces.astype(np.uint32), "texels": words},
            "vertex_bends": _words(vertex_numbers(rows, gains)),
        },
        plain=plain,
        expected=np.where(reached[:, None], bent, plain),
        mirrors=np.column_stack([np.sum(normal * turned, axis=1), np.cross(normal, turned)]),
        reached=reached,
        bends=reached & (rows[:, 11] > 0)[corners].any(axis=1) & (rows[:, 10] > 0)[corners].any(axis=1),
        bound=TURNED_BOUND + BEFORE * upsampling_bound(filtered, largest, float(np.abs(static.values).max(initial=0))),
    )


@dataclass(frozen=True)
class LitTexels:
    """A dispatch of LightTexels, and the appearance [N, 12] that it leaves."""

    groups: tuple[int, int, int]
    constants: dict[str, Any]
    buffers: dict[str, Array]
    expected: Array
    lit: Array  # [N] bool
    bounds: Array  # [12]


def lit_texels(rng: np.random.Generator, count: int) -> LitTexels:
    """Some out of reach; geometry holds gains, and the first row of appearance how its light turns."""
    side, channels = int(np.ceil(np.sqrt(count))), 23 - GEOMETRY
    lo, texture = taps("bior4.4")[0], np.clip(random_texture(rng, count)[:, 12:], -4, 4)
    texture[:, 3:] = np.clip(texture[:, 3:], -2, 2)
    ll = pack_planes(0.02 * rng.normal(size=(channels, side, side)))
    texels, reached = np.sort(rng.permutation(4 * side * side)[:count]), rng.random(count) < 0.8
    static = store(np.ascontiguousarray(texture.T), "f32", rows=channels)
    filtered, delay = upsampling_taps(lo, 1)
    before = rng.uniform(-1, 1, (6, count, 4)).astype("<f2")
    before[3] = random_bends(rng, count)[:, :4]
    before[3] = rotation.normalize(before[3].astype(float))
    plain = upsample_texels(unpack_planes(ll).astype(float), lo, 1, texels=texels, static_offset=static.values).T
    lit = mirror_texels(before[3].astype(float), np.pad(plain, ((0, 0), (GEOMETRY, 0))))[:, GEOMETRY:]
    lit[:, :3] += before[2, :, 3:].astype(float) * (lit[:, :3] + MIDDLE / SH_C0)
    lost = upsampling_bound(filtered, float(np.abs(unpack_planes(ll)).max(initial=0)), float(np.abs(texture).max()))
    tiles = texel_tiles(texels, 2 * side, reached)
    return LitTexels(
        groups=(len(tiles), 1, 1),
        constants={
            **{"static_offset_layout": static.layout, "channels": channels, "size": side},
            **{"factor": 2, "reach": len(filtered), "delay": delay, "texel_count": count},
        },
        buffers={
            **{"ll": ll, "upsampling": filtered.astype(np.float32), "tiles": tiles, "static_offset": static.words},
            "texel_channels": before.view("<u4"),
        },
        expected=np.where(reached[:, None], lit, plain),
        lit=reached,
        bounds=2 * lost + np.where(np.arange(channels) < 3, LIT_BOUND, MIRRORED_BOUND),
    )


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
    return texture.astype(np.float16).astype(np.float32)


def random_targets(rng: np.random.Generator, vertices: Array, expressions: int) -> Targets:
    """Entries of about half of all pairs of a vertex and an expression."""
    held = rng.random((expressions, len(vertices))) < 0.5
    held[0] = True  # each vertex is moved by one
    starts = np.concatenate([[0], np.cumsum(held.sum(axis=1))])
    at = np.concatenate([vertices[row] for row in held])
    return by_vertex(starts, at, rounded(rng.normal(0, 0.1, (len(at), 4))))
