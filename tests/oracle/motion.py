"""Sections 2 and 3 of schemas/README.md: poses of a clip, and what the networks read of them."""

from math import floor

import numpy as np
from oracle.file import Array, Tree
from oracle.turning import product, rotate, star, unit

Pose = tuple[Array, Array]  # l [J, 4], t [J, 3]


def bind_pose(skeleton: Tree) -> Pose:
    """2.1"""
    return unit(skeleton["bind_rotations"]), skeleton["bind_translations"]


def stored_frame(skeleton: Tree, clip: Tree, n: int) -> Pose:
    """2.2"""
    t = bind_pose(skeleton)[1].copy()
    t[skeleton["root"]] = clip["translation"][n]
    for m, joint in enumerate(skeleton.get("translated", ())):
        t[joint] = clip["translations"][n, m]
    return unit(clip["rotations"][n]), t


def frames(avatar: Tree, clip: Tree) -> list[Pose]:
    """2.3: poses at the rate of the encoding."""
    stored = [stored_frame(avatar["skeleton"], clip, n) for n in range(len(clip["rotations"]))]
    last, f, g = len(stored) - 1, avatar["encoding"]["rate"], clip["rate"]
    return [_between(stored, min(n * g / f, last)) for n in range(floor(last * f / g + 1e-6) + 1)]


def _between(stored: list[Pose], u: float) -> Pose:
    """2.3"""
    a, s = floor(u), u - floor(u)
    (l_a, t_a), (l_b, t_b) = stored[a], stored[min(a + 1, len(stored) - 1)]
    turned = []
    for p, q in zip(l_a, l_b, strict=True):
        q = -q if p @ q < 0 else q
        angle = np.arccos(min(p @ q, 1.0))
        weights = (1 - s, s) if angle < 1e-6 else np.sin([(1 - s) * angle, s * angle]) / np.sin(angle)
        turned.append(unit(weights[0] * p + weights[1] * q))
    return np.array(turned), (1 - s) * t_a + s * t_b


def world(skeleton: Tree, pose: Pose) -> Pose:
    """2.4: W and P."""
    W, P = np.array(pose[0]), np.array(pose[1])
    for j, p in enumerate(skeleton["parents"]):
        if p >= 0:
            W[j], P[j] = product(W[p], W[j]), P[p] + rotate(W[p], P[j])
    return W, P


def window(avatar: Tree, poses: list[Pose], n: int) -> list[Pose]:
    """3.1: newest first."""
    return [poses[max(n - age, 0)] for age in range(avatar["encoding"]["window"])]


def descriptor(avatar: Tree, poses: list[Pose]) -> Array:
    """3.2, 3.4: d [D] of a window."""
    skeleton, encoding = avatar["skeleton"], avatar["encoding"]
    root, t0 = skeleton["root"], bind_pose(skeleton)[1]
    W0 = world(skeleton, bind_pose(skeleton))[0]
    places = [world(skeleton, pose) for pose in poses]
    G = [product(W, star(W0)) for W, _ in places]
    back = star(_heading(G[0][root]) if encoding["heading"] else np.array([1.0, 0, 0, 0]))
    d = [_six(product(back, G[0][j])) for j in encoding["joints"]]
    for (local, t), turned, (_, P) in zip(poses, G, places, strict=True):
        d += [rotate(back, P[root] - places[0][1][root]), _six(product(back, turned[root]))]
        d += [_six(local[j]) for j in encoding["joints"]] + [t[j] - t0[j] for j in encoding.get("translated", ())]
    return np.concatenate(d)


def _heading(turned: Array) -> Array:
    """3.2"""
    twist = turned * [1, 0, 1, 0]
    length = np.linalg.norm(twist)
    return twist / length if length >= 1.5e-8 else np.array([1.0, 0, 0, 0])


def _six(q: Array) -> Array:
    """3.3"""
    w, x, y, z = q
    first = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    return np.array([*first, 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])


def components(avatar: Tree, d: Array) -> Array:
    """3.5: z [K]"""
    encoding = avatar["encoding"]
    return np.asarray(encoding["components"] @ ((d - encoding["mean"]) / encoding["scale"]))


def bounded(avatar: Tree, z: Array) -> Array:
    """3.6: x [K]"""
    low, high = avatar["encoding"]["ranges"]
    m, x = avatar["encoding"]["margins"], np.array(z)
    for k, beyond in enumerate(np.maximum(z - high, low - z)):
        if beyond > 0:
            share = beyond * m[k] / (beyond + m[k])
            x[k] = high[k] + share if z[k] > high[k] else low[k] - share
    return x


def outside(z: Array, x: Array) -> float:
    """3.7"""
    return float(np.linalg.norm(z - x) / np.linalg.norm(z)) if z.any() else 0.0
