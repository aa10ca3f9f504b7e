"""Sections 1.2 and 1.3 of schemas/README.md: quaternions and dual quaternions, along the last axis."""

from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]
TINY = np.finfo(np.float32).tiny  # the least positive normal number, for a length of 0


def product(p: Array, q: Array) -> Array:
    """1.2: Hamilton's."""
    a, u, b, v = p[..., :1], p[..., 1:], q[..., :1], q[..., 1:]
    scalar = a * b - np.sum(u * v, axis=-1, keepdims=True)
    return np.concatenate([scalar, a * v + b * u + np.cross(u, v)], axis=-1)


def star(q: Array) -> Array:
    """1.2 of four numbers, 1.3 of eight."""
    return q * np.tile([1.0, -1, -1, -1], q.shape[-1] // 4)


def vector(v: Array) -> Array:
    return np.concatenate([np.zeros((*v.shape[:-1], 1)), v], axis=-1)


def rotate(q: Array, v: Array) -> Array:
    return product(product(q, vector(v)), star(q))[..., 1:]


def unit(q: Array) -> Array:
    return np.asarray(q / np.maximum(np.linalg.norm(q, axis=-1, keepdims=True), TINY))


def rigid(q: Array, t: Array) -> Array:
    """1.3"""
    return np.concatenate([q, 0.5 * product(vector(t), q)], axis=-1)


def dual_product(p: Array, q: Array) -> Array:
    """1.3"""
    r, d, s, e = p[..., :4], p[..., 4:], q[..., :4], q[..., 4:]
    return np.concatenate([product(r, s), product(r, e) + product(d, s)], axis=-1)


def apply(q: Array, p: Array) -> Array:
    """1.3"""
    r, d = q[..., :4], q[..., 4:]
    return rotate(r, p) + 2 * product(d, star(r))[..., 1:]
