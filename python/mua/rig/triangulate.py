"""Triangles over the texels: the texel grid as one closed mesh, the paper's detailed geometry (section System).

Inside a UV chart neighbouring texels make triangles. Along a seam the nearest texel of one side is followed by that of
the other, and the two rows are zipped. What then stays open where several charts meet is filled.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.charts import charts_of, signed_areas
from mua.rig.surface import FIRST, RISING, SECOND, TURNED, Surface, block_triangles, blocks, runs_of, strips_of
from mua.rig.texel_map import TexelMap

STRETCH = 2.5  # footprints of its texel that an edge of the grid may span; a longer one crosses a slit in a chart
SEAM_STEP = 0.5  # texels between the samples along a seam, so that no texel beside it is stepped over
REACH = (
    4.0  # texels from a seam to the nearest of its chart; where there is none so near, the nearest in space is taken
)
SMALL_HOLE = 12  # edges round a hole that is closed wherever it is; the template's own openings are longer


def triangulate(mesh: Mesh, texels: TexelMap) -> Surface:
    """The surface over the valid texels of a template whose vertices are at rest."""
    if not len(texels.texels):
        return Surface(np.empty(0, np.uint8), np.empty(0, np.int32))
    mesh = replace(mesh, vertices=mesh.vertices.astype(np.float64), uv=mesh.uv.astype(np.float64))
    places = _sum3(texels.barycentrics[:, :, None] * mesh.vertices[mesh.faces[texels.triangles]])
    charts = charts_of(mesh)
    corners = blocks(texels)
    codes = _codes(mesh, texels, corners, places=places, charts=charts)
    inner = block_triangles(corners, codes)
    seams = _fitting(_seams(mesh, texels, places=places, charts=charts), inner, places)
    patches = _patches(np.concatenate([inner, seams]), places, mesh)
    return Surface(runs_of(codes), strips_of(np.concatenate([seams, patches])))


def _sum3(
    terms: Array,  # [P, 3, ...]
) -> Array:
    return np.asarray(terms[:, 0] + terms[:, 1] + terms[:, 2])


def _codes(
    mesh: Mesh,
    texels: TexelMap,
    corners: Array,  # [K, 4] corners of blocks, -1 where there is no texel
    *,
    places: Array,  # [N, 3] rest positions, metres
    charts: Array,  # [F]
) -> Array:
    """Codes [K]: two triangles on both sides of the shorter diagonal, or the one that three corners make.

    A triangle lies in one chart and spans no slit of it.
    """
    a, b, c, d = corners.T
    across = _sum3((places[a] - places[d]) ** 2) > _sum3((places[b] - places[c]) ** 2)
    rising = np.where((corners >= 0).all(axis=1), across, (a < 0) | (d < 0))
    halves = block_triangles(corners, np.where(rising, RISING, 0) | FIRST | SECOND).reshape(-1, 2, 3)
    chart = charts[texels.triangles[halves]]
    longest = _edge_lengths(places, halves.reshape(-1, 3)).reshape(-1, 2)
    reach = STRETCH * _footprints(mesh, texels)[halves].max(axis=2)
    drawn = (halves >= 0).all(axis=2) & (chart == chart[..., :1]).all(axis=2) & (longest <= reach)
    mirrored = np.bincount(charts, signed_areas(mesh.uv[mesh.uv_faces])) < 0
    turned = mirrored[np.where(drawn[:, 0], chart[:, 0, 0], chart[:, 1, 0])]
    codes = FIRST * drawn[:, 0] + SECOND * drawn[:, 1] + np.where(rising, RISING, 0) + np.where(turned, TURNED, 0)
    return np.where(drawn.any(axis=1), codes, 0)


def _footprints(mesh: Mesh, texels: TexelMap) -> Array:
    """Greatest length [N] on the surface, metres, of one step along a texel's diagonal."""
    uv = mesh.uv[mesh.uv_faces] * texels.size
    across = np.linalg.pinv(uv[:, 1:] - uv[:, :1]) @ (
        mesh.vertices[mesh.faces[:, 1:]] - mesh.vertices[mesh.faces[:, :1]]
    )
    return np.sqrt(2) * np.linalg.norm(across, ord=2, axis=(1, 2))[texels.triangles]


def _edge_lengths(places: Array, triangles: Array) -> Array:
    """Longest edge [T], metres."""
    corners = places[triangles]
    sides = (corners - np.roll(corners, 1, axis=1)).reshape(-1, 3)
    return np.asarray(np.sqrt(_sum3(sides**2)).reshape(-1, 3).max(axis=1))


def _seams(
    mesh: Mesh,
    texels: TexelMap,
    *,
    places: Array,  # [N, 3] rest positions, metres
    charts: Array,  # [F]
) -> Array:
    """Triangles [T, 3] that zip the texels on both sides of every edge that UV or charts cut."""
    left, right = _cut_edges(mesh, charts)
    ends = [mesh.uv[mesh.uv_faces[f[:, None], k]] * texels.size for f, k in (left, right)]  # [S, 2, 2]
    steps = np.ceil(np.max([np.sqrt(((e[:, 1] - e[:, 0]) ** 2).sum(axis=1)) for e in ends], axis=0) / SEAM_STEP)
    steps = np.maximum(steps, 1).astype(np.int64)
    edge = np.repeat(np.arange(len(steps)), steps + 1)
    within = np.arange(len(edge)) - np.repeat(np.cumsum(steps + 1) - steps - 1, steps + 1)
    t = (within / steps[edge])[:, None]
    face, corner = left
    rest = mesh.vertices[mesh.faces[face[:, None], corner]][edge]
    rest = rest[:, 0] * (1 - t) + rest[:, 1] * t
    density = float(np.sqrt(2) / np.median(_footprints(mesh, texels)))
    rows = []
    for (f, _), e in zip((left, right), ends, strict=True):
        at = e[edge, 0] * (1 - t) + e[edge, 1] * t
        rows.append(_nearest(texels, charts, places=places, density=density, chart=charts[f][edge], at=at, rest=rest))
    (a, b), on = rows, within[1:] > 0  # `on` marks the steps inside one edge
    a0, a1, b0, b1 = a[:-1][on], a[1:][on], b[:-1][on], b[1:][on]
    return np.concatenate([np.stack([b0, b1, a1], axis=1), np.stack([b0, a1, a0], axis=1)])


def _cut_edges(mesh: Mesh, charts: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """The faces left [S] and right [S] of every cut edge, and which of their corners are its start and end [S, 2]."""
    face, k = np.divmod(np.arange(3 * len(mesh.faces)), 3)
    start, end = mesh.faces[face, k].astype(np.int64), mesh.faces[face, (k + 1) % 3].astype(np.int64)
    name, back = start * len(mesh.vertices) + end, end * len(mesh.vertices) + start
    order = np.argsort(name, kind="stable")
    found = order[np.minimum(np.searchsorted(name[order], back), len(name) - 1)]
    paired = (name[found] == back) & (start < end)
    one, other = np.flatnonzero(paired), found[paired]
    corners = np.stack([k, (k + 1) % 3], axis=1)
    left, right = (face[one], corners[one]), (face[other], corners[other][:, ::-1])
    uv_left, uv_right = (mesh.uv_faces[f[:, None], c] for f, c in (left, right))
    cut = (uv_left != uv_right).any(axis=1) | (charts[left[0]] != charts[right[0]])
    return (left[0][cut], left[1][cut]), (right[0][cut], right[1][cut])


def _nearest(
    texels: TexelMap,
    charts: Array,  # [F]
    *,
    places: Array,  # [N, 3] rest positions, metres
    density: float,  # texels for each metre of the surface
    chart: Array,  # [P]
    at: Array,  # [P, 2] texels
    rest: Array,  # [P, 3] metres
) -> Array:
    """The texel [P] of a chart nearest to points of its border, in texture and in space together.

    In space alone it could lie across the seam, in the texture alone on another limb that an artist laid beside it.
    """
    row, column = np.divmod(texels.texels, texels.size)
    apart = 4 * texels.size  # farther than any two points of one chart
    known = np.column_stack([column + 0.5, row + 0.5, density * places, apart * charts[texels.triangles]])
    distance, nearest = cKDTree(known).query(np.column_stack([at, density * rest, apart * chart]))
    bare = distance > REACH
    if bare.any():
        nearest[bare] = cKDTree(places).query(rest[bare])[1]
    return np.asarray(nearest)


def _fitting(
    triangles: Array,  # [S, 3]
    grid: Array,  # [T, 3]
    places: Array,  # [N, 3] rest positions, metres
) -> Array:
    """Triangles of three different corners that share no edge in the same direction with the grid or a smaller one.

    What is left out would fold over the surface; without it every open edge lies on a loop.
    """
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    triangles = triangles[np.argsort(_edge_lengths(places, triangles), kind="stable")]
    count = len(places)
    edges = _edges(triangles, count)
    free = ~_among(edges, _edges(grid, count)).any(axis=1)
    taken: set[int] = set()
    fitting = []
    for triangle, sides in zip(triangles[free].tolist(), edges[free].tolist(), strict=True):
        if taken.isdisjoint(sides):
            taken.update(sides)
            fitting.append(triangle)
    return np.array(fitting, np.int64).reshape(-1, 3)


def _edges(triangles: Array, count: int) -> Array:
    """A number [T, 3] for each directed edge of triangles over `count` texels."""
    return triangles * count + np.roll(triangles, -1, axis=1)


def _among(wanted: Array, known: Array) -> Array:
    """Whether each number is among the known ones; numpy's isin takes ten times as long on millions."""
    known = np.append(np.sort(known, axis=None), -1)  # a sentinel past the end for greater numbers
    return np.asarray(known[np.searchsorted(known[:-1], wanted)] == wanted)


def _patches(
    triangles: Array,  # [T, 3]
    places: Array,  # [N, 3] rest positions, metres
    mesh: Mesh,
) -> Array:
    """Triangles [T, 3] that close the holes, each a fan about its first corner.

    A loop is a hole if it is short, or if it lies farther from every opening of the template than it is wide.
    """
    rims = [cKDTree(mesh.vertices[loop]) for loop in _openings(mesh.faces.astype(np.int64))]
    fans = [np.empty((0, 3), np.int64)]
    for loop in _openings(triangles):
        width = np.ptp(places[loop], axis=0).max()
        apart = all(rim.query(places[loop])[0].min() > width for rim in rims)
        if len(loop) >= 3 and (len(loop) <= SMALL_HOLE or apart):
            fans.append(np.stack([np.full(len(loop) - 2, loop[0]), loop[1:-1], loop[2:]], axis=1))
    return np.concatenate(fans)


def _openings(triangles: Array) -> list[Array]:
    """Corners of every simple loop of edges that belong to one triangle, in the order of a triangle that fills it."""
    count = triangles.max(initial=0) + 1
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    single = ~_among(start * count + end, end * count + start)
    following: dict[int, list[int]] = {}
    for s, e in zip(start[single].tolist(), end[single].tolist(), strict=True):
        following.setdefault(e, []).append(s)
    loops: list[Array] = []
    for first in list(following):
        path, place = [first], {first: 0}
        while following.get(path[-1]):
            corner = following[path[-1]].pop()
            if corner in place:
                loops.append(np.array(path[place[corner] :]))
                for left in path[place[corner] + 1 :]:
                    del place[left]
                del path[place[corner] + 1 :]
            else:
                place[corner] = len(path)
                path.append(corner)
    return loops
