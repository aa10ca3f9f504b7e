"""What clips of one skeleton move."""

from collections.abc import Iterable, Sequence

import numpy as np

from mua.pose.clip import Clip

STILL = np.radians(1)  # a joint whose rotation varies less in all clips is not moved by them
LED = 0.001  # of the largest translation, within which places are one


def moved_by(clips: Sequence[Clip], joints: Iterable[int]) -> list[int]:
    """The `joints` that the clips turn."""
    if not clips:
        return []
    turns = np.concatenate([clip.rotations for clip in clips])
    away = 2 * np.arccos(np.clip(np.abs(np.sum(turns * turns[:1], axis=-1)), 0, 1))
    return [int(joint) for joint in joints if away[:, joint].max() > STILL]


def show_one_pose(clips: Sequence[Clip]) -> bool:
    """Whether no joint turns, moves or scales in these clips, and no expression changes: a rest pose, say."""
    paths = np.concatenate([clip.translations for clip in clips])
    beside = [clip.stretches.matrices for clip in clips if clip.stretches is not None]
    beside += [clip.expressions for clip in clips if clip.expressions is not None]
    changes = any(np.ptp(values, axis=0).any() for values in beside)
    led = np.ptp(paths, axis=0).max() > LED * np.abs(paths).max()
    return not (led or changes or moved_by(clips, range(paths.shape[1])))
