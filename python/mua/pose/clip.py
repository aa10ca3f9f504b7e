"""A clip of motion on one skeleton, and what clips move."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from mua.arguments import amount, whole_number
from mua.arrays import Array
from mua.errors import InputError
from mua.pose.skeleton import Pose

RANGE_OF_MOTION = "range of motion: "  # prefix of the clip names of the built-in range of motion
REST = "as the file stands"  # name of the pose in which a character's file stands
STILL = np.radians(1)  # a joint whose rotation varies less in all clips is not moved by them
LED = 0.001  # of the largest translation, within which places are one


@dataclass(frozen=True, eq=False)
class Stretches:
    """Scales and shears of the surface about some joints, applied before the rigid joints move it."""

    joints: Array  # [K] int, ascending
    matrices: Array  # [F, K, 3, 3] in the axes of the bind pose; the identity does nothing


@dataclass(frozen=True, eq=False, repr=False)
class Clip:
    """Poses at a steady rate; local rotations and translations of every joint.

    Stretches are for teachers alone, which apply them to the surface; no file holds them.
    """

    name: str
    rate: float  # frames per second
    rotations: Array  # [F, J, 4] local joint rotations, unit, wxyz
    translations: Array  # [F, J, 3] local joint translations, metres
    stretches: Stretches | None = field(default=None, kw_only=True)
    expressions: Array | None = field(default=None, kw_only=True)  # [F, E] weights, 0 to 1; None: all 0

    def __len__(self) -> int:
        return len(self.rotations)

    def __repr__(self) -> str:
        joints = self.rotations.shape[1] if self.rotations.ndim == 3 else "?"
        return f"<mua.Clip {self.name!r}: {amount(len(self), 'frame')} at {self.rate:g} a second, {joints} joints>"

    def pose(self, index: int) -> Pose:
        """The pose of a frame, counted from 0; raises InputError where there is none."""
        if not 0 <= whole_number(index, "frame") < len(self):
            raise InputError(f"frame is {index}; clip {self.name!r} has frames 0 to {len(self) - 1}")
        weights = None if self.expressions is None else self.expressions[index]
        return Pose(self.rotations[index], self.translations[index], weights)

    def cut(self, frames: slice | Array) -> Self:
        """The clip with these frames alone."""
        kept = self.stretches
        stretches = None if kept is None else replace(kept, matrices=kept.matrices[frames])
        return replace(
            self,
            rotations=self.rotations[frames],
            translations=self.translations[frames],
            stretches=stretches,
            expressions=None if self.expressions is None else self.expressions[frames],
        )

    def then(self, other: "Clip") -> Self:
        """This clip followed by `other`, of the same skeleton, stretched joints and expressions, under this name."""
        stretches = self.stretches
        if stretches is not None and other.stretches is not None:
            matrices = np.concatenate([stretches.matrices, other.stretches.matrices])
            stretches = replace(stretches, matrices=matrices)
        rotations = np.concatenate([self.rotations, other.rotations])
        translations = np.concatenate([self.translations, other.translations])
        return replace(
            self,
            rotations=rotations,
            translations=translations,
            stretches=stretches,
            expressions=_followed(self, other),
        )


def _followed(first: Clip, second: Clip) -> Array | None:
    """The weights [F, E] of two clips one after the other; those of a clip that states none are 0."""
    stated = [clip.expressions for clip in (first, second) if clip.expressions is not None]
    if not stated:
        return None
    count = stated[0].shape[1]
    weights = [np.zeros((len(c), count)) if c.expressions is None else c.expressions for c in (first, second)]
    return np.concatenate(weights)


def is_range(name: str) -> bool:
    """Whether a clip of that name is of the built-in range of motion."""
    return name.startswith(RANGE_OF_MOTION)


def is_rest(name: str) -> bool:
    """Whether a clip of that name is the pose in which the character's file stands, recorded beside that range."""
    return name == f"{RANGE_OF_MOTION}{REST}"


def is_averaged(name: str, *, held_out: bool) -> bool:
    """Whether a recording's mean includes the frames of such a clip, as for the user's training motion."""
    return not held_out and not is_range(name)


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
