"""Binds each texel of the dense surface to a triangle of the template that stands for it.

The texels are those of the dense surface. Decimation moves the borders of charts and bridges what lies near in
space, so that the triangle under a texel in the texture may belong to another piece of surface, or move with other
joints; such a texel goes to the nearest triangle of its own kind.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.character import Character, Mesh
from mua.rig.surface_points import face_normals, interpolate, nearest_barycentrics, spread_points
from mua.rig.template import Template
from mua.rig.texel_map import TexelMap, build_texel_map

BEND = 0.7  # radians by which each joint is turned alone to measure how far other skin weights misplace a point
SLIDE = 0.03  # share of the figure's size by which each joint is moved alone, likewise
REACH = 0.1  # share of the figure's size: distance from a joint in the search for neighbours that move alike
ANYWHERE = 10.0  # share of the figure's size: points that move alike come before all nearer ones
OTHER_PIECE = 0.02  # share of the figure's size: the cost of another UV piece, as pieces part where surfaces end
OTHER_SIDE = 0.05  # share of the figure's size: the cost of a triangle that faces the other way
ACCEPTED = 0.004  # share of the figure's size: below this cost the triangle under a texel is taken without a search
FAR = 0.03  # share of the figure's size, 5 cm on a person: a texel that is carried worse is left out
FAR_ALIKE = 0.15  # likewise where the carrier moves just as the texel does: its offset is long
ALIKE = 1e-3  # share of the figure's size: points that part by less move alike
CANDIDATES = 12  # points of the template that a texel chooses from
SAMPLES = 8  # points for each triangle of the template
SKIN_DIRECTIONS = 8  # dimensions of the space of weights in which neighbours are sought
AT_ONCE = 1000  # texels that are processed together


@dataclass(frozen=True, eq=False)
class Carried:
    """The texels of a dense surface on its template."""

    texels: TexelMap  # triangles and barycentrics are the template's
    cost: Array  # [N] error of each texel as a share of the figure's size: at rest and in a bent pose
    moved: int  # texels carried by another triangle than the one under them in the texture
    alike: Array  # [N] bool: the carrier moves just as the texel does, wherever it is

    @property
    def unbound(self) -> Array:
        """[N] bool, texels that no triangle of the template carries well."""
        return self.cost > np.where(self.alike, FAR_ALIKE, FAR)

    @property
    def kept(self) -> TexelMap:
        """The texels that are bound well."""
        held, texels = ~self.unbound, self.texels
        return replace(
            texels,
            texels=texels.texels[held],
            triangles=texels.triangles[held],
            barycentrics=texels.barycentrics[held],
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence on the unbound texels, if there are any."""
        unbound = int(np.count_nonzero(self.unbound))
        if not unbound:
            return ()
        return (
            f"{unbound:,} of {len(self.cost):,} texels are left out: no part of the template lies near them and "
            f"moves as they do.",
        )


def bind_texels(character: Character, template: Template, *, size: int) -> Carried:
    """Give each texel of a character's `size` x `size` texture the triangle of the template that carries it."""
    dense, under = build_texel_map(character.mesh, size), build_texel_map(template.mesh, size)
    if not len(dense.texels):
        return Carried(dense, np.zeros(0), 0, np.zeros(0, bool))
    surfaces = _Surfaces(character, template)
    row_of_texel = np.full(size * size, -1, np.int64)
    row_of_texel[under.texels] = np.arange(len(under.texels))
    rows = row_of_texel[dense.texels]
    there = rows >= 0
    triangles = np.where(there, under.triangles[rows], 0)
    barycentrics = np.where(there[:, None], under.barycentrics[rows], [1.0, 0, 0])
    cost = np.full(len(dense.texels), np.inf)
    for some in np.array_split(np.flatnonzero(there), len(there) // (AT_ONCE * CANDIDATES) + 1):
        placed = dense.triangles[some], dense.barycentrics[some]
        cost[some] = surfaces.cost(*placed, triangles[some], barycentrics[some])
    poor, moved = np.flatnonzero(cost > ACCEPTED), 0
    for start in range(0, len(poor), AT_ONCE):
        part = poor[start : start + AT_ONCE]
        choice, points, least = surfaces.best(dense.triangles[part], dense.barycentrics[part])
        better = least < cost[part]
        chosen = part[better]
        triangles[chosen], barycentrics[chosen], cost[chosen] = choice[better], points[better], least[better]
        moved += len(chosen)
    alike, lost = np.zeros(len(cost), bool), np.flatnonzero(cost > FAR)
    for start in range(0, len(lost), AT_ONCE):
        part = lost[start : start + AT_ONCE]
        choice, points, away = surfaces.nearest_alike(dense.triangles[part], dense.barycentrics[part])
        near = away < FAR_ALIKE
        chosen = part[near]
        triangles[chosen], barycentrics[chosen], cost[chosen] = choice[near], points[near], away[near]
        alike[chosen] = True
        moved += len(chosen)
    texels = replace(dense, triangles=triangles.astype(np.int32), barycentrics=barycentrics.astype(np.float32))
    return Carried(texels, cost, moved, alike)


class _Surfaces:
    """A dense surface beside its template, lengths as shares of the figure's size."""

    def __init__(self, character: Character, template: Template) -> None:
        mesh, coarse = character.mesh, template.mesh
        scale = float(np.ptp(mesh.vertices, axis=0).max()) or 1.0
        self._dense, self._coarse = (replace(m, vertices=m.vertices / scale) for m in (mesh, coarse))
        self._dense_normals, self._coarse_normals = face_normals(mesh), face_normals(coarse)
        self._dense_pieces, self._coarse_pieces = _pieces(mesh, template)
        skeleton = character.skeleton
        _, joints = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
        self._joints = joints / scale
        self._weights = _carried_weights(character)
        self._coarse_weights = self._weights[template.source_vertices]
        self._directions = _directions(self._weights)
        self._samples, self._at = spread_points(coarse, SAMPLES * len(coarse.faces))
        self._tree = cKDTree(self._features(self._coarse, self._coarse_weights, self._samples, self._at, reach=REACH))

    def cost(
        self,
        triangles: Array,  # [N] of the dense surface
        barycentrics: Array,  # [N, 3]
        carriers: Array,  # [N] triangles of the template
        points: Array,  # [N, 3]
    ) -> Array:
        """How far off the points of the dense surface are carried [N]."""
        own = interpolate(self._dense.vertices, self._dense.faces[triangles], barycentrics)
        corners = self._coarse.faces[carriers]
        away = np.linalg.norm(interpolate(self._coarse.vertices, corners, points) - own, axis=1)
        astray = self.astray(triangles, barycentrics, carriers, points)
        facing = np.sum(self._dense_normals[triangles] * self._coarse_normals[carriers], axis=1)
        other = self._dense_pieces[triangles] != self._coarse_pieces[carriers]
        return np.asarray(away + astray + OTHER_SIDE * (facing < 0) + OTHER_PIECE * other)

    def astray(self, triangles: Array, barycentrics: Array, carriers: Array, points: Array) -> Array:
        """How far [N] the same points part from their carriers where joints turn."""
        own = interpolate(self._dense.vertices, self._dense.faces[triangles], barycentrics)
        skin = interpolate(self._weights, self._dense.faces[triangles], barycentrics)
        skin -= interpolate(self._coarse_weights, self._coarse.faces[carriers], points)
        squares = np.sum(own**2, axis=1)[:, None] - 2 * own @ self._joints.T + np.sum(self._joints**2, axis=1)
        return np.asarray(BEND * np.sqrt(np.sum(skin**2 * (np.maximum(squares, 0) + SLIDE**2), axis=1)))

    def best(self, triangles: Array, barycentrics: Array) -> tuple[Array, Array, Array]:
        """The triangles of the template [N] that carry points best, where on them [N, 3], and the cost [N]."""
        carriers, points = self._candidates(self._tree, REACH, triangles, barycentrics)
        count = carriers.shape[1]
        repeated = np.repeat(triangles, count), np.repeat(barycentrics, count, axis=0)
        cost = self.cost(*repeated, carriers.ravel(), points.reshape(-1, 3)).reshape(carriers.shape)
        rows, best = np.arange(len(triangles)), np.argmin(cost, axis=1)
        return carriers[rows, best], points[rows, best], cost[rows, best]

    def nearest_alike(self, triangles: Array, barycentrics: Array) -> tuple[Array, Array, Array]:
        """The nearest triangles [N] that move just as points do, where on them, and how far; inf where none does."""
        carriers, points = self._candidates(self._alike_tree, ANYWHERE, triangles, barycentrics)
        own = interpolate(self._dense.vertices, self._dense.faces[triangles], barycentrics)
        corners = self._coarse.vertices[self._coarse.faces[carriers]]
        away = np.linalg.norm(np.einsum("nkc,nkcd->nkd", points, corners) - own[:, None], axis=2)
        count = carriers.shape[1]
        repeated = np.repeat(triangles, count), np.repeat(barycentrics, count, axis=0)
        astray = self.astray(*repeated, carriers.ravel(), points.reshape(-1, 3)).reshape(carriers.shape)
        away = np.where(astray < ALIKE, away, np.inf)
        rows, best = np.arange(len(triangles)), np.argmin(away, axis=1)
        return carriers[rows, best], points[rows, best], away[rows, best]

    @cached_property
    def _alike_tree(self) -> cKDTree:
        return cKDTree(self._features(self._coarse, self._coarse_weights, self._samples, self._at, reach=ANYWHERE))

    def _candidates(self, tree: cKDTree, reach: float, triangles: Array, barycentrics: Array) -> tuple[Array, Array]:
        """Triangles [N, k] of the template that may carry points, and where on them [N, k, 3]."""
        own = interpolate(self._dense.vertices, self._dense.faces[triangles], barycentrics)
        features = self._features(self._dense, self._weights, triangles, barycentrics, reach=reach)
        nearest = tree.query(features, k=min(CANDIDATES, len(self._samples)))[1].reshape(len(triangles), -1)
        carriers = self._samples[nearest]
        return carriers, nearest_barycentrics(own[:, None], self._coarse.vertices[self._coarse.faces[carriers]])

    def _features(self, mesh: Mesh, weights: Array, triangles: Array, barycentrics: Array, *, reach: float) -> Array:
        """Places [N, 3 + n] in a space where points that belong together are near."""
        places = interpolate(mesh.vertices, mesh.faces[triangles], barycentrics)
        skin = interpolate(weights @ self._directions, mesh.faces[triangles], barycentrics)
        return np.concatenate([places, reach * BEND * skin], axis=1)


def _carried_weights(character: Character) -> Array:
    """How far a turn of each joint carries each vertex along [V, J]: its weights and those of all joints below it."""
    weights = np.zeros((len(character.skin_weights), len(character.skeleton.parents)))
    np.add.at(weights, (np.arange(len(weights))[:, None], character.skin_indices), character.skin_weights)
    for joint in reversed(range(len(character.skeleton.parents))):  # parents come first
        parent = character.skeleton.parents[joint]
        if parent >= 0:
            weights[:, parent] += weights[:, joint]
    return weights


def _directions(weights: Array) -> Array:
    """The principal directions [J, n] of weights [V, J]."""
    centred = weights - weights.mean(axis=0)
    return np.asarray(np.linalg.eigh(centred.T @ centred)[1][:, -SKIN_DIRECTIONS:])


def _pieces(mesh: Mesh, template: Template) -> tuple[Array, Array]:
    """The connected pieces in texture space that the triangles [F] of a mesh and those of its template belong to."""
    keys = mesh.faces.astype(np.int64) * len(mesh.uv) + mesh.uv_faces  # a vertex once for each of its UVs
    nodes, corners = np.unique(keys, return_inverse=True)
    corners = corners.reshape(-1, 3)
    links = sparse.coo_matrix((np.ones(corners.size), (corners.ravel(), np.roll(corners, 1, axis=1).ravel())))
    piece = csgraph.connected_components(sparse.csr_matrix(links, shape=(len(nodes), len(nodes))), directed=False)[1]
    kept = template.mesh
    own = template.source_vertices[kept.faces[:, 0]].astype(np.int64) * len(mesh.uv)
    own += template.source_uv[kept.uv_faces[:, 0]]
    return piece[corners[:, 0]], piece[np.searchsorted(nodes, own)]
