"""Rigs that are no person: each joint that moves the surface goes through a range of its own, alone and with others."""

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PchipInterpolator

from mua import rotation
from mua.arrays import Array
from mua.motion.range.played import RATE
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

ALONE, TOGETHER = 35.0, 22.0  # degrees of a joint at most, where it alone moves and where all do
LEANS, TURNS = 30.0, 60.0  # degrees of the whole figure
QUICKEST, SLOWEST = 0.1, 0.5  # seconds in which a pose is reached
POSES = 24  # of a clip in which all joints move


def alone(name: str, skeleton: Skeleton, joints: Sequence[int], rest: Array, rng: np.random.Generator) -> Clip:
    """Each of `joints` there and back, one after the other; `rest` [J, 4] are the local rotations in between."""
    turns = np.zeros((2 * len(joints) + 1, len(rest), 3))
    for place, joint in enumerate(joints):
        axis = rng.normal(size=3)
        turns[2 * place + 1, joint] = ALONE * axis / np.linalg.norm(axis)
        turns[2 * place + 2, joint] = -turns[2 * place + 1, joint]
    return _played(name, skeleton, rest, turns, rng)


def together(name: str, skeleton: Skeleton, joints: Sequence[int], rest: Array, rng: np.random.Generator) -> Clip:
    """All of `joints` at once, from one random pose to the next, while the figure leans and turns."""
    turns = np.zeros((POSES, len(rest), 3))
    turns[1:, list(joints)] = rng.uniform(-1, 1, (POSES - 1, len(joints), 3)) * TOGETHER
    turns[1:, skeleton.root] = rng.uniform(-1, 1, (POSES - 1, 3)) * [LEANS, TURNS, LEANS]
    return _played(name, skeleton, rest, turns, rng)


def swung(skeleton: Skeleton, clip: Clip, joints: Sequence[int], rng: np.random.Generator) -> Clip:
    """The clip, in which `joints` swing about where they are, each in its own time."""
    seconds = np.exp(rng.uniform(np.log(QUICKEST), np.log(SLOWEST), len(clip)))
    frames = np.append(0, np.cumsum(np.maximum(np.round(seconds * RATE), 1)))
    turns = rng.uniform(-1, 1, (len(frames), len(joints), 3)) * TOGETHER
    swings = _vectors(PchipInterpolator(frames, turns, axis=0)(np.arange(len(clip))))
    rotations = clip.rotations.copy()
    rotations[:, list(joints)] = rotation.multiply(rotations[:, list(joints)], swings)
    return Clip(clip.name, clip.rate, rotations, clip.translations)


def _played(name: str, skeleton: Skeleton, rest: Array, turns: Array, rng: np.random.Generator) -> Clip:
    """The clip through turns [P, J, 3] in degrees about axes of the joints; the root's are those of the world."""
    seconds = np.exp(rng.uniform(np.log(QUICKEST), np.log(SLOWEST), len(turns)))
    frames = np.cumsum(np.maximum(np.round(seconds * RATE), 1)).astype(int)
    frames -= frames[0]
    swings = _vectors(PchipInterpolator(frames, turns, axis=0)(np.arange(frames[-1] + 1)))
    rotations = rotation.multiply(np.tile(rest, (len(swings), 1, 1)), swings)
    root, parent = skeleton.root, int(skeleton.parents[skeleton.root])
    above = rotation.conjugate(skeleton.world(rest, skeleton.bind_translations)[0][parent]) if parent >= 0 else None
    swing = swings[:, root]
    if above is not None:
        swing = rotation.multiply(rotation.multiply(above, swing), rotation.conjugate(above))
    rotations[:, root] = rotation.multiply(swing, rest[root])
    return Clip(name, RATE, rotations, np.tile(skeleton.bind_translations, (len(rotations), 1, 1)))


def _vectors(degrees: Array) -> Array:
    """Rotations [..., 4] of vectors [..., 3] in degrees."""
    angle = np.linalg.norm(degrees, axis=-1)
    axis = degrees / np.where(angle > 0, angle, 1)[..., None]
    return rotation.from_axis_angle(axis, np.radians(angle))
