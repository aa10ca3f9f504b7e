"""How much longer the axes of surfels become as the surface that they lie on is stretched, each axis by itself."""

import numpy as np

from mua import rotation
from mua.arrays import Array

HOLD = float(np.log(1.3))  # how far a stretch that is smooth over the vertices may differ from that of the own triangle
WIDTH = 2.0  # deviations, about the way from one surfel to the next: what of a surfel is to lie on its triangle
SHORTEST = 0.05  # of its length at rest: a surfel on a triangle that is squeezed to nothing
LEAN = 0.5  # how far a stretched surfel's end may leave the plane of its triangle, over how far it reaches at rest
LONGEST = 5.0  # times its length at rest: on an armpit that opens tenfold, a flat surfel would stand out of the body


class SurfelStretch:
    """The stretch of each surfel's x and y.

    It is taken from the strain about the vertices, which runs smoothly from texel to texel, and held within a factor
    of that of the surfel's own triangle: where one ring of triangles alone is pulled apart, its surfels still reach
    one another, and those beside it stay as they are. Of a surfel that is wider than its triangle, only as much
    follows the triangle as lies on it: a sliver that opens to thirty times its width takes no surfel along. Surfels
    turn more smoothly than triangles do: one that leans out of its own grows less, or it would stand off the surface.
    """

    def __init__(
        self,
        vertices: Array,  # [V, 3] at rest
        faces: Array,  # [F, 3]
        *,
        triangles: Array,  # [N] into the faces
        barycentrics: Array,  # [N, 3]
        rotations: Array,  # [N, 4] of the surfels at rest
        deviations: Array,  # [N, 2] of the surfels at rest along x and y, metres
    ) -> None:
        axes = rotation.to_matrix(rotations)
        used, of_texel = np.unique(triangles, return_inverse=True)
        a, b, c = vertices[faces[used]].swapaxes(0, 1)
        edges = np.stack([b - a, c - a], axis=2)  # [n, 3, 2]
        inverses = np.linalg.pinv(edges, rcond=1e-6)
        coordinates = inverses[of_texel] @ axes[:, :, :2]  # of the axes' shadows on the triangle
        length = np.linalg.norm(edges[of_texel] @ coordinates, axis=1, keepdims=True)
        coordinates /= np.where(length > 0, length, np.inf)
        u, v = coordinates.swapaxes(0, 1)
        across = np.maximum(np.maximum(np.abs(u), np.abs(v)), np.abs(u + v))  # of the triangles that a metre crosses
        self._on_triangle = np.ascontiguousarray(1 / np.maximum(WIDTH * deviations * across, 1).T)  # shares of x and y
        self._faces, self._triangles, self._barycentrics, self._rest = faces, triangles, barycentrics, rotations
        self._axes = [_squares(*(axes[:, i, k] for i in range(3))) for k in (0, 1)]
        self._coordinates = [_squares(*(coordinates[:, i, k] for i in (0, 1))) for k in (0, 1)]

    def __call__(
        self,
        vertices: Array,  # [V, 3] deformed
        strain: Array,  # [6, N] of the surface at the texels, as mua.texture.surfels.SurfaceFrames measures it
        turn: Array,  # [V, 4] that carries the surfels about each vertex from rest; unit
    ) -> Array:
        """Logarithms [2, N] of the lengths of x and y over those at rest."""
        a, b, c = np.ascontiguousarray(vertices.T)[:, self._faces.T].swapaxes(0, 1)  # [3, F] each
        e, f = b - a, c - a
        metric = np.stack([np.sum(p * q, axis=0) for p, q in ((e, e), (f, f), (e, f))])[:, self._triangles]
        logs = []
        for axes, coordinates, share in zip(self._axes, self._coordinates, self._on_triangle, strict=True):
            smooth = _length(1 + np.einsum("kn,kn->n", axes, strain))
            own = _length(np.einsum("kn,kn->n", coordinates, metric))
            own = np.minimum(own, smooth + share * (own - smooth))
            least = np.log(own) - HOLD
            logs.append(np.clip(np.log(smooth), least, least + 2 * HOLD).clip(max=np.log(LONGEST)))
        return self._leaning_less(np.stack(logs), vertices, turn)

    def _leaning_less(self, logs: Array, vertices: Array, turn: Array) -> Array:
        """Logarithms [2, N] that take no surfel's end far off the plane of its triangle; up to HOLD are free."""
        long = np.flatnonzero((logs > HOLD).any(axis=0))
        corners = self._faces[self._triangles[long]]
        a, b, c = vertices[corners].swapaxes(0, 1)
        across = np.cross(b - a, c - a)
        normals = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), np.finfo(float).tiny)
        turns = turn[corners]
        turns = np.where(np.einsum("nkq,nq->nk", turns, turns[:, 0])[:, :, None] < 0, -turns, turns)
        turns = rotation.normalize(np.einsum("nkq,nk->nq", turns, self._barycentrics[long]))
        axes = rotation.to_matrix(rotation.multiply(turns, self._rest[long]))[:, :, :2]
        off = np.abs(np.einsum("nc,nck->kn", normals, axes))
        most = np.maximum(np.log(LEAN / np.maximum(off, np.finfo(float).tiny)), HOLD)
        logs[:, long] = np.minimum(logs[:, long], most)
        return logs


def _squares(*components: Array) -> Array:
    """The weights of a symmetric matrix's entries [n, N] (its diagonal, then its upper half) in x . M x."""
    count = len(components)
    halves = [2 * components[i] * components[j] for i in range(count) for j in range(i + 1, count)]
    return np.stack([x * x for x in components] + halves)


def _length(square: Array) -> Array:
    return np.sqrt(np.maximum(square, SHORTEST**2))
