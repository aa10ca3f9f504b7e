"""Quaternions, dual quaternions and what is moved by them, along the last axis: sections 1 and 3."""

import numpy as np
from oracle.file import Array

LEAST = np.finfo(np.float32).tiny  # the least positive normal number, for a length of 0


def multiply(a: Array, b: Array) -> Array:
    """1.2: the Hamilton product."""
    w, v, s, u = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    return np.concatenate([w * s - np.sum(v * u, axis=-1, keepdims=True), w * u + s * v + np.cross(v, u)], axis=-1)


def conjugate(q: Array) -> Array:
    """1.2 of a quaternion, 1.3 of a dual quaternion."""
    return q * np.resize([1, -1, -1, -1], q.shape[-1])


def pure(v: Array) -> Array:
    """1.2: (0, v)."""
    return np.concatenate([np.zeros_like(v[..., :1]), v], axis=-1)


def rotate(q: Array, v: Array) -> Array:
    """1.2"""
    return multiply(multiply(q, pure(v)), conjugate(q))[..., 1:]


def normalise(q: Array) -> Array:
    """q / |q|, of a dual quaternion by its real part, with the rule of 6.5 for a length of 0."""
    return q / np.maximum(np.linalg.norm(q[..., :4], axis=-1, keepdims=True), LEAST)


def rigid(q: Array, t: Array) -> Array:
    """1.3: the rotation q, then the translation t."""
    return np.concatenate([q, 0.5 * multiply(pure(t), q)], axis=-1)


def compose(a: Array, b: Array) -> Array:
    """1.3: the product of dual quaternions."""
    dual = multiply(a[..., :4], b[..., 4:]) + multiply(a[..., 4:], b[..., :4])
    return np.concatenate([multiply(a[..., :4], b[..., :4]), dual], axis=-1)


def apply(a: Array, p: Array) -> Array:
    """1.3: the points p, moved."""
    return rotate(a[..., :4], p) + 2 * multiply(a[..., 4:], conjugate(a[..., :4]))[..., 1:]


def six(q: Array) -> Array:
    """3.3"""
    w, x, y, z = np.moveaxis(q, -1, 0)
    first = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    return np.stack([*first, 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], axis=-1)


def columns(q: Array) -> Array:
    """12.3: the columns of 3.3 and their cross product, as a matrix [3, 3]."""
    first, second = np.split(six(q), 2)
    return np.column_stack([first, second, np.cross(first, second)])


def from_columns(r: Array) -> Array:
    """12.3: the unit quaternion [4] of a rotation matrix [3, 3], w >= 0: an eigenvector of sums of its elements."""
    (a, b, c), (d, e, f), (g, h, i) = r
    w, x = [a + e + i, h - f, c - g, d - b], [h - f, a - e - i, b + d, c + g]
    y, z = [c - g, b + d, e - a - i, f + h], [d - b, c + g, f + h, i - a - e]
    q = np.linalg.eigh(np.array([w, x, y, z]))[1][:, -1]
    return -q if q[0] < 0 else q
