"""What each texel has to cover: the steps to its neighbours, and the surface that lies nearer to it than to others."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.charts import areas, charts_of
from mua.rig.surface_points import face_normals, interpolate, spread_points

SLIT = 1.5  # times its texel's footprint that the step to a neighbour may span; a longer one crosses a slit in a chart
COARSEST = 3.0  # times the median step that a texel may span: beyond it a surfel reaches out into the air beside it
SAMPLES = 8  # of the surface, for each texel
FEW = 2  # samples: fewer than these say little about the extent of a texel's surface
NEAREST = 6  # texels among which a sample seeks the nearest that faces its way
ABOUT = 9  # texels over which a normal is averaged: three along a side
NEARNESS = 0.6  # steps, standard deviation of the weights of that average
AVERTED = -0.2  # cosine between normals below which a texel lies on the other side of a sheet
FAR = 1.5  # steps from the nearest texel: surface that lies farther away is bare, no texel grows so far


@dataclass(frozen=True, eq=False)
class Samples:
    """Points spread evenly over a surface, each with the texel that has to cover it."""

    places: Array  # [S, 3] metres
    triangles: Array  # [S] into the mesh's faces
    texels: Array  # [S] rows of the texel map
    bare: Array  # [S] bool, no texel lies near


@dataclass(frozen=True, eq=False)
class TexelPoints:
    """The texels of a texture as points of a surface."""

    mesh: Mesh
    size: int
    texels: Array  # [N] row * size + col, ascending
    triangles: Array  # [N] into the mesh's faces
    barycentrics: Array  # [N, 3]

    @cached_property
    def places(self) -> Array:
        """[N, 3] metres."""
        return interpolate(self.mesh.vertices, self.mesh.faces[self.triangles], self.barycentrics)

    @cached_property
    def charts(self) -> Array:
        """The chart [F] of each face."""
        return charts_of(self.mesh)


def neighbour_steps(
    points: TexelPoints,
    own: Array,  # [N, 2, 3] steps of one texel along u and v on each texel's triangle
) -> Array:
    """Steps [N, 2, 3] along u and v that lead to the farther of the two neighbours in the same chart.

    Where there is none, the step on the texel's own triangle stands in, no longer than that triangle is wide.
    """
    mesh, places = points.mesh, points.places
    chart = points.charts[points.triangles]
    raw = np.linalg.norm(own, axis=2)
    longest = COARSEST * _usual(raw, chart)
    lengths = np.minimum(raw, longest[:, None])
    found, farthest = np.zeros_like(own), np.zeros(lengths.shape)
    for axis, (a, b) in enumerate(neighbours(points.texels, points.size)):
        step = places[b] - places[a]
        length = np.linalg.norm(step, axis=1)
        beside = (chart[a] == chart[b]) & (length <= SLIT * np.maximum(lengths[a, axis], lengths[b, axis]))
        for end in (a, b):  # each texel is at most once the first and once the second
            longer = beside & (length > farthest[end, axis])
            found[end[longer], axis], farthest[end[longer], axis] = step[longer], length[longer]
    width = np.sqrt(areas(mesh.vertices[mesh.faces]))[points.triangles, None]
    alone = (
        own * (np.minimum(lengths, width) / np.maximum(np.linalg.norm(own, axis=2), np.finfo(float).tiny))[..., None]
    )
    steps = np.where(farthest[:, :, None] > 0, found, alone)
    long = np.linalg.norm(steps, axis=2)
    longest = COARSEST * _usual(long, chart)
    return steps * np.minimum(1, longest[:, None] / np.maximum(long, np.finfo(float).tiny))[..., None]


def _usual(
    steps: Array,  # [N, 2] lengths of the steps of each texel along u and v
    chart: Array,  # [N]
) -> Array:
    """The step [N] that half of each texel's chart, by surface, does not exceed, nor half of the whole surface."""
    surface = np.maximum(steps[:, 0] * steps[:, 1], np.finfo(float).tiny)
    step = np.sqrt(surface)
    if not len(step):
        return step
    order = np.argsort(step)
    below = np.cumsum(surface[order])
    of_all = step[order][np.searchsorted(below, below[-1] / 2)]
    order = np.lexsort((step, chart))
    ends = np.searchsorted(chart[order], np.arange(chart.max(initial=-1) + 1), side="right")
    below = np.cumsum(surface[order])
    before = np.concatenate([[0], below[ends - 1]])
    middle = np.searchsorted(below, (before[:-1] + before[1:]) / 2)
    of_chart = step[order][np.minimum(middle, len(step) - 1)][chart]
    return np.minimum(of_chart, of_all)


def sample_surface(
    points: TexelPoints,
    steps: Array,  # [N, 2, 3] of neighbour_steps
) -> Samples:
    """Spread samples over the surface and give each to the texel under it, or else to the nearest that faces its way.

    What lies on another triangle than its texel and farther away than FAR steps is bare: nothing near shows it.
    """
    mesh, places = points.mesh, points.places
    normals = face_normals(mesh)
    triangles, barycentrics = spread_points(mesh, SAMPLES * len(points.texels), _shares(mesh))
    at = interpolate(mesh.vertices, mesh.faces[triangles], barycentrics)
    column, row = (interpolate(mesh.uv, mesh.uv_faces[triangles], barycentrics) * points.size).astype(np.int64).T
    row_of_texel = np.full(points.size**2, -1, np.int64)
    row_of_texel[points.texels] = np.arange(len(points.texels))
    inside = (column >= 0) & (column < points.size) & (row >= 0) & (row < points.size)
    texel = np.where(inside, row_of_texel[np.where(inside, row * points.size + column, 0)], -1)
    charts = points.charts
    stray = (texel < 0) | (charts[points.triangles[texel]] != charts[triangles])
    if stray.any():
        found = cKDTree(places).query(at[stray], k=min(NEAREST, len(places)))[1].reshape(int(stray.sum()), -1)
        facing = np.einsum("snc,sc->sn", normals[points.triangles[found]], normals[triangles[stray]]) > 0
        texel[stray] = np.take_along_axis(found, np.argmax(facing, axis=1)[:, None], axis=1)[:, 0]
    reach = np.linalg.norm(steps, axis=2).max(axis=1)[texel]
    far = np.linalg.norm(at - places[texel], axis=1) > FAR * reach
    bare = far & (points.triangles[texel] != triangles)
    return Samples(at, triangles, texel, bare)


def _shares(mesh: Mesh) -> Array:
    """The share of samples [F] that each triangle gets: half by its texels, as fine parts have many on little surface.

    The other half is by its surface, some of which may have next to no texels.
    """
    kinds = (areas(mesh.uv[mesh.uv_faces]), areas(mesh.vertices[mesh.faces]))
    return np.asarray(sum(kind / max(float(kind.sum()), np.finfo(float).tiny) for kind in kinds))


def local_normals(
    points: TexelPoints,
    samples: Samples,
    steps: Array,  # [N, 2, 3] of neighbour_steps
) -> Array:
    """Unit normals [N, 3] of the surface within about a step of each texel, across the borders of charts too.

    In the middle of a large triangle they are its own, along a crease they are those of both its sides.
    """
    faces, own = face_normals(points.mesh), points.triangles
    if not len(own):
        return np.empty((0, 3))
    seen = ~samples.bare
    facing = faces[samples.triangles[seen]]
    sums = [np.bincount(samples.texels[seen], column, len(own)) for column in facing.T]
    around = np.stack(sums, axis=1) + faces[own]
    away, near = cKDTree(points.places).query(points.places, k=min(ABOUT, len(own)), workers=-1)
    away, near = away.reshape(len(own), -1), near.reshape(len(own), -1)
    least = np.finfo(float).tiny ** 0.25  # metres, by whose square can be divided
    step = np.maximum(np.linalg.norm(steps, axis=2).mean(axis=1, keepdims=True), least)
    weights = np.exp(-((away / (NEARNESS * step)) ** 2) / 2)
    weights[np.einsum("nc,nkc->nk", faces[own], faces[own[near]]) < AVERTED] = 0
    total = np.einsum("nk,nkc->nc", weights, around[near])
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), np.finfo(float).tiny))


def spreads(
    points: TexelPoints,
    samples: Samples,
    frames: Array,  # [N, 3, 3] columns x, y, z
) -> Array:
    """Root mean squares [N, 3] of the distances of samples from their texels along the frames' axes; 0 without any."""
    texel = samples.texels[~samples.bare]
    away = np.einsum("sc,sck->sk", samples.places[~samples.bare] - points.places[texel], frames[texel])
    count = np.maximum(np.bincount(texel, minlength=len(frames)), FEW)
    return np.stack([np.sqrt(np.bincount(texel, column**2, len(frames)) / count) for column in away.T], axis=1)


def neighbours(texels: Array, size: int) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Pairs of rows of `texels` that are neighbours in a row of the texture, then those in a column."""
    row = np.full(size * size, -1, dtype=np.int64)
    row[texels] = np.arange(len(texels))
    grid = row.reshape(size, size)
    pairs = [(grid[:, :-1].ravel(), grid[:, 1:].ravel()), (grid[:-1].ravel(), grid[1:].ravel())]
    along_u, along_v = ((a[(a >= 0) & (b >= 0)], b[(a >= 0) & (b >= 0)]) for a, b in pairs)
    return along_u, along_v
