"""Surfels: how the Gaussian of a texel lies on a surface, and how it turns and grows as the surface deforms."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from mua import rotation
from mua.arrays import Array, unique_rows
from mua.rig.character import Mesh
from mua.rig.surface_points import interpolate
from mua.texture.ends import end_at_surface
from mua.texture.footprints import (
    TexelPoints,
    local_normals,
    neighbour_steps,
    neighbours,
    sample_surface,
    spreads,
)
from mua.texture.rims import fit_rims
from mua.texture.sharpness import SPREAD, Sharpness, along_lines

FLATNESS = 0.03  # thickness over the smaller standard deviation
THINNESS = 0.5  # of the thickness that rounded normals and near surfaces ask for: more, and silhouettes swell
ROUNDING = 0.7  # weight of smooth normals beside those of the surface about a texel: flat where that is, round at rims
CELL = 1.3  # standard deviation over that of the surface nearest to a texel: nearly half opaque at a square's border
LEAST = 1e-6  # of the surface's size, of any standard deviation: a texel where the surface has no extent


@dataclass(frozen=True, eq=False)
class Surfels:
    """The Gaussians of the texels on a surface at rest."""

    rotations: Array  # [N, 4] z along the normal, x along a line of the image or about along u; unit, wxyz
    log_scales: Array  # [N, 3] along x, y, z; natural logarithms of metres
    smooth: Array  # [N, 4] rotations with x about along u everywhere, one sign over each chart
    aside: Array  # [N, 3] from the texels' points to the centres, metres
    at_border: Array  # [N] bool, of a chart

    @property
    def normals(self) -> Array:
        """Unit normals [N, 3] of the surface."""
        return rotation.rotate(self.rotations, np.array([0.0, 0, 1]))


def rest_surfels(
    mesh: Mesh,
    *,
    size: int,
    texels: Array,  # [N] row * size + col
    triangles: Array,  # [N] into the mesh's faces
    barycentrics: Array,  # [N, 3]
    wanted: Sharpness | None = None,  # by the image, of these texels
) -> Surfels:
    """Lay a surfel on the surface at every texel; frames and footprints run smoothly across triangles of a chart.

    The frame is the rotation nearest to the map from texture to surface (polar decomposition in the surface), so that
    a sheared chart gets rounder surfels, not spikes across its texels. The extents along its axes are those of the
    steps to the neighbouring texels and those of the surface that lies nearest to it: across an edge that smooth
    normals round off, surfels are thick and leave no gap, and where two charts meet they reach the seam. In the middle
    of a large triangle surfels lie nearly in it: askew, they would hide less of what is behind. The image may ask for
    others than those of SPREAD, and for longer ones along its lines.
    """
    weighted, area = _weighted_steps(mesh, size)
    at_corners = _sum_at_corners(mesh.uv_faces, np.concatenate([weighted, area], axis=1), len(mesh.uv))
    means = at_corners[:, :6] / np.maximum(at_corners[:, 6:], 1e-12)
    steps = interpolate(means, mesh.uv_faces[triangles], barycentrics)
    own = (weighted / np.maximum(area, 1e-12))[triangles].reshape(-1, 2, 3)
    points = TexelPoints(mesh, size, texels, triangles, barycentrics)
    footprint = neighbour_steps(points, own)
    samples = sample_surface(points, footprint)
    rounded = interpolate(vertex_normals(mesh.vertices, mesh.faces), mesh.faces[triangles], barycentrics)
    normals = local_normals(points, samples, footprint) + ROUNDING * rounded
    along_u, along_v = steps[:, :3], steps[:, 3:]
    upright = np.sign(np.sum(np.cross(along_u, along_v) * normals, axis=1, keepdims=True))
    frames = _frames(along_u + np.cross(upright * along_v, normals), normals)
    reach = np.linalg.norm(footprint @ frames, axis=1)
    rims = fit_rims(points, samples, frames, steps=reach[:, :2])
    cells = spreads(points, samples, frames)
    reach[rims.texels, :2], cells[rims.texels, :2] = rims.steps, 0
    aside = np.zeros((len(texels), 3))
    aside[rims.texels] = rims.aside
    extents = np.maximum((SPREAD if wanted is None else wanted.spreads[:, None]) * reach, CELL * cells)
    smooth = align_neighbours(rotation.from_matrix(frames), texels, size)
    turn, extents[:, :2] = along_lines(frames, extents[:, :2], steps=footprint, wanted=wanted)
    turned = rotation.multiply(smooth, rotation.from_axis_angle(np.array([0.0, 0, 1]), turn))
    centres, axes = points.places + aside, rotation.to_matrix(turned)
    shift, extents[:, :2] = end_at_surface(
        mesh, samples, triangles=triangles, frames=axes, centres=centres, extents=extents[:, :2]
    )
    extents[:, 2] = np.maximum(THINNESS * extents[:, 2], FLATNESS * extents[:, :2].min(axis=1))
    least = max(LEAST * float(np.ptp(mesh.vertices, axis=0).max()), float(np.finfo(np.float32).tiny))
    return Surfels(
        rotations=turned,
        log_scales=np.log(np.maximum(extents, least)),
        smooth=smooth,
        aside=aside + shift,
        at_border=rims.at_border,
    )


class SurfaceFrames:
    """The turn and the stretch of a surface about each of its vertices."""

    def __init__(self, vertices: Array, faces: Array) -> None:
        """Take `vertices` [V, 3] as the rest shape of `faces` [F, 3]."""
        self._tangents, basis = _tangent_operator(vertices, faces)
        self._rest, self._rest_metric = self._measure(vertices)
        t, b = basis[:, :, 0].T, basis[:, :, 1].T
        pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        self._products = [((t[i], t[j]), (b[i], b[j]), t[i] * b[j] + b[i] * t[j]) for i, j in pairs]

    def __call__(
        self,
        vertices: Array,  # [V, 3] deformed
    ) -> tuple[Array, Array]:
        """Rotations [V, 4] from the rest frames to the deformed ones, and strains [V, 6].

        A strain is the change of the metric in the rest surface: a tangent x of length 1 at rest has the length
        sqrt(1 + x . strain x). Its components are xx, yy, zz, xy, xz, yz.
        """
        frames, metric = self._measure(vertices)
        turn = np.einsum("kiv,kjv->ijv", frames, self._rest)
        tt, tb, bb = metric - self._rest_metric
        strain = [tt * p * q + tb * r + bb * s * u for (p, q), (s, u), r in self._products]
        return rotation.from_matrix(np.moveaxis(turn, 2, 0)), np.stack(strain, axis=1)

    def squeeze(
        self,
        vertices: Array,  # [V, 3] deformed
    ) -> Array:
        """How much shorter the surface is in its most compressed direction [V]: minus the log of length, >= 0."""
        t, b = self._carried(vertices)
        tt, bb, tb = (np.sum(p * q, axis=0) for p, q in ((t, t), (b, b), (t, b)))
        least = (tt + bb) / 2 - np.sqrt(((tt - bb) / 2) ** 2 + tb**2)  # eigenvalue of the metric, 1 at rest
        return np.maximum(-0.5 * np.log(np.maximum(least, 1e-6)), 0)

    def _carried(self, vertices: Array) -> Array:
        """The two tangents [2, 3, V] carried along, a plane for each component."""
        return np.asarray(self._tangents @ vertices).reshape(2, -1, 3).transpose(0, 2, 1).copy()

    def _measure(self, vertices: Array) -> tuple[Array, Array]:
        """Axes x, y, z [3, 3, V], and products [3, V] of the two unit tangents carried along.

        Of all frames about the normal, the one nearest to both carried tangents (polar decomposition in the plane).
        """
        t, b = self._carried(vertices)
        across = _cross(t, b)
        z = across / np.maximum(np.sqrt(np.sum(across * across, axis=0)), 1e-12)
        x = t + _cross(b, z)
        x -= z * np.sum(x * z, axis=0)
        x /= np.maximum(np.sqrt(np.sum(x * x, axis=0)), 1e-12)
        metric = np.stack([np.sum(p * q, axis=0) for p, q in ((t, t), (t, b), (b, b))])
        return np.stack([x, _cross(z, x), z]), metric


def _cross(a: Array, b: Array) -> Array:
    """Cross products of vectors as planes [3, V]."""
    (ax, ay, az), (bx, by, bz) = a, b
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def align_neighbours(
    q: Array,  # [N, 4] unit
    texels: Array,  # [N] row * size + col, ascending
    size: int,
) -> Array:
    """Choose signs so that neighbouring texels' quaternions lie on one hemisphere and each chart has mean w >= 0.

    A sign flip inside a chart would put a step into the wavelet details. Signs spread along the spanning forest of
    the most alike neighbours; a chart is simply connected, so that any forest serves where frames are smooth.
    """
    count = len(q)
    a, b = (np.concatenate(ends) for ends in zip(*neighbours(texels, size), strict=True))
    alike = np.sum(q[a] * q[b], axis=1)
    graph = sparse.csr_matrix((2 - np.abs(alike), (a, b)), shape=(count, count))  # 0 would mean no edge
    forest = csgraph.minimum_spanning_tree(graph)
    charts, chart = csgraph.connected_components(forest, directed=False)
    seeds = np.unique(chart, return_index=True)[1]
    tree = forest.tocoo()
    ends = np.append(tree.row, np.full(charts, count)), np.append(tree.col, seeds)  # a root above one texel per chart
    rooted = sparse.csr_matrix((np.ones(len(ends[0])), ends), shape=(count + 1, count + 1))
    ancestor = csgraph.breadth_first_order(rooted, count, directed=False)[1]
    ancestor[count] = count
    q = np.concatenate([q, np.zeros((1, 4))])
    sign = np.where(np.sum(q * q[ancestor], axis=1) < 0, -1.0, 1.0)  # relative to the ancestor
    while (ancestor != count).any():
        sign *= sign[ancestor]
        ancestor = ancestor[ancestor]
    aligned = q[:count] * sign[:count, None]
    upside = np.bincount(chart, weights=aligned[:, 0], minlength=charts) < 0
    return np.where(upside[chart][:, None], -aligned, aligned)


def vertex_normals(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
) -> Array:
    """Unit normals [V, 3], faces weighted by area; upward where they cancel."""
    a, b, c = vertices[faces].swapaxes(0, 1)
    total = _sum_at_corners(faces, np.cross(b - a, c - a), len(vertices))
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 1e-15, total / np.maximum(length, 1e-15), [0.0, 1.0, 0.0])


def _weighted_steps(mesh: Mesh, size: int) -> tuple[Array, Array]:
    """Where a step of one texel along u (3) and along v (3) leads on each face, and the face's area in the texture.

    Returns the steps times the area, [F, 6] metres x texels^2, and the area [F, 1]: means weighted by area never divide
    by that of one face, which may be 0.
    """
    p, t = mesh.vertices[mesh.faces], mesh.uv[mesh.uv_faces] * size
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    u1, v1, u2, v2 = np.concatenate([t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]], axis=1).T[..., None]
    area = u1 * v2 - u2 * v1
    weighted = np.sign(area) * np.concatenate([e1 * v2 - e2 * v1, e2 * u1 - e1 * u2], axis=1)
    return weighted, np.abs(area)


def _sum_at_corners(faces: Array, values: Array, count: int) -> Array:
    """Sums [count, c] over the faces around each corner of the values [F, c] of the faces."""
    return np.stack([np.bincount(faces.ravel(), np.repeat(column, 3), count) for column in values.T], axis=1)


def _frames(tangents: Array, normals: Array) -> Array:
    """Rotation matrices [N, 3, 3] with z along the normals and x as near to the tangents as that allows."""
    z = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-15)
    x = tangents - z * np.sum(tangents * z, axis=1, keepdims=True)
    length = np.linalg.norm(x, axis=1, keepdims=True)
    any_across = np.cross(z, np.eye(3)[np.argmin(np.abs(z), axis=1)])
    x = np.where(length > 1e-12, x, any_across)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=2)


def _tangent_operator(vertices: Array, faces: Array) -> tuple[sparse.csr_matrix, Array]:
    """A matrix [2 V, V] that carries two orthogonal unit tangents of each vertex along with the surface.

    Also returns the tangents at rest, [V, 3, 2].

    Row i is the least-squares derivative along the tangent over the edges of vertex i, each weighted by 1 / length^2.
    """
    count = len(vertices)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    i, j = unique_rows(np.concatenate([edges, edges[:, ::-1]]))[0].T
    normals = vertex_normals(vertices, faces)
    basis = _frames(np.zeros_like(normals), normals)[:, :, :2]
    edge = vertices[j] - vertices[i]
    weight = 1 / np.maximum(np.sum(edge * edge, axis=1), 1e-16)
    flat = np.einsum("ek,ekc->ec", edge, basis[i])
    moments = [np.bincount(i, weight * flat[:, a] * flat[:, c], count) for a, c in ((0, 0), (0, 1), (1, 1))]
    moment = np.stack([moments[0], moments[1], moments[1], moments[2]], axis=1).reshape(count, 2, 2)
    solvable = moment + 1e-6 * np.eye(2)  # a one-ring that lies on a line has no derivative across it
    rows = np.einsum("eab,eb,e->ae", np.linalg.inv(solvable)[i], flat, weight)
    at = np.concatenate([i, i + count])
    to = np.concatenate([j, j])
    offs = sparse.csr_matrix((rows.ravel(), (at, to)), shape=(2 * count, count))
    own = np.asarray(offs.sum(axis=1)).ravel()
    here = np.tile(np.arange(count), 2)
    return (offs - sparse.csr_matrix((own, (np.arange(2 * count), here)), shape=offs.shape)).tocsr(), basis
