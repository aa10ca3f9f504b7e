"""Quaternions (wxyz), the 6D rotation encoding and dual quaternions, in numpy, over any leading shape.

A dual quaternion is [..., 8]: the real part q (wxyz), then the dual part 0.5 (0, t) q
(Kavan et al. 2007, https://doi.org/10.1145/1230100.1230107).
"""

import numpy as np

from mua.arrays import Array


def normalize(q: Array) -> Array:
    """Scale quaternions [..., 4] to unit length."""
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def multiply(a: Array, b: Array) -> Array:
    """Hamilton product of quaternions [..., 4]: the rotation b, then a."""
    aw, ax, ay, az = (a[..., part] for part in range(4))
    bw, bx, by, bz = (b[..., part] for part in range(4))
    w = aw * bw - ax * bx - ay * by - az * bz
    product = np.empty((*w.shape, 4), dtype=w.dtype)
    product[..., 0] = w
    product[..., 1] = aw * bx + ax * bw + ay * bz - az * by
    product[..., 2] = aw * by - ax * bz + ay * bw + az * bx
    product[..., 3] = aw * bz + ax * by - ay * bx + az * bw
    return product


def conjugate(q: Array) -> Array:
    """Conjugate of quaternions [..., 4]; the inverse where they are unit."""
    return np.asarray(q * np.array([1, -1, -1, -1], dtype=q.dtype))


def rotate(q: Array, v: Array) -> Array:
    """Rotate vectors [..., 3] by unit quaternions [..., 4]."""
    w, x, y, z = (q[..., part] for part in range(4))
    vx, vy, vz = (v[..., part] for part in range(3))
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    turned = np.empty((*tx.shape, 3), dtype=tx.dtype)
    turned[..., 0] = vx + w * tx + (y * tz - z * ty)
    turned[..., 1] = vy + w * ty + (z * tx - x * tz)
    turned[..., 2] = vz + w * tz + (x * ty - y * tx)
    return turned


def from_axis_angle(axis: Array, angle: Array | float) -> Array:
    """Unit quaternions [..., 4] from unit axes [..., 3] and angles [...] in radians."""
    half = np.asarray(angle)[..., None] / 2
    axis = np.asarray(axis, dtype=float)
    cosine = np.broadcast_to(np.cos(half), (*np.broadcast_shapes(half.shape[:-1], axis.shape[:-1]), 1))
    return np.concatenate([cosine, np.sin(half) * axis], axis=-1)


def to_matrix(q: Array) -> Array:
    """Rotation matrices [..., 3, 3] (column vectors) of unit quaternions [..., 4]."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(m: Array) -> Array:
    """Unit quaternions [..., 4], w >= 0, of rotation matrices [..., 3, 3].

    Each of the four quaternion components gives one stable formula; the largest is used
    (Shepperd 1978, https://doi.org/10.2514/3.55767b).
    """
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    yz, zx, xy = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    sxy, szx, syz = m[..., 1, 0] + m[..., 0, 1], m[..., 0, 2] + m[..., 2, 0], m[..., 2, 1] + m[..., 1, 2]
    candidates = (
        (1 + xx + yy + zz, yz, zx, xy),
        (yz, 1 + xx - yy - zz, sxy, szx),
        (zx, sxy, 1 - xx + yy - zz, syz),
        (xy, szx, syz, 1 - xx - yy + zz),
    )
    largest = np.argmax([candidates[part][part] for part in range(4)], axis=0)
    q = normalize(np.stack([np.choose(largest, parts) for parts in zip(*candidates, strict=True)], axis=-1))
    return np.where(q[..., :1] < 0, -q, q)


def between(a: Array, b: Array) -> Array:
    """The shortest rotations [..., 4] that take unit vectors a [..., 3] to unit vectors b [..., 3]."""
    a, b = np.broadcast_arrays(np.asarray(a, dtype=float), np.asarray(b, dtype=float))
    dot = np.sum(a * b, axis=-1, keepdims=True)
    q = np.concatenate([1 + dot, np.cross(a, b)], axis=-1)
    least = np.eye(3)[np.argmin(np.abs(a), axis=-1)]  # any axis across a serves for a half turn
    across = np.cross(a, least)
    half_turn = np.concatenate([np.zeros_like(dot), across / np.linalg.norm(across, axis=-1, keepdims=True)], axis=-1)
    return normalize(np.where(dot < -1 + 1e-9, half_turn, q))


def slerp(a: Array, b: Array, t: Array) -> Array:
    """Interpolate unit quaternions a, b [..., 4] along the shorter arc at t [...] in 0..1."""
    dot = np.sum(a * b, axis=-1, keepdims=True)
    b = np.where(dot < 0, -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0, 1))
    t = np.asarray(t)[..., None]
    small = angle < 1e-6
    sine = np.where(small, 1, np.sin(angle))
    wa = np.where(small, 1 - t, np.sin((1 - t) * angle) / sine)
    wb = np.where(small, t, np.sin(t * angle) / sine)
    return normalize(wa * a + wb * b)


def to_6d(q: Array) -> Array:
    """The first two matrix columns [..., 6] of unit quaternions (Zhou et al. 2019, https://arxiv.org/abs/1812.07035)."""
    m = to_matrix(q)
    return np.concatenate([m[..., 0], m[..., 1]], axis=-1)


def dual_from_rigid(q: Array, t: Array) -> Array:
    """Dual quaternions [..., 8] of the rotation q [..., 4], then the translation t [..., 3]."""
    pure = np.concatenate([np.zeros_like(t[..., :1]), t], axis=-1)
    return np.concatenate([q, 0.5 * multiply(pure, q)], axis=-1)


def dual_multiply(a: Array, b: Array) -> Array:
    """Product of dual quaternions [..., 8]: the transform b, then a."""
    ar, ad, br, bd = a[..., :4], a[..., 4:], b[..., :4], b[..., 4:]
    return np.concatenate([multiply(ar, br), multiply(ar, bd) + multiply(ad, br)], axis=-1)


def dual_translation(d: Array) -> Array:
    """Translations [..., 3] of unit dual quaternions [..., 8]."""
    return multiply(2 * d[..., 4:], conjugate(d[..., :4]))[..., 1:]


def dual_transform(d: Array, v: Array) -> Array:
    """Move points [..., 3] by unit dual quaternions [..., 8]."""
    return np.asarray(rotate(d[..., :4], v) + dual_translation(d))


def dual_inverse(d: Array) -> Array:
    """Inverse of unit dual quaternions [..., 8]."""
    return np.concatenate([conjugate(d[..., :4]), conjugate(d[..., 4:])], axis=-1)
