"""What the networks read of a motion: section 3."""

import numpy as np
from oracle.file import Array, Record
from oracle.motion import Pose, bind_pose, in_the_world
from oracle.quaternions import conjugate, multiply, rotate, six


def heading(encoding: Record, turn: Array) -> Array:
    """3.2"""
    twist = turn * [1, 0, 1, 0]
    length = np.linalg.norm(twist)
    return twist / length if encoding.heading and length >= 1.5e-8 else np.array([1.0, 0, 0, 0])


def describe(avatar: Record, poses: list[Pose], n: int) -> Array:
    """3.4: d [D] of frame n of poses at the rate of the encoding."""
    window = [poses[max(n - age, 0)] for age in range(avatar.encoding.window)]  # 3.1
    skeleton, encoding, root = avatar.skeleton, avatar.encoding, avatar.skeleton.root
    bind, worlds = bind_pose(skeleton), [in_the_world(skeleton, pose) for pose in window]
    turns = [multiply(rotations, conjugate(in_the_world(skeleton, bind)[0])) for rotations, _ in worlds]
    back = conjugate(heading(encoding, turns[0][root]))
    parts = [six(multiply(back, turns[0][encoding.joints]))]
    for pose, turn, (_, places) in zip(window, turns, worlds, strict=True):
        parts += [rotate(back, places[root] - worlds[0][1][root]), six(multiply(back, turn[root]))]
        parts += [six(pose.rotations[encoding.joints])]
        if encoding.translated is not None:
            parts += [(pose.translations - bind.translations)[encoding.translated]]
    return np.concatenate([part.ravel() for part in parts])


def components(encoding: Record, d: Array) -> Array:
    """3.5: z [K]."""
    return np.asarray(encoding.components @ ((d - encoding.mean) / encoding.scale))


def bound(encoding: Record, z: Array) -> Array:
    """3.6: x [K]."""
    (low, high), m = encoding.ranges, encoding.margins
    nearest = np.clip(z, low, high)
    e = np.abs(z - nearest)
    return nearest + np.sign(z - nearest) * e * m / np.where(e > 0, e + m, 1)


def outside(z: Array, x: Array) -> float:
    """3.7"""
    return float(np.linalg.norm(z - x) / np.linalg.norm(z)) if z.any() else 0.0
