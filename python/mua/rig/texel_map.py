"""Which triangle and which point of it each texel of the texture space shows."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.character import Mesh

CANDIDATES_AT_ONCE = 1 << 20  # texel-in-triangle tests held in memory together, about 100 MB


@dataclass(frozen=True)
class TexelMap:
    """The valid texels of a square texture, in row-major order; texel centres lie at (col + 0.5, row + 0.5) / size."""

    size: int  # H = W
    texels: Array  # [N] int32, row * size + col, ascending
    triangles: Array  # [N] int32 into the mesh's faces
    barycentrics: Array  # [N, 3] float32, sum 1, all >= 0
    claimed_twice: int  # texels that more than one triangle covers (beyond shared edges)


def build_texel_map(mesh: Mesh, size: int) -> TexelMap:
    """Find the UV triangle under every texel centre of a `size` x `size` texture.

    A centre on a shared edge or in an overlap goes to the first face in file order. UV triangles without area
    cover nothing, mirrored ones cover like any other, and what leaves the unit square is cut off.
    """
    corners = mesh.uv[mesh.uv_faces] * size
    owner, claims = cover(corners, size)
    texels = np.flatnonzero(owner >= 0)
    areas = _corner_areas(corners[owner[texels]], texels, size)
    return TexelMap(
        size=size,
        texels=texels.astype(np.int32),
        triangles=owner[texels],
        barycentrics=(areas / areas.sum(axis=1, keepdims=True)).astype(np.float32),
        claimed_twice=int(np.count_nonzero(claims > 1)),
    )


def points_on_surface(texels: TexelMap, dense: TexelMap) -> tuple[Array, Array]:
    """Give every valid texel of a template a point on the dense surface that the template stands for.

    Where the dense map leaves a texel empty (decimation moves chart borders by fractions of a texel) the nearest
    texel that it covers lends its point.

    Returns triangles [N] int32 into the dense faces and barycentrics [N, 3] float32, in the order of `texels`.
    """
    if not texels.texels.size:
        return np.empty(0, np.int32), np.empty((0, 3), np.float32)
    row_of_texel = np.full(dense.size * dense.size, -1, np.int64)
    row_of_texel[dense.texels] = np.arange(len(dense.texels))
    rows = row_of_texel[texels.texels]
    empty = rows < 0
    if empty.any():
        covered = np.stack(np.divmod(dense.texels, dense.size), axis=1)
        wanted = np.stack(np.divmod(texels.texels[empty], texels.size), axis=1)
        rows[empty] = cKDTree(covered).query(wanted)[1]
    return dense.triangles[rows], dense.barycentrics[rows]


def cover(
    corners: Array,  # [F, 3, 2] UV triangles, in texels
    size: int,
) -> tuple[Array, Array]:
    """For each texel centre [size * size] its first triangle, -1 for none, and how many hold it strictly inside."""
    owner = np.full(size * size, -1, np.int32)
    claims = np.zeros(size * size, np.int64)
    for faces, texels in _candidates(corners, size):
        areas = _corner_areas(corners[faces], texels, size)
        covered = (areas >= 0).all(axis=1) & (areas > 0).any(axis=1)
        claims += np.bincount(texels[(areas > 0).all(axis=1)], minlength=size * size)
        taken, first = np.unique(texels[covered], return_index=True)
        free = owner[taken] < 0
        owner[taken[free]] = faces[covered][first[free]]
    return owner, claims


def _candidates(
    corners: Array,  # [F, 3, 2] in texels
    size: int,
) -> Iterator[tuple[Array, Array]]:
    """Yield (faces [n], texels [n]) of every texel centre in every triangle's bounding box, in face order."""
    low = np.clip(np.ceil(corners.min(axis=1) - 0.5), 0, size).astype(np.int64)
    high = np.clip(np.floor(corners.max(axis=1) - 0.5) + 1, 0, size).astype(np.int64)
    extent = np.maximum(high - low, 0)  # [F, 2] columns, rows
    count = extent.prod(axis=1)
    batch = np.cumsum(count) // CANDIDATES_AT_ONCE
    for faces in np.split(np.arange(len(count)), np.flatnonzero(np.diff(batch)) + 1):
        owner = np.repeat(faces, count[faces])
        within = np.arange(len(owner)) - np.repeat(np.cumsum(count[faces]) - count[faces], count[faces])
        row, column = np.divmod(within, extent[owner, 0])
        yield owner, (row + low[owner, 1]) * size + column + low[owner, 0]


def _corner_areas(
    corners: Array,  # [n, 3, 2] in texels
    texels: Array,  # [n] row * size + col
    size: int,
) -> Array:
    """Twice the area [n, 3] that each texel centre spans with the edge opposite each corner; >= 0 inside.

    Both triangles of an edge evaluate it from the same end, so their values differ in sign alone: rounding opens no
    gap between neighbours and makes no overlap.
    """
    row, column = np.divmod(texels, size)
    centre = np.stack([column, row], axis=1) + 0.5
    turn = np.sign(_cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    areas = np.empty((len(texels), 3))
    for k in range(3):
        start, end = corners[:, (k + 1) % 3], corners[:, (k + 2) % 3]
        swap = (start[:, 0] > end[:, 0]) | ((start[:, 0] == end[:, 0]) & (start[:, 1] > end[:, 1]))
        first, last = np.where(swap[:, None], end, start), np.where(swap[:, None], start, end)
        areas[:, k] = _cross(last - first, centre - first) * np.where(swap, -turn, turn)
    return areas


def _cross(a: Array, b: Array) -> Array:
    """z component [n] of the cross product of vectors [n, 2] in the plane."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
