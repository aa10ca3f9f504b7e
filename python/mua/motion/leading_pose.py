"""A pose before the motion: many libraries begin each clip with one frame of the T-pose."""

from dataclasses import replace

import numpy as np

from mua.motion.source_motion import SourceMotion

FEWEST, MOST = 8, 60  # frames of a clip in which a first one can stand apart; those that are looked at
FASTEST = 3.0  # metres a second, the mean of all joints: no motion begins so for one frame alone
APART = 4.0  # times the largest step between the frames after it


def without_leading_pose(source: SourceMotion) -> SourceMotion:
    """The motion without its first frame, where the body jumps from that one to the next as nowhere after it."""
    clip = source.clip
    if len(clip) < FEWEST:
        return source
    _, places = source.skeleton.world(clip.rotations[:MOST], clip.translations[:MOST])
    first, *others = np.linalg.norm(np.diff(places, axis=0), axis=2).mean(axis=1)
    if first * clip.rate < FASTEST or first < APART * max(others):
        return source
    note = f"{clip.name}: the first frame, a pose apart from the motion, is left out."
    return replace(source, clip=clip.cut(slice(1, None)), notes=(*source.notes, note))
