"""Texels of long triangles, brought back from the arcs on which their transforms carry them.

A texel's transform is blended from those of its triangle's corners. Where these turn far apart, as at the knee of a
character of few triangles, the points between move on arcs, while the triangle that they lie on stays flat.
"""

from collections.abc import Callable

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_texels, blend_vertices
from mua.rig.rig import Rig

SEEN = 1e-3  # of the character's size: height of an arc above its chord from which on it is straightened


def straighten(
    texture: Array,  # [N, 23] raw channels, changed in place
    rig: Rig,
    *,
    joints: Array,  # [J, 8] bind pose to world
    mesh: Array,  # [T, 3] canonical vertices of the template, metres
    moved: Array,  # [V, 3] the dense surface in the world, metres
    canonical: Array,  # [V, 3] the same in canonical space
    places: Callable[[Array, Array], Array],  # of such a surface and texels [n], where these lie on it, [n, 3]
) -> None:
    """Change the offsets of texels that would leave their surface so that they lie on it."""
    faces, triangles = rig.mesh.faces, rig.texels.triangles
    duals = blend_vertices(joints, rig.skin_indices, rig.skin_weights)
    size = float(np.ptp(rig.mesh.vertices, axis=0).max()) or 1.0
    beyond = bent(duals, mesh, faces, size=size)
    anywhere = np.asarray(beyond[faces].any(axis=1))
    texels = np.flatnonzero(anywhere[triangles])  # few of them, on most frames none
    if not len(texels):
        return
    triangles, barycentrics = triangles[texels], rig.texels.barycentrics[texels]
    share = np.einsum("nk,nk->n", barycentrics, beyond[faces[triangles]])
    back = rotation.dual_inverse(blend_texels(duals, faces, triangles, barycentrics))
    astray = rotation.dual_transform(back, places(moved, texels)) - places(canonical, texels)
    texture[texels, :3] += share[:, None] * astray


def bent(
    duals: Array,  # [T, 8] bind pose to world
    mesh: Array,  # [T, 3] canonical vertices, metres
    faces: Array,  # [F, 3]
    *,
    size: float,  # of the character, metres
) -> Array:
    """How far [T] points about each vertex are to be straightened, 0 .. 1: neighbouring triangles part nowhere."""
    beyond = np.zeros(len(mesh))
    heights = np.clip(_arc_heights(duals, mesh, faces) / (SEEN * size) - 1, 0, 1)
    np.maximum.at(beyond, faces.ravel(), np.repeat(heights, 3))
    return beyond


def _arc_heights(duals: Array, mesh: Array, faces: Array) -> Array:
    """How far [F] the middle of a triangle's longest arc rises above its chord, metres: length x angle / 8."""
    posed = rotation.dual_transform(duals, mesh)
    heights = np.zeros(len(faces))
    for a, b in ((0, 1), (1, 2), (2, 0)):
        i, j = faces[:, a], faces[:, b]
        cosines = np.abs(np.sum(duals[i, :4] * duals[j, :4], axis=-1))
        angles = 2 * np.arccos(np.minimum(cosines, 1))
        lengths = np.maximum(*(np.linalg.norm(at[i] - at[j], axis=-1) for at in (posed, mesh)))
        heights = np.maximum(heights, lengths * angles / 8)
    return heights
