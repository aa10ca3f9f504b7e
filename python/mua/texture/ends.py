"""Where the surface ends or turns away, its surfels end as well: at hems, fingertips and folds none stands out."""

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.surface_points import nearest_barycentrics
from mua.texture.footprints import Samples

EDGE = 1.2  # standard deviations from its centre at which a surfel is about half opaque: its outline
AWAY = 0.4  # distance of the outline from the surface over that from the centre: less would open round or layered parts
LEAST = 0.25  # of its reach to one side that a surfel keeps
HALVINGS = 4  # of the range in which the outline is sought
NEAREST = 3, 24  # triangles among which the nearest point is sought, at first and where that is far


def end_at_surface(
    mesh: Mesh,
    samples: Samples,
    *,
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
    far = np.flatnonzero(_lies_off(mesh, samples, starts + reach[:, None] * sides, reach))
    low, high = LEAST * reach[far], reach[far]
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        off = _lies_off(mesh, samples, starts[far] + middle[:, None] * sides[far], middle)
        low, high = np.where(off, low, middle), np.where(off, middle, high)
    reach[far] = low
    there, back = np.moveaxis(reach.reshape(-1, 2, 2), 2, 0)
    return np.einsum("nkc,nk->nc", axes, (there - back) / 2), (there + back) / (2 * EDGE)


def _lies_off(mesh: Mesh, samples: Samples, places: Array, reach: Array) -> Array:
    """Which places [n, 3] lie farther from the surface than AWAY allows at that distance [n] from their centres."""
    off, tree = np.full(len(places), len(samples.places) > 0), cKDTree(samples.places)
    for count in NEAREST:
        rows = np.flatnonzero(off)
        if not len(rows):
            break
        near = tree.query(places[rows], k=range(1, min(count, len(samples.places)) + 1), workers=-1)[1]
        corners = mesh.vertices[mesh.faces[samples.triangles[near]]]
        nearest = np.einsum("nkc,nkcd->nkd", nearest_barycentrics(places[rows, None], corners), corners)
        off[rows] = np.linalg.norm(nearest - places[rows, None], axis=2).min(axis=1) > AWAY * reach[rows]
    return off
