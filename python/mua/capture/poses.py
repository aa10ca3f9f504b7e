"""The poses of a clip's frames, on the template's skeleton."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mua.atlas.character_surfaces import Surfaces
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.pose.clip import Clip


def template_poses(
    motion: Path,
    surfaces: Surfaces,
    *,
    rate: float,  # frames per second
    name: str,  # of the clip; of a file with several motions, it is the one of this name
) -> Clip:
    """All poses of a motion. Feet stay where the motion has them: they were measured, not made up."""
    loaded = load_motions(motion, surfaces.skeleton, mapping=None, rate=rate, roles=surfaces.roles, feet="keep")
    called = [one.clip for one in loaded if one.clip.name == name] or [one.clip for one in loaded]
    if len(called) > 1:
        names = ", ".join(repr(clip.name) for clip in called)
        raise InputError(f"{motion}: holds {len(called)} motions ({names}), none of which is called {name!r}")
    clip = replace(called[0], name=name)
    for values in (clip.rotations, clip.translations):
        wrong = np.flatnonzero(~np.isfinite(values).all(axis=(1, 2)))
        if len(wrong):
            raise InputError(f"{motion}: pose {wrong[0]}: a joint's place or turn is not finite")
    return clip


def cut_poses(clip: Clip, motion: Path, *, first: int, frames: int, steps: int) -> Clip:
    """The poses of `frames` frames from `first` on, `steps` poses apart; raises InputError for too few poses."""
    there = -(-len(clip) // steps)
    if there < first + frames:
        wanted = f"clip {clip.name!r} needs {frames} from pose {first} on"
        raise InputError(f"{motion}: has {there} poses at {clip.rate / steps:g} frames per second; {wanted}")
    return clip.cut(slice(steps * first, steps * (first + frames - 1) + 1))


def every(clip: Clip, steps: int) -> Clip:
    """Every so many poses of a clip, at the rate that they have then."""
    return replace(clip.cut(slice(None, None, steps)), rate=clip.rate / steps)
