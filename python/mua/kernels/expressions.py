"""Expressions after a decode: vertices of the template move, and the texels about them follow.

A triangle's deformation F = R P takes its two edges to the bent ones and its unit normal to the bent one, so that
thickness stays. A vertex has the mean of its triangles by area, and a texel what its corners have, so that neighbours
bend alike: R turns the texel's offset and rotation, and its axes grow as P stretches them (schemas/README.md, section
12). What of its colour is seen from some sides alone is light that it mirrors, and turns as a mirror on it throws it.
Texture channels are those of mua.channels.
"""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.channels import APPEARANCE, SH_C0
from mua.limits import LARGEST

LEAST = 1e-5  # metres: a triangle with an edge or a height below it has no frame and does not count
MOST_STRETCH = 20.0  # of an axis, and its inverse the least
STILL = np.array([1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 0])  # the row of what does not bend
CONSTANT = slice(APPEARANCE.start, APPEARANCE.start + 3)  # colours that are the same from everywhere
LINEAR = np.arange(14, 23).reshape(3, 3)[[2, 0, 1]].T  # channels [rgb, xyz] of colours' gradients over the direction
SIGNS = np.array([-1, -1, 1], np.int8)  # of these channels
MIDDLE = 0.5  # of colours, where their channels are 0
SYMMETRIC = np.array([[4, 7, 8], [7, 5, 9], [8, 9, 6]])  # entries of P in a row


@dataclass(frozen=True, eq=False)
class Targets:
    """What moves each vertex: the entries starts[m] to starts[m + 1] - 1 move `vertices[m]`."""

    vertices: Array  # [M] int32 of the mesh, ascending: all that any expression moves
    starts: Array  # [M + 1] int32
    expressions: Array  # [P] int32, ascending for a vertex
    changes: Array  # [P, 4] offset in metres, gain


def by_vertex(
    starts: Array,  # [E + 1] int32 into the entries, expression by expression
    vertices: Array,  # [P] int32
    changes: Array,  # [P, 4] offset in metres, gain
) -> Targets:
    """The entries of expressions in the order in which a thread for each vertex reads them."""
    order = np.argsort(vertices, kind="stable")
    moved, counts = np.unique(vertices, return_counts=True)
    expressions = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    return Targets(
        vertices=moved.astype(np.int32),
        starts=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        expressions=expressions[order].astype(np.int32),
        changes=changes[order],
    )


def pack_entries(targets: Targets) -> tuple[Array, Array]:
    """Words that the shader takes: [ceil(P / 2)] expressions of 16 bits, and [P, 2] changes as half floats."""
    numbers = np.append(targets.expressions, np.zeros(len(targets.expressions) % 2)).astype("<u2")
    return numbers.view("<u4"), np.clip(targets.changes, -LARGEST, LARGEST).astype("<f2").view("<u4")


@dataclass(frozen=True, eq=False)
class Reach:
    """What the vertices of expressions may bend: triangles about them and about their neighbours."""

    corners: Array  # [T, 3] int32 of the mesh, in the order of the faces
    vertices: Array  # [B] int32, ascending: all of these
    starts: Array  # [B + 1] int32 into the stars
    stars: Array  # [3 T] int32: vertex by vertex, the places of the triangles about it
    texels: Array  # [N] bool: whether each lies on one of the triangles


def reach_of(
    vertices: Array,  # [M] int32 that expressions move
    faces: Array,  # [F, 3] into the vertices
    triangles: Array,  # [N] into faces
) -> Reach:
    """The triangles that have a corner beside the vertices, and the texels on these."""
    beside = faces[np.isin(faces, vertices).any(axis=1)]
    held = np.asarray(np.isin(faces, beside).any(axis=1))
    bent, places = np.unique(faces[held], return_inverse=True)
    return Reach(
        faces[held].astype(np.int32),
        bent.astype(np.int32),
        *stars_of(places.reshape(-1, 3), len(bent)),
        held[triangles],
    )


def stars_of(
    corners: Array,  # [T, 3]
    vertices: int,  # how many there are
) -> tuple[Array, Array]:
    """The triangles about each vertex, ascending: starts [B + 1] int32 into a list [3 T] int32 of all."""
    order = np.argsort(corners.ravel(), kind="stable")
    starts = np.searchsorted(corners.ravel()[order], np.arange(vertices + 1))
    return starts.astype(np.int32), (order // 3).astype(np.int32)


@np.errstate(over="ignore")  # beyond any figure: what overflows is clipped to MOST_STRETCH
def bend_triangles(
    mesh: Array,  # [V, 3] canonical vertices before they move, metres
    moved: Array,  # [V, 3] how far they move
    faces: Array,  # [T, 3] into vertices
) -> Array:
    """Rows [T, 12]: q(R), P as xx, yy, zz, xy, xz, yz, the root of the area, and 1 where a corner moves.

    The area is the smaller one of before and after, and 0 where a triangle has no frame.
    """
    before, after = Frames.of(mesh[faces]), Frames.of(mesh[faces] + moved[faces])
    framed, moves = before.holds & after.holds, (moved != 0).any(axis=1)[faces].any(axis=1)
    area = np.minimum(before.length * before.height, after.length * after.height) / 2
    bends = np.tile(STILL, (len(faces), 1)).astype(mesh.dtype)
    at = np.flatnonzero(framed & moves)
    turn, bends[at, 4:10] = _polar(before.at(at), after.at(at))
    bends[at, 0:4] = rotation.from_matrix(turn)
    bends[:, 10] = np.sqrt(np.where(framed, area, 0))
    bends[:, 11] = moves
    return bends


def bend_vertices(
    bends: Array,  # [T, 12] of bend_triangles
    starts: Array,  # [B + 1] into the stars
    stars: Array,  # [S] into the triangles
) -> Array:
    """Rows [B, 12]: means of q(R) and P by area over a vertex' triangles; 1 where that is not 0; 1 where one moves."""
    sums = np.zeros((len(starts) - 1, 12), bends.dtype)
    weighed = bends * bends[:, 10:11] ** 2
    weighed[:, 10], weighed[:, 11] = bends[:, 10] ** 2, bends[:, 11]
    counts = np.diff(starts)
    for place in range(counts.max(initial=0)):
        at = np.flatnonzero(counts > place)
        row = weighed[stars[starts[at] + place]]
        row[:, 0:4] *= _same_side(sums[at, 0:4], row[:, 0:4])
        sums[at] += row
    moves, area = sums[:, 11] > 0, sums[:, 10].copy()
    sums /= np.where(area > 0, area, 1)[:, None]
    sums[:, 10], sums[:, 11] = area > 0, moves
    sums[~moves] = STILL
    return sums


@np.errstate(over="ignore")
def bend_texels(
    bends: Array,  # [V, 12] of bend_vertices
    corners: Array,  # [N, 3] into them
    barycentrics: Array,  # [N, 3]
    texture: Array,  # [N, 23] raw channels
) -> Array:
    """Raw channels [N, 23] where the vertices bend; those with no such corner stay bit for bit."""
    bent = texture.copy(order="K")  # as it lies in memory: what follows rounds alike
    at = np.flatnonzero((bends[:, 11] > 0)[corners].any(axis=1))
    row = np.zeros((len(at), 12), bends.dtype)
    for corner in range(3):
        own = barycentrics[at, corner, None] * bends[corners[at, corner]]
        own[:, 0:4] *= _same_side(row[:, 0:4], own[:, 0:4])
        row += own
    bending = (row[:, 10] > 0) & (row[:, 11] > 0)
    at, row = at[bending], row[bending]
    turn, channels = _unit(row[:, 0:4]), texture[at]
    axes = row[:, SYMMETRIC] @ rotation.to_matrix(_unit(channels[:, 3:7]))
    stretch = _length(*np.moveaxis(axes, 1, 0)) / row[:, 10, None]
    bent[at, 0:3] = rotation.rotate(turn, channels[:, 0:3])
    bent[at, 3:7] = rotation.multiply(turn, channels[:, 3:7])
    bent[at, 7:10] += np.log(np.clip(stretch, 1 / MOST_STRETCH, MOST_STRETCH))
    normal = rotation.to_matrix(_unit(channels[:, 3:7]))[:, :, 2]
    turned = rotation.rotate(turn, normal)
    half = np.column_stack([np.sum(normal * turned, axis=1), np.cross(normal, turned)])
    bent[at] = mirror_texels(half, bent[at])
    return bent


def mirror_texels(
    mirrors: Array,  # [N, 4] quaternions that turn by twice the angle by which the normals do
    texture: Array,  # [N, 23] raw channels
) -> Array:
    """Raw channels [N, 23] where what of the colours depends on the view turns as a mirror turns light."""
    turned = texture.copy(order="K")
    turned[:, LINEAR] = SIGNS * rotation.rotate(mirrors[:, None], SIGNS * turned[:, LINEAR])
    return turned


def brighten_texels(
    gains: Array,  # [V] how much brighter colours become, as a share of them
    corners: Array,  # [N, 3] into these
    barycentrics: Array,  # [N, 3]
    texture: Array,  # [N, 23] raw channels
) -> Array:
    """Raw channels [N, 23] in another light; those whose gain is 0 stay bit for bit."""
    lit = texture.copy(order="K")
    gain = np.einsum("nk,nk->n", barycentrics, gains[corners])
    at = np.flatnonzero(gain)
    lit[at, CONSTANT] += gain[at, None] * (lit[at, CONSTANT] + np.asarray(MIDDLE / SH_C0, lit.dtype))
    return lit


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


def _polar(before: Frames, after: Frames) -> tuple[Array, Array]:
    """Rotations R [N, 3, 3] and stretches P [N, 6] of F = R P; in the plane the angle is atan2(-shear, trace)."""
    along = after.length / before.length  # the in-plane map, (along, shear; 0, across)
    shear = (after.shear - along * before.shear) / before.height
    across = after.height / before.height
    trace = along + across
    length = _length(trace, shear)
    c, s = trace / length, -shear / length
    u, v, n = np.moveaxis(after.axes, -1, 0)
    turned = np.stack([c[:, None] * u + s[:, None] * v, c[:, None] * v - s[:, None] * u, n], axis=-1)
    x, y, z = np.moveaxis(before.axes, -1, 0)
    xx, xy, yy = c * along, c * shear + s * across, c * across - s * shear  # P in the axes of the triangle
    rows, columns = np.array([0, 1, 2, 0, 0, 1]), np.array([0, 1, 2, 1, 2, 2])
    crossed = x[:, rows] * y[:, columns] + y[:, rows] * x[:, columns]
    stretch = xx[:, None] * x[:, rows] * x[:, columns] + yy[:, None] * y[:, rows] * y[:, columns]
    stretch += xy[:, None] * crossed + z[:, rows] * z[:, columns]
    return np.asarray(turned @ before.axes.swapaxes(1, 2)), np.asarray(stretch)


def _same_side(
    q: Array,  # [N, 4]
    other: Array,  # [N, 4]
) -> Array:
    """The sign [N, 1] by which the other quaternion, which is the same rotation, adds to this one."""
    return np.where(np.sum(q * other, axis=1, keepdims=True) < 0, -1, 1).astype(q.dtype)


def _length(*parts: Array) -> Array:
    """Root of the sum of squares."""
    return np.asarray(np.sqrt(sum(part * part for part in parts)))


def _unit(
    q: Array,  # [N, 4]
) -> Array:
    return np.asarray(q / np.maximum(_length(*q.T), np.finfo(q.dtype).tiny)[:, None])
