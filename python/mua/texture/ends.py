"""Where the surface ends or turns away, its surfels end as well: at hems, fingertips and folds none stands out.

Each counts as on the surface where its own connected piece is near: an eyelid ends before the eye, not on it. Over a
crease a surfel lies off both its sides, and keeps what it has to cover: shorter, it would open a gap along the crease.
"""

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.charts import pieces_of
from mua.rig.surface_points import face_normals, nearest_barycentrics
from mua.texture.footprints import Samples

EDGE = 1.2  # standard deviations from its centre at which a surfel is about half opaque: its outline
AWAY = 0.4  # distance of the outline from the surface over that from the centre: less would open round or layered parts
LEAST = 0.25  # of its reach to one side that a surfel keeps
TURNED = 0.8  # cosine between surfel and surface from which that is its own: over a crease, not around a hem
HALVINGS = 4  # of the range in which the outline is sought
NEAREST = 3, 24  # triangles among which the nearest point is sought, at first and where that is far
APART = 10.0  # times the surface's size, between its pieces in the space in which the nearest triangles are sought


def end_at_surface(
    mesh: Mesh,
    samples: Samples,
    *,
    triangles: Array,  # [N] on which the surfels lie
    frames: Array,  # [N, 3, 3] columns x, y, z
    centres: Array,  # [N, 3] metres
    extents: Array,  # [N, 2] standard deviations along x and y, metres
) -> tuple[Array, Array]:
    """Move and shorten surfels that reach beyond the surface, so that their outlines lie on it.

    Returns shifts [N, 3] of the centres, metres, and extents [N, 2].
    """
    axes = frames[:, :, :2].transpose(0, 2, 1)
    sides = np.stack([axes, -axes], axis=2).reshape(-1, 3)  # [N * 4, 3], both sides of x, then of y
    starts = np.repeat(centres, 4, axis=0)
    reach = np.repeat(EDGE * extents, 2)
    own = _Pieces(mesh, samples)
    piece = np.repeat(own.pieces[triangles], 4)
    far = np.flatnonzero(own.lie_off(starts + reach[:, None] * sides, reach, piece))
    low, high = LEAST * reach[far], reach[far]
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        off = own.lie_off(starts[far] + middle[:, None] * sides[far], middle, piece[far])
        low, high = np.where(off, low, middle), np.where(off, middle, high)
    covered = _extents(
        mesh,
        samples,
        own=own.pieces[samples.triangles] == own.pieces[triangles[samples.texels]],
        frames=frames,
        centres=centres,
    ).ravel()
    reach[far] = np.maximum(low, np.minimum(covered, reach)[far])
    there, back = np.moveaxis(reach.reshape(-1, 2, 2), 2, 0)
    return np.einsum("nkc,nk->nc", axes, (there - back) / 2), (there + back) / (2 * EDGE)


def _extents(
    mesh: Mesh,
    samples: Samples,
    *,
    own: Array,  # [S] bool, on the piece of the surfel that has to cover it
    frames: Array,  # [N, 3, 3] columns x, y, z
    centres: Array,  # [N, 3] metres
) -> Array:
    """How far the surface that each surfel has to cover and that faces its way reaches: [N, 2 axes, 2 sides] metres."""
    texels, facing = samples.texels, face_normals(mesh)[samples.triangles]
    covered = own & ~samples.bare & (np.einsum("sc,sc->s", facing, frames[texels, :, 2]) > TURNED)
    texels, places = texels[covered], samples.places[covered]
    away = np.einsum("sc,sck->sk", places - centres[texels], frames[texels][:, :, :2])
    extents = np.zeros((len(centres), 2, 2))
    for (axis, side), sign in zip(np.ndindex(2, 2), (1, -1, 1, -1), strict=True):
        np.maximum.at(extents[:, axis, side], texels, sign * away[:, axis])
    return extents


class _Pieces:
    """The connected pieces of a surface, each of which its own surfels end with."""

    def __init__(self, mesh: Mesh, samples: Samples) -> None:
        self.pieces = pieces_of(mesh)  # [F]
        self._corners, self._triangles = mesh.vertices[mesh.faces], samples.triangles
        self._apart = APART * float(np.ptp(mesh.vertices, axis=0).max())
        self._tree = cKDTree(self._among(samples.places, self.pieces[samples.triangles]), balanced_tree=False)

    def lie_off(
        self,
        places: Array,  # [n, 3] metres
        reach: Array,  # [n] their distances from the centres of their surfels, metres
        pieces: Array,  # [n] on which these surfels lie
    ) -> Array:
        """Which places [n] lie farther from their piece than AWAY allows at that distance from their centres."""
        if not self._tree.n:
            return np.zeros(len(places), bool)
        among, near = self._among(places, pieces), AWAY * reach
        off = self._tree.query(among, distance_upper_bound=near.max(initial=0), workers=-1)[0] > near  # of samples
        for count in NEAREST:
            rows = np.flatnonzero(off)
            if not len(rows):
                break
            found = self._tree.query(among[rows], k=range(1, min(count, self._tree.n) + 1), workers=-1)[1]
            corners = self._corners[self._triangles[found]]
            nearest = np.einsum("nkc,nkcd->nkd", nearest_barycentrics(places[rows, None], corners), corners)
            away = nearest - places[rows, None]
            squares = np.einsum("nkc,nkc->nk", away, away).min(axis=1)
            off[rows] = squares > near[rows] ** 2
        return off

    def _among(self, places: Array, pieces: Array) -> Array:
        """Places [n, 4] of which those on other pieces are far away."""
        return np.column_stack([places, self._apart * pieces])
