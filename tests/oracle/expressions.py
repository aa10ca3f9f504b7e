"""A face that moves: section 12."""

import numpy as np
from oracle.file import Array, Record
from oracle.motion import Pose
from oracle.quaternions import LEAST, columns, from_columns, multiply, normalise

SHORTEST, LARGEST = 0.00001, 20


def moved(avatar: Record, pose: Pose) -> Array:
    """12.1: m [V, 3]"""
    found = np.zeros_like(avatar.coarse.mean)
    table = avatar.expressions
    if table is not None and pose.weights is not None:
        for e, weight in enumerate(pose.weights):
            for k in range(table.starts[e], table.starts[e + 1]):
                found[table.vertices[k]] += weight * table.offsets[k]
    return found


def frame(corners: Array) -> tuple[Array, Array, Array] | None:
    """12.2: x, y, n as columns, and the two edges in the plane; none where l or h is too short."""
    a, b, c = corners
    length = np.linalg.norm(b - a)
    x = (b - a) / max(length, LEAST)
    s = x @ (c - a)
    rest = c - a - s * x
    h = np.linalg.norm(rest)
    if length < SHORTEST or h < SHORTEST:
        return None
    axes = np.column_stack([x, rest / h, np.cross(x, rest / h)])
    return axes, np.array([[length, s, 0], [0, h, 0], [0, 0, 1]]), c


def bend(texture: Array, corners: Array, v: Array, m: Array) -> Array:
    """12.3: T [N, 23] of texels whose triangles have these corners [N, 3]."""
    bent = texture.copy()
    for e in np.flatnonzero((m[corners] != 0).any(axis=(1, 2))):
        before, after = (frame(mesh[corners[e]]) for mesh in (v, v + m))
        if before is None or after is None:
            continue
        f = after[0] @ after[1] @ np.linalg.inv(before[0] @ before[1])
        left, _, right = np.linalg.svd(f)
        r = left @ right
        bent[e, 0:3] = r @ texture[e, 0:3]
        bent[e, 3:7] = multiply(from_columns(r), texture[e, 3:7])
        stretch = np.linalg.norm(f @ columns(normalise(texture[e, 3:7])), axis=0)
        bent[e, 7:10] += np.log(np.clip(stretch, 1 / LARGEST, LARGEST))
    return bent
