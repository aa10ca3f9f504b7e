"""UV charts: pieces of surface that are connected in texture space, as an artist or xatlas cut them."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from mua.arrays import Array, unique_rows
from mua.rig.character import Mesh

SPECK = 4 / 512**2  # UV area, 4 texels of a map of 512, below which a fold is no chart


def charts_of(mesh: Mesh) -> Array:
    """The UV chart [F] of each face."""
    pairs = np.stack([mesh.faces, mesh.uv_faces], axis=-1).reshape(-1, 2)
    nodes = unique_rows(pairs)[2].reshape(-1, 3)
    return find_charts(nodes, mesh.uv[mesh.uv_faces])


def pieces_of(mesh: Mesh) -> Array:
    """The connected piece of the surface [F] that each face belongs to."""
    count, first = len(mesh.vertices), mesh.faces[:, :1]
    ends = np.broadcast_to(first, (len(first), 2)).ravel(), mesh.faces[:, 1:].ravel()
    links = coo_matrix((np.ones(len(ends[0])), ends), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1][mesh.faces[:, 0]])


def find_charts(
    nodes: Array,  # [F, 3] int, equal where corners share vertex, UV and material
    corners: Array,  # [F, 3, 2] UV
) -> Array:
    """Number the charts: triangles that share an edge in space and in UV and are not folded over it.

    Returns [F] int32. A mirrored half that meets the other half along an edge is a chart of its own; a folded sliver
    stays with a neighbour.
    """
    ends = np.sort(np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    face = np.repeat(np.arange(len(nodes)), 3)
    order = np.lexsort((face, ends[:, 1], ends[:, 0]))
    same = (ends[order[1:]] == ends[order[:-1]]).all(axis=1)
    a, b = face[order[:-1]][same], face[order[1:]][same]
    area = signed_areas(corners)
    flat = np.sign(area[a]) * np.sign(area[b]) >= 0
    links = coo_matrix((np.ones(flat.sum()), (a[flat], b[flat])), shape=(len(nodes), len(nodes)))
    count, charts = connected_components(links, directed=False)
    speck = np.bincount(charts, np.abs(area), minlength=count) < SPECK
    joins = np.arange(count)
    for one, other in ((charts[a], charts[b]), (charts[b], charts[a])):
        across = speck[one] & ~speck[other]
        joins[one[across]] = other[across]
    return np.unique(joins[charts], return_inverse=True)[1].astype(np.int32)


def signed_areas(
    corners: Array,  # [F, 3, 2]
) -> Array:
    """Area of each UV triangle [F], negative where it is mirrored."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def areas(
    corners: Array,  # [F, 3, 2 or 3]
) -> Array:
    """Area of each triangle [F]."""
    # Also in UV; trimesh's are 0.3 ms faster on 12,000 triangles, and round 64 % of them to other last bits.
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    squares = (a * a).sum(axis=1) * (b * b).sum(axis=1) - (a * b).sum(axis=1) ** 2
    return np.sqrt(np.maximum(squares, 0)) / 2
