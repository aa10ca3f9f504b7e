"""Poses of a clip, and joints in the world: section 2."""

import math
from dataclasses import dataclass

import numpy as np
from oracle.file import Array, Record
from oracle.quaternions import multiply, normalise, rotate


@dataclass(frozen=True)
class Pose:
    rotations: Array  # l [J, 4]
    translations: Array  # t [J, 3] metres
    weights: Array | None = None  # w [E] of section 12; none: all 0


def bind_pose(skeleton: Record) -> Pose:
    """2.1"""
    return Pose(normalise(skeleton.bind_rotations), skeleton.bind_translations)


def stored_pose(skeleton: Record, clip: Record, n: int) -> Pose:
    """2.2: frame n at the clip's own rate."""
    translations = skeleton.bind_translations.copy()
    translations[skeleton.root] = clip.translation[n]
    if skeleton.translated is not None:
        translations[skeleton.translated] = clip.translations[n]
    return Pose(normalise(clip.rotations[n]), translations, None if clip.expressions is None else clip.expressions[n])


def poses(avatar: Record, clip: Record) -> list[Pose]:
    """2.3: all frames at the rate of the encoding."""
    stored = [stored_pose(avatar.skeleton, clip, n) for n in range(len(clip.rotations))]
    last, step = len(stored) - 1, clip.rate / avatar.encoding.rate
    return [between(stored, min(n * step, last)) for n in range(math.floor(last / step + 1e-6) + 1)]


def between(stored: list[Pose], u: float) -> Pose:
    """2.3: the pose at u, in stored frames."""
    first, second, s = stored[math.floor(u)], stored[math.ceil(u)], u - math.floor(u)
    cosine = np.sum(first.rotations * second.rotations, axis=-1, keepdims=True)
    angle = np.arccos(np.minimum(np.abs(cosine), 1))
    sines = np.sin([(1 - s) * angle, s * angle]) / np.maximum(np.sin(angle), 1e-12)
    weights = np.where(angle < 1e-6, np.reshape([1 - s, s], (2, 1, 1)), sines)
    rotations = weights[0] * first.rotations + weights[1] * np.where(cosine < 0, -1, 1) * second.rotations
    held = None if first.weights is None or second.weights is None else (1 - s) * first.weights + s * second.weights
    return Pose(normalise(rotations), (1 - s) * first.translations + s * second.translations, held)


def in_the_world(skeleton: Record, pose: Pose) -> tuple[Array, Array]:
    """2.4: W [J, 4] and P [J, 3]."""
    rotations, places = pose.rotations.copy(), pose.translations.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            rotations[joint] = multiply(rotations[parent], pose.rotations[joint])
            places[joint] = places[parent] + rotate(rotations[parent], pose.translations[joint])
    return rotations, places
