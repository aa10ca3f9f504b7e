"""Facial motion: weights of expressions over time, from a file of a face alone or of a body that has one."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.characters.messages import listed
from mua.errors import InputError
from mua.motion.audio2face import read_audio2face
from mua.motion.live_link import read_live_link
from mua.motion.read import read_motion
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.expression_names import match_expressions
from mua.pose.resample import frames_at


@dataclass(frozen=True, eq=False)
class FaceMotion:
    """Weights of named expressions at a steady rate."""

    rate: float  # frames per second
    names: tuple[str, ...]  # [S]
    weights: Array  # [F, S] 0 to 1


def read_face(path: Path) -> FaceMotion:
    """Read a face of Live Link Face (.csv) or Audio2Face (.json), or of the first clip of a motion file that has one.

    Errors: InputError where the file cannot be read or no clip moves an expression.
    """
    if path.suffix.lower() == ".csv":
        return FaceMotion(*read_live_link(path))
    if path.suffix.lower() == ".json":
        return FaceMotion(*read_audio2face(path))
    for source in read_motion(path):
        if source.clip.expressions is not None:
            return FaceMotion(source.clip.rate, source.expressions, source.clip.expressions)
    raise InputError(f"{path}: no clip moves an expression, expected a face")


def with_face(
    clips: Sequence[Clip],
    path: Path,
    names: Sequence[str],  # [E] of the character's expressions
) -> tuple[list[Clip], list[str]]:
    """The clips with the facial motion of `path` from their first frame on, and notes on what does not fit.

    After the face's last frame the weights are 0. Errors: InputError where no expression of the character follows it.
    """
    face = read_face(path)
    matrix = match_expressions(names, face.names)
    if not matrix.any():
        held = listed(names)
        raise InputError(f"--face {path}: moves {listed(face.names)}, of which the character has none; it has {held}")
    weights = np.clip(face.weights @ matrix.T, 0, 1)
    unused = [name for name, column in zip(face.names, matrix.T, strict=True) if not column.any()]
    notes = [f"{path.name}: the character has no expression for {listed(unused)}."] if unused else []
    return [replace(clip, expressions=_during(clip, weights, face.rate)) for clip in clips], notes


def own_face(
    source: SourceMotion,
    clip: Clip,
    names: Sequence[str],  # [E] of the character's expressions
) -> Clip:
    """A clip on a character with what the weights of its source's expressions move there."""
    clip = replace(clip, expressions=None)
    if source.clip.expressions is None:
        return clip
    matrix = match_expressions(names, source.expressions)
    if not matrix.any():
        return clip
    weights = np.clip(source.clip.expressions @ matrix.T, 0, 1)
    return replace(clip, expressions=_during(clip, weights, source.clip.rate))


def _during(clip: Clip, weights: Array, rate: float) -> Array | None:
    """Weights [F, E] at the frames of a clip, 0 after their end; None where all are 0."""
    times = np.arange(len(clip)) * (rate / clip.rate)  # in frames of the weights
    before = np.minimum(times.astype(int), len(weights) - 1)
    after = np.minimum(before + 1, len(weights) - 1)
    found = weights[before] + (times - before)[:, None] * (weights[after] - weights[before])
    still = Clip("", rate, np.zeros((len(weights), 0, 4)), np.zeros((len(weights), 0, 3)))
    found[frames_at(still, clip.rate) :] = 0
    return found if found.any() else None
