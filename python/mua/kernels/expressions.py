"""Expressions after a decode: vertices of the template move, and the texels of the triangles that they bend follow.

A triangle's deformation F takes its two edges to the bent ones and its unit normal to the bent one, so that thickness
stays. Its polar rotation turns offset and rotation of the texel, and the texel's axes grow as F stretches them
(schemas/README.md, section 12). Texture channels are those of mua.channels.
"""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array

LEAST = 1e-5  # metres: a triangle with an edge or a height below it has no frame, and its texels stay as they are
MOST_STRETCH = 20.0  # of an axis, and its inverse the least


@dataclass(frozen=True, eq=False)
class Targets:
    """What moves each vertex: the entries starts[m] to starts[m + 1] - 1 move `vertices[m]`."""

    vertices: Array  # [M] int32 of the mesh, ascending: all that any expression moves
    starts: Array  # [M + 1] int32
    expressions: Array  # [P] int32, ascending for a vertex
    offsets: Array  # [P, 3] metres


def by_vertex(
    starts: Array,  # [E + 1] int32 into the entries, expression by expression
    vertices: Array,  # [P] int32
    offsets: Array,  # [P, 3] metres
) -> Targets:
    """The entries of expressions in the order in which a thread for each vertex reads them."""
    order = np.argsort(vertices, kind="stable")
    moved, counts = np.unique(vertices, return_counts=True)
    expressions = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    return Targets(
        vertices=moved.astype(np.int32),
        starts=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        expressions=expressions[order].astype(np.int32),
        offsets=offsets[order],
    )


@dataclass(frozen=True, eq=False)
class Reach:
    """What the vertices of expressions may bend."""

    triangles: Array  # [T] int32 into faces, ascending: those with a corner among the vertices
    texels: Array  # [K, 2] int32, ascending: texels on them, and their triangle's place among them


def reach_of(
    vertices: Array,  # [M] int32 that expressions move
    faces: Array,  # [F, 3] into the vertices
    triangles: Array,  # [N] into faces
) -> Reach:
    """The triangles that the vertices move, and the texels on these."""
    held = np.any(np.isin(faces, vertices), axis=1)
    texels = np.flatnonzero(held[triangles])
    places = (np.cumsum(held) - 1)[triangles[texels]]
    return Reach(np.flatnonzero(held).astype(np.int32), np.stack([texels, places], axis=1).astype(np.int32))


@np.errstate(over="ignore")  # beyond any figure: what overflows is clipped to MOST_STRETCH
def bend_triangles(
    mesh: Array,  # [V, 3] canonical vertices before they move, metres
    moved: Array,  # [V, 3] how far they move
    faces: Array,  # [T, 3] into vertices
) -> tuple[Array, Array]:
    """Quaternions of R [T, 4] and maps F [T, 3, 3]; all 0 where nothing moves or has no frame."""
    turns, maps = np.zeros((len(faces), 4), mesh.dtype), np.zeros((len(faces), 3, 3), mesh.dtype)
    at = np.flatnonzero((moved != 0).any(axis=1)[faces].any(axis=1))
    before, after = Frames.of(mesh[faces[at]]), Frames.of(mesh[faces[at]] + moved[faces[at]])
    framed = before.holds & after.holds
    at, before, after = at[framed], before.at(framed), after.at(framed)
    along = after.length / before.length  # the in-plane map, (along, shear; 0, across)
    shear = (after.shear - along * before.shear) / before.height
    across = after.height / before.height
    u, v, n = np.moveaxis(after.axes, -1, 0)
    stretched = np.stack([along[:, None] * u, shear[:, None] * u + across[:, None] * v, n], axis=-1)
    maps[at] = stretched @ before.axes.swapaxes(1, 2)
    turns[at] = rotation.from_matrix(_turn(before.axes, after.axes, along + across, shear))
    return turns, maps


@np.errstate(over="ignore")
def bend_texels(
    turns: Array,  # [T, 4]
    maps: Array,  # [T, 3, 3]
    triangles: Array,  # [N] into both
    texture: Array,  # [N, 23] raw channels
) -> Array:
    """Raw channels [N, 23] on the bent triangles; those on others stay bit for bit."""
    bent = texture.copy(order="K")  # as it lies in memory: what follows rounds alike
    at = np.flatnonzero((turns[triangles] != 0).any(axis=1))
    turn, channels = turns[triangles[at]], texture[at]
    axes = maps[triangles[at]] @ rotation.to_matrix(_unit(channels[:, 3:7]))
    stretch = _length(*np.moveaxis(axes, 1, 0))
    bent[at, 0:3] = rotation.rotate(turn, channels[:, 0:3])
    bent[at, 3:7] = rotation.multiply(turn, channels[:, 3:7])
    bent[at, 7:10] += np.log(np.clip(stretch, 1 / MOST_STRETCH, MOST_STRETCH))
    return bent


@dataclass(frozen=True, eq=False)
class Frames:
    """Triangles a, b, c in axes of their own, where b - a = (length, 0, 0) and c - a = (shear, height, 0)."""

    axes: Array  # [N, 3, 3] columns: along a to b, across it in the plane, normal
    length: Array  # [N] metres
    shear: Array  # [N]
    height: Array  # [N]

    @classmethod
    def of(
        cls,
        corners: Array,  # [N, 3, 3] metres
    ) -> "Frames":
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        length = _length(*first.T)
        u = first / np.maximum(length, LEAST)[:, None]
        shear = np.einsum("ni,ni->n", u, second)
        rest = second - shear[:, None] * u
        height = _length(*rest.T)
        v = rest / np.maximum(height, LEAST)[:, None]
        return cls(np.stack([u, v, np.cross(u, v)], axis=-1), length, shear, height)

    @property
    def holds(self) -> Array:
        """[N] bool: whether the triangle is one."""
        return np.asarray((self.length >= LEAST) & (self.height >= LEAST))

    def at(self, kept: Array) -> "Frames":
        return Frames(self.axes[kept], self.length[kept], self.shear[kept], self.height[kept])


def _turn(
    before: Array,  # [N, 3, 3]
    after: Array,  # [N, 3, 3]
    trace: Array,  # [N] of the in-plane map
    shear: Array,  # [N]
) -> Array:
    """Polar rotations [N, 3, 3] of F: in the plane the angle is atan2(-shear, trace)."""
    length = _length(trace, shear)
    cosine, sine = (trace / length)[:, None], (-shear / length)[:, None]
    u, v, n = np.moveaxis(after, -1, 0)
    turned = np.stack([cosine * u + sine * v, cosine * v - sine * u, n], axis=-1)
    return np.asarray(turned @ before.swapaxes(1, 2))


def _length(*parts: Array) -> Array:
    """Root of the sum of squares."""
    return np.asarray(np.sqrt(sum(part * part for part in parts)))


def _unit(
    q: Array,  # [N, 4]
) -> Array:
    return np.asarray(q / np.maximum(_length(*q.T), np.finfo(q.dtype).tiny)[:, None])
