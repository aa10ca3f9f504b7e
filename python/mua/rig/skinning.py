"""Skinning of a dense surface: dual quaternions, as avatars bend, and the linear blend, as the character's file bends.

The dual quaternions are those of `mua.kernels.dq_skinning`, several times faster: each component of all vertices lies
in one piece of memory, and joints that do not move a vertex cost nothing. Which way round a joint's dual quaternion is
added depends only on it and the vertex's first joint, so it is found once for each pair of joints, not once a vertex.
"""

from typing import TYPE_CHECKING, Protocol

import numpy as np

from mua import rotation
from mua.arrays import Array, unique_rows
from mua.pose.skeleton import Skeleton

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


class Skinned(Protocol):
    """A surface of V vertices on a skeleton."""

    @property
    def skeleton(self) -> Skeleton: ...

    @property
    def skin_indices(self) -> Array: ...  # [V, 8] int32

    @property
    def skin_weights(self) -> Array: ...  # [V, 8] float32


class Skinning:
    """Blends transforms by one character's skin weights."""

    def __init__(
        self,
        indices: Array,  # [V, 8] joints, largest weight first
        weights: Array,  # [V, 8] rows sum to 1
    ) -> None:
        used = weights > 0
        counts = used.sum(axis=1)
        self._starts = np.concatenate([[0], np.cumsum(counts)])
        self._joints, self._weights = indices[used].astype(np.int64), weights[used].astype(np.float64)
        pairs = np.stack([np.repeat(indices[:, 0], counts).astype(np.int64), self._joints], axis=1)
        self._pairs, _, self._pair = unique_rows(pairs)

    def __call__(
        self,
        joints: Array,  # [J, 8] bind pose to world
    ) -> Array:
        """Dual quaternions [V, 8] of the vertices, bind pose to world."""
        first, other = joints[self._pairs, :4].swapaxes(0, 1)
        away = np.einsum("pi,pi->p", other, first) < 0
        weights = np.where(away[self._pair], -self._weights, self._weights) if away.any() else self._weights
        matrix = self._matrix(weights, len(joints))
        total = np.stack([matrix @ component for component in np.ascontiguousarray(joints.T)])
        total /= np.maximum(np.sqrt(np.einsum("in,in->n", total[:4], total[:4])), np.finfo(total.dtype).tiny)
        return total.T

    def linear(
        self,
        joints: Array,  # [J, 8] bind pose to world
        points: Array,  # [V, 3] the vertices or near them, bind pose
    ) -> Array:
        """Points [V, 3] in the world: the weighted mean of where each joint alone would carry them.

        File formats define skins this way, and artists choose weights by it; where joints turn far apart it lies
        inside the arc of the dual quaternions.
        """
        spaces = np.concatenate(
            [rotation.to_matrix(joints[:, :4]).reshape(-1, 9), rotation.dual_translation(joints)], 1
        )
        blended = self._matrix(self._weights, len(joints)) @ spaces
        return np.asarray(np.einsum("vij,vj->vi", blended[:, :9].reshape(-1, 3, 3), points) + blended[:, 9:])

    def _matrix(self, weights: Array, joints: int) -> "csr_matrix":
        """The weights of each vertex as a sparse matrix [V, joints]."""
        from scipy.sparse import csr_matrix  # here, because it is slow to import and few need it

        return csr_matrix((weights, self._joints, self._starts), shape=(len(self._starts) - 1, joints))


def transform(
    dual: Array,  # [V, 8] unit
    points: Array,  # [V, 3]
) -> Array:
    """Points [V, 3] moved as `mua.rotation.dual_transform` does, component by component."""
    w, x, y, z, dw, dx, dy, dz = dual.T
    px, py, pz = np.ascontiguousarray(points.T)
    tx, ty, tz = 2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)
    moved = np.empty((3, len(points)))
    moved[0] = px + w * tx + (y * tz - z * ty) + 2 * (w * dx - x * dw + y * dz - z * dy)
    moved[1] = py + w * ty + (z * tx - x * tz) + 2 * (w * dy - y * dw + z * dx - x * dz)
    moved[2] = pz + w * tz + (x * ty - y * tx) + 2 * (w * dz - z * dw + x * dy - y * dx)
    return moved.T


def moving_joints(surface: Skinned) -> Array:
    """Whether each joint [J] moves the surface itself or through a descendant."""
    skeleton = surface.skeleton
    moving = np.zeros(len(skeleton.names), dtype=bool)
    moving[np.unique(surface.skin_indices[surface.skin_weights > 0])] = True
    for joint in range(len(moving) - 1, -1, -1):  # parents come before children
        if moving[joint] and skeleton.parents[joint] >= 0:
            moving[skeleton.parents[joint]] = True
    return moving
