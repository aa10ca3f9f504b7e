"""A face that moves: section 12."""

import numpy as np
from oracle.file import Array, Record
from oracle.motion import Pose
from oracle.quaternions import LEAST, columns, from_columns, multiply, normalise

SHORTEST, LARGEST = 0.00001, 20
KINDS = range(3)  # blinks, looks, mouths
C0 = 1 / (2 * np.sqrt(np.pi))


def shown(table: Record, w: Array) -> list[float]:
    """12.6: w' [E] of weights w."""
    if table.rules is None:
        return list(w)
    codes = [[int(rule) // 4**k % 4 for k in KINDS] for rule in table.rules]
    switches = [int(rule) // 64 % 2 == 1 for rule in table.rules]
    u = [float(weight > 0.5) if switch else weight for weight, switch in zip(w, switches, strict=True)]
    held = []
    for k in KINDS:
        wholly = [1 for weight, code in zip(u, codes, strict=True) if code[k] == 1 and weight > 0]
        held.append(min(1, sum(wholly) + sum(weight for weight, code in zip(u, codes, strict=True) if code[k] == 2)))
    left = []
    for weight, code, switch in zip(u, codes, switches, strict=True):
        own = [held[k] for k in KINDS if code[k] == 3]
        left.append(weight * float(max(own, default=0) == 0) if switch else weight * np.prod([1 - h for h in own]))
    return left


def moved(avatar: Record, pose: Pose) -> Array:
    """12.1: m [V, 3]"""
    found = np.zeros_like(avatar.coarse.mean)
    table = avatar.expressions
    if table is not None and pose.weights is not None:
        for e, weight in enumerate(shown(table, pose.weights)):
            for k in range(table.starts[e], table.starts[e + 1]):
                found[table.vertices[k]] += weight * table.offsets[k]
    return found


def brightened(avatar: Record, pose: Pose) -> Array:
    """12.1: s [V]"""
    found = np.zeros(len(avatar.coarse.mean))
    table = avatar.expressions
    if table is not None and pose.weights is not None and table.gains is not None:
        for e, weight in enumerate(shown(table, pose.weights)):
            for k in range(table.starts[e], table.starts[e + 1]):
                found[table.vertices[k]] += weight * table.gains[k]
    return found


def light(texture: Array, corners: Array, barycentrics: Array, s: Array) -> Array:
    """12.5: T [N, 23] of texels with these corners [N, 3] and barycentrics [N, 3]."""
    lit = texture.copy()
    for e, share in enumerate(np.sum(barycentrics * s[corners], axis=1)):
        lit[e, 11:14] += share * (texture[e, 11:14] + 0.5 / C0)
    return lit


def frame(corners: Array) -> tuple[Array, Array] | None:
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
    return axes, np.array([[length, s, 0], [0, h, 0], [0, 0, 1]])


def triangle(corners: Array, m: Array) -> tuple[float, Array, Array]:
    """12.2: A, q(R) and P of a triangle whose corners [3, 3] move by m [3, 3]."""
    before, after = frame(corners), frame(corners + m)
    if before is None or after is None:
        return 0, np.zeros(4), np.zeros((3, 3))
    area = min(edges[0, 0] * edges[1, 1] for _, edges in (before, after)) / 2
    if not m.any():
        return area, np.array([1.0, 0, 0, 0]), np.eye(3)
    f = after[0] @ after[1] @ np.linalg.inv(before[0] @ before[1])
    left, stretches, right = np.linalg.svd(f)
    return area, from_columns(left @ right), right.T @ np.diag(stretches) @ right


def vertices(faces: Array, v: Array, m: Array) -> dict[int, tuple[float, Array, Array]]:
    """12.3: of those that bend whether they count, g and P."""
    bent = {}
    moves = (m[faces] != 0).any(axis=(1, 2))
    parts = [triangle(v[corners], m[corners]) for corners in faces]
    for i in np.unique(faces[moves]):
        star = np.flatnonzero((faces == i).any(axis=1))
        area = sum(parts[t][0] for t in star)
        g, p = summed([parts[t][0] * parts[t][1] for t in star]), np.sum([parts[t][0] * parts[t][2] for t in star], 0)
        bent[int(i)] = (1.0, g / area, p / area) if area > 0 else (0.0, np.zeros(4), np.zeros((3, 3)))
    return bent


def summed(turns: list[Array]) -> Array:
    """The sum of quaternions, each of the sign by which it is not against those before it."""
    total = np.zeros(4)
    for turn in turns:
        total = total + (-turn if total @ turn < 0 else turn)
    return total


def mirror(n: Array, a: Array) -> Array:
    """12.4: 2 (n . a) n - a"""
    return np.asarray(2 * (n @ a) * n - a)


def bend(texture: Array, corners: Array, barycentrics: Array, faces: Array, v: Array, m: Array) -> Array:
    """12.4: T [N, 23] of texels with these corners [N, 3] and barycentrics [N, 3]."""
    bent, turned, still = texture.copy(), vertices(faces, v, m), (1.0, np.array([1.0, 0, 0, 0]), np.eye(3))
    for e in np.flatnonzero(np.isin(corners, list(turned)).any(axis=1)):
        held = [(b, *turned.get(int(i), still)) for b, i in zip(barycentrics[e], corners[e], strict=True)]
        whole = sum(b * counts for b, counts, _, _ in held)
        if whole == 0 or not any(b > 0 and i in turned for b, i in zip(barycentrics[e], corners[e], strict=True)):
            continue
        g = normalise(summed([b * turn for b, _, turn, _ in held]))
        p = np.sum([b * stretch for b, _, _, stretch in held], axis=0) / whole
        turn, axes = columns(g), columns(normalise(texture[e, 3:7]))
        bent[e, 0:3] = turn @ texture[e, 0:3]
        bent[e, 3:7] = multiply(g, texture[e, 3:7])
        bent[e, 7:10] += np.log(np.clip(np.linalg.norm(p @ axes, axis=0), 1 / LARGEST, LARGEST))
        normal = axes[:, 2]
        for c in range(3):
            a = texture[e, [20 + c, 14 + c, 17 + c]] * [-1, -1, 1]
            bent[e, [20 + c, 14 + c, 17 + c]] = [-1, -1, 1] * mirror(turn @ normal, mirror(normal, a))
    return bent
