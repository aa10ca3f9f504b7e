"""The triangle, and the point on it, that each texel shows."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array
from mua.rig.character import Mesh

MEMBER, TURNED, CHIEF = 1, 2, 3  # a texel's role in its block of 2 x 2: averaged, its rotation too, gives its place
CANDIDATES_AT_ONCE = 1 << 15  # texel-in-triangle tests, which processors then hold in their caches


@dataclass(frozen=True, eq=False)
class TexelMap:
    """The valid texels of a square texture, in row-major order; texel centres lie at (col + 0.5, row + 0.5) / size."""

    size: int  # H = W
    texels: Array  # [N] int32, row * size + col, ascending
    triangles: Array  # [N] int32 into the mesh's faces
    barycentrics: Array  # [N, 3] float32, sum 1, all >= 0
    claimed_twice: int  # texels that more than one triangle covers (beyond shared edges)
    one_sided: Array | None = None  # [N] bool: not drawn from behind its triangle, where others hide it; None: none
    levels: tuple[Array, ...] | None = None  # a byte for each block of each coarser level; None: undecided
    length: float | None = None  # metres: side of a texel on the mean mesh; None: not measured

    def blocks(self) -> tuple[Array, Array]:
        """Blocks of 2 x 2 that hold a texel, [B] row * size / 2 + col, and their texels [B, 4], -1 for none."""
        row, column = np.divmod(self.texels.astype(np.int64), self.size)
        numbers, block = np.unique(row // 2 * (self.size // 2) + column // 2, return_inverse=True)
        four = np.full((len(numbers), 4), -1)
        four[block, row % 2 * 2 + column % 2] = np.arange(len(block))
        return numbers, four

    def gathered(self) -> tuple[Array, Array, Array]:
        """The next level's chiefs [B], members [B, 4] and members whose rotation counts; -1 for none."""
        assert self.levels
        four, kinds = self.blocks()[1], self.levels[0][:, None] >> 2 * np.arange(4) & 3
        return four[kinds == CHIEF], np.where(kinds >= MEMBER, four, -1), np.where(kinds >= TURNED, four, -1)

    def some(
        self,
        rows: Array | slice,  # [n] int, ascending, or whether each is one of them
    ) -> "TexelMap":
        """Some of the texels, without coarser levels."""
        return replace(
            self,
            texels=self.texels[rows],
            triangles=self.triangles[rows],
            barycentrics=self.barycentrics[rows],
            one_sided=None if self.one_sided is None else self.one_sided[rows],
            levels=None,
        )

    def halved(self) -> "TexelMap":
        """The next level: blocks as texels, each where its chief lies, one-sided where all members are."""
        assert self.levels
        chiefs, members, _ = self.gathered()
        return replace(
            self,
            size=self.size // 2,
            texels=self.blocks()[0].astype(np.int32),
            triangles=self.triangles[chiefs],
            barycentrics=self.barycentrics[chiefs],
            one_sided=None if self.one_sided is None else np.all(self.one_sided[members] | (members < 0), axis=1),
            levels=self.levels[1:],
        )


def build_texel_map(mesh: Mesh, size: int) -> TexelMap:
    """Find the UV triangle under every texel centre of a `size` x `size` texture.

    A centre on a shared edge or in an overlap goes to the first face in file order. UV triangles without area
    cover nothing, mirrored ones cover like any other, and parts outside of the unit square are cut off.
    """
    corners = mesh.uv[mesh.uv_faces] * size
    owner, claims = cover(corners, size)
    texels = np.flatnonzero(owner >= 0)
    areas = _corner_areas(_edges(corners), owner[texels], texels, size)
    return TexelMap(
        size=size,
        texels=texels.astype(np.int32),
        triangles=owner[texels],
        barycentrics=np.ascontiguousarray((areas / areas.sum(axis=0)).T, dtype=np.float32),
        claimed_twice=int(np.count_nonzero(claims > 1)),
    )


def centre_barycentrics(
    mesh: Mesh,
    size: int,
    texels: Array,  # [N] row * size + col
    triangles: Array,  # [N] into the mesh's faces
) -> Array:
    """The first two barycentrics [N, 2] float32 of each texel's centre in its triangle, from UV alone.

    Every reader of a file computes them so (section 5.5 of schemas/README.md); NaN where a triangle has no area.
    """
    row, column = np.divmod(texels, size)
    centres = np.stack([column, row], axis=1) + 0.5
    x, y = np.moveaxis(mesh.uv.astype(np.float64)[mesh.uv_faces[triangles]] * size - centres[:, None], 2, 0)  # [N, 3]
    one, two, three = (x[:, i] * y[:, j] - y[:, i] * x[:, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    whole = one + two + three
    whole[whole == 0] = np.nan
    first = np.clip(one / whole, 0, 1).astype(np.float32)
    second = np.clip(two / whole, 0, 1 - first.astype(np.float64)).astype(np.float32)
    return np.stack([first, second], axis=1)


def cover(
    corners: Array,  # [F, 3, 2] UV triangles, in texels
    size: int,
) -> tuple[Array, Array]:
    """For each texel centre [size * size] its first triangle, -1 for none, and how many hold it strictly inside."""
    owner = np.full(size * size, -1, np.int32)
    claims = np.zeros(size * size, np.int64)
    edges = _edges(corners)
    for faces, texels in _candidates(corners, size):
        one, two, three = _corner_areas(edges, faces, texels, size)
        least, most = np.minimum(np.minimum(one, two), three), np.maximum(np.maximum(one, two), three)
        np.add.at(claims, texels[least > 0], 1)
        covered = np.flatnonzero((least >= 0) & (most > 0))
        covered = covered[owner[texels[covered]] < 0][::-1]  # numpy keeps the last of equal indices: the first face
        owner[texels[covered]] = faces[covered]
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


def _edges(
    corners: Array,  # [F, 3, 2] in texels
) -> Array:
    """The edge opposite each corner as (dx, dy, x, y), [3, 4, F]: its direction, counter-clockwise, and one end.

    Both triangles of an edge take the same end, so that what they compute with it differs in sign alone.
    """
    sides = corners[:, 1:] - corners[:, :1]
    turn = np.sign(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    edges = []
    for k in range(3):
        start, end = corners[:, (k + 1) % 3], corners[:, (k + 2) % 3]
        swap = (start[:, 0] > end[:, 0]) | ((start[:, 0] == end[:, 0]) & (start[:, 1] > end[:, 1]))
        first, last = np.where(swap[:, None], end, start), np.where(swap[:, None], start, end)
        edges.append(np.concatenate([((last - first) * np.where(swap, -turn, turn)[:, None]).T, first.T]))
    return np.stack(edges)


def _corner_areas(
    edges: Array,  # [3, 4, F]
    faces: Array,  # [n]
    texels: Array,  # [n] row * size + col
    size: int,
) -> Array:
    """Twice the area [3, n] that each texel centre spans with the edge opposite each corner; >= 0 inside.

    For two triangles with a common edge the values differ in sign alone: rounding opens no gap
    between neighbours and makes no overlap.
    """
    row, column = np.divmod(texels, size)
    x, y = column + 0.5, row + 0.5
    areas = np.empty((3, len(texels)))
    for k in range(3):
        dx, dy, from_x, from_y = edges[k]
        areas[k] = dx[faces] * (y - from_y[faces]) - dy[faces] * (x - from_x[faces])
    return areas
