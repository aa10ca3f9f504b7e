"""Posing: joints' dual quaternions blended at vertices, vertices' at texels, then one Gaussian splat per texel.

A dual quaternion is [8]: the real part q (wxyz), then the dual part 0.5 (0, t) q. Blending is linear, each term on the
hemisphere of a reference, then divided by the norm of the real part, without orthogonalisation (Kavan et al. 2007,
https://doi.org/10.1145/1230100.1230107). Texture channels are those of mua.channels.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array

LARGEST_LOG_SCALE = 10.0  # 22 km, far beyond what is packed; no exponential overflows below it


def blend_vertices(
    joints: Array,  # [J, 8] bind pose to world
    indices: Array,  # [V, 8] joints, largest weight first
    weights: Array,  # [V, 8] rows sum to 1
) -> Array:
    """Dual quaternions [V, 8] of the vertices, bind pose to world; the reference of the signs is column 0."""
    reference = joints[indices[:, 0], :4]
    total = np.zeros((len(indices), 8), dtype=joints.dtype)
    for joint, weight in zip(indices.T, weights.T, strict=True):
        if weight.any():  # most vertices have fewer influences
            _accumulate(total, joints[joint], weight, reference)
    return _normalize(total)


def blend_texels(
    vertex_dq: Array,  # [V, 8]
    faces: Array,  # [F, 3] into vertices
    triangles: Array,  # [N] into faces
    barycentrics: Array,  # [N, 3]
) -> Array:
    """Dual quaternions [N, 8] of the texels; the reference of the signs is the vertex of largest barycentric."""
    corners = faces[triangles]
    nearest = np.take_along_axis(corners, np.argmax(barycentrics, axis=1)[:, None], axis=1)[:, 0]
    reference = vertex_dq[nearest, :4]
    total = np.zeros((len(triangles), 8), dtype=vertex_dq.dtype)
    for corner, weight in zip(corners.T, barycentrics.T, strict=True):
        _accumulate(total, vertex_dq[corner], weight, reference)
    return _normalize(total)


def skin_splats(
    texel_dq: Array,  # [N, 8]
    mesh: Array,  # [V, 3] canonical vertices, metres
    faces: Array,  # [F, 3] into vertices
    triangles: Array,  # [N] into faces
    barycentrics: Array,  # [N, 3]
    texture: Array,  # [N, 23] raw channels
) -> tuple[Array, Array, Array, Array]:
    """Activate the geometry channels and pose them.

    Returns centres [N, 3] (world, metres), rotations [N, 4] (world, unit, wxyz), scales [N, 3] (standard deviations,
    metres) and opacities [N] in 0..1.
    """
    corners = faces[triangles]
    canonical = texture[:, 0:3].astype(texel_dq.dtype)
    for corner, weight in zip(corners.T, barycentrics.T, strict=True):
        canonical += weight[:, None].astype(texel_dq.dtype) * mesh[corner]
    centres = rotation.dual_transform(texel_dq, canonical)
    rotations = rotation.multiply(texel_dq[:, :4], _unit(texture[:, 3:7]))
    scales = np.exp(np.minimum(texture[:, 7:10], texture.dtype.type(LARGEST_LOG_SCALE)))
    opacities = 0.5 + 0.5 * np.tanh(0.5 * texture[:, 10])  # the logistic function, without overflow
    return centres, rotations, scales, opacities


def covariances(
    rotations: Array,  # [N, 4] unit
    scales: Array,  # [N, 3] metres
) -> Array:
    """Covariances [N, 6] (xx, xy, xz, yy, yz, zz; square metres): R diag(s^2) R^T."""
    axes = rotation.to_matrix(rotations) * scales[:, None, :]
    rows, columns = np.triu_indices(3)
    return np.stack([np.sum(axes[:, i] * axes[:, j], axis=1) for i, j in zip(rows, columns, strict=True)], axis=1)


def _accumulate(
    total: Array,  # [N, 8], added to
    dual: Array,  # [N, 8]
    weight: Array,  # [N]
    reference: Array,  # [N, 4]
) -> None:
    """Add weight x dual on the hemisphere of the reference."""
    dot = np.einsum("ni,ni->n", dual[:, :4], reference)
    signed = np.where(dot < 0, -weight, weight).astype(total.dtype)
    total += signed[:, None] * dual


def _normalize(
    total: Array,  # [N, 8]
) -> Array:
    return np.asarray(total / _norm(total[:, :4]))


def _unit(
    q: Array,  # [N, 4]
) -> Array:
    return np.asarray(q / _norm(q))


def _norm(
    q: Array,  # [N, 4]
) -> Array:
    """Norms [N, 1], never zero: rotations that cancel give a finite splat, not NaN."""
    return np.maximum(np.sqrt(np.einsum("ni,ni->n", q, q)), np.finfo(q.dtype).tiny)[:, None]
