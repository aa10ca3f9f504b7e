"""Poses one after the other become a clip of the body: each is reached in its time, and nothing overshoots."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from mua.arrays import Array
from mua.motion.range.angles import Angles, table
from mua.motion.range.body import BODY, rotations
from mua.motion.range.grounded import path
from mua.pose.clip import Clip

RATE = 30.0  # frames per second


@dataclass(frozen=True)
class Key:
    """A pose, and the seconds in which it is reached from the one before."""

    seconds: float
    angles: Angles


def played(name: str, keys: Sequence[Key]) -> Clip:
    """The clip of the body that goes through `keys`."""
    return clip_of(name, np.array([key.seconds for key in keys]), table([key.angles for key in keys]))


def clip_of(name: str, seconds: Array, poses: Array) -> Clip:
    """The clip that goes through angles [P, A], each reached in its time [P]."""
    frames = np.cumsum(np.maximum(np.round(seconds * RATE), 1)).astype(int)
    frames -= frames[0]
    angles = PchipInterpolator(frames, poses, axis=0)(np.arange(frames[-1] + 1))
    local = rotations(angles)
    return Clip(name, RATE, local, BODY.with_root(path(local, angles)))
