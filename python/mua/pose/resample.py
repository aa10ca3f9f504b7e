"""Resample a clip to another rate: rotations along the shorter arc, all else linearly."""

from dataclasses import replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip

LAST_FRAME_SLACK = 1e-6  # frames by which rounding may place the end of a clip before its last sample


def resample(clip: Clip, rate: float) -> Clip:
    """Return `clip` sampled at `rate` frames per second from its first frame on, never past its last."""
    return clip if rate == clip.rate else sample(clip, np.arange(frames_at(clip, rate)), rate=rate)


def frames_at(clip: Clip, rate: float) -> int:
    """How many frames a clip has at `rate` frames per second."""
    return int((len(clip) - 1) / clip.rate * rate + LAST_FRAME_SLACK) + 1 if len(clip) else 0


def sample(
    clip: Clip,
    frames: Array,  # [N] from 0, each below frames_at(clip, rate); whole where `rate` is the clip's
    *,
    rate: float,
) -> Clip:
    """The clip at these frames, counted at `rate` frames per second."""
    if rate == clip.rate:
        return clip.cut(frames)
    last = len(clip) - 1
    times = np.minimum(frames * (clip.rate / rate), last)  # in frames of `clip`
    before = times.astype(int)
    after = np.minimum(before + 1, last)
    t = times - before

    def between(values: Array) -> Array:
        steps = t.reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray(values[before] + steps * (values[after] - values[before]))

    kept = clip.stretches
    return Clip(
        name=clip.name,
        rate=rate,
        rotations=rotation.slerp(clip.rotations[before], clip.rotations[after], t[:, None]),
        translations=between(clip.translations),
        stretches=None if kept is None else replace(kept, matrices=between(kept.matrices)),
        expressions=None if clip.expressions is None else between(clip.expressions),
    )
