"""The triangles of an avatar's surface, and those about each texel, by which its normal is found when it is posed."""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar


@dataclass(frozen=True, eq=False)
class SurfaceMesh:
    """Triangles over N texels, counter-clockwise seen from outside, and the triangles about each texel.

    unity-package/Runtime/TexelGrid.cs lists the same.
    """

    triangles: Array  # [T, 3] uint32 into the texels
    ring_starts: Array  # [N + 1] uint32 into `ring`
    ring: Array  # [3 T, 2] uint32: the other two corners of each triangle about a texel, in turning order


def surface_mesh(avatar: Avatar) -> SurfaceMesh:
    """The file's surface; a file without one is triangulated here."""
    surface, texels = avatar.surface, avatar.rig.texels
    if surface is None:
        from mua.rig.triangulate import triangulate  # needs more packages than reading does

        surface = triangulate(avatar.rig.mesh, texels)
    return rings(surface.triangles(texels), len(texels.texels))


def rings(triangles: Array, count: int) -> SurfaceMesh:
    """The mesh of triangles over `count` corners: the triangles as they are, and sorted about each corner."""
    ring = np.concatenate([np.roll(triangles, -k, axis=1) for k in range(3)])
    order = np.argsort(ring[:, 0], kind="stable")
    starts = np.searchsorted(ring[order, 0], np.arange(count + 1))
    return SurfaceMesh(triangles.astype(np.uint32), starts.astype(np.uint32), ring[order, 1:].astype(np.uint32))
