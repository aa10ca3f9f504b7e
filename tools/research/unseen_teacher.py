"""A character's simulated teacher on motion that an avatar has not been trained on.

Motion of all kinds is cut to its most active seconds. A live rig with a broken joint and random joint angles are made
from the walk that the avatar was trained on.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.atlas.detail import read_detail
from mua.baking.sources import load_character
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.recording.encode import align_rotations
from mua.rig.character import Character
from mua.teacher import TeacherFrame
from mua.teachers.simulated.teacher import SimulatedTeacher

LONGEST = 4.0  # seconds of a motion
RUN_UP = 0.5  # seconds that are simulated and not measured: a teacher's cloth is at rest when a clip begins
EVERY, MOST = 5, 24  # of the frames after that, one in so many is measured, and no more than so many
RANDOM_FRAMES = 100
SPIN, JUMP = 2.0, 120.0  # turns per second of a joint that spins, degrees of one that jumps
LIVELY = 12  # joints that carry the most skin, of which the broken ones are chosen


@dataclass(frozen=True, eq=False)
class Motion:
    """A clip on the avatar's skeleton, and which frames are measured."""

    clip: Clip
    sound: bool  # false for broken rigs and random angles, whose teacher need not make sense

    @property
    def frames(self) -> Array:
        """[F] ascending; the last one always, so that a clip of any length has some."""
        start = min(round(RUN_UP * self.clip.rate), len(self.clip) // 3)
        return np.arange(len(self.clip) - 1, start - 1, -EVERY)[:MOST][::-1]


@dataclass(frozen=True, eq=False)
class Shown:
    """The teacher's frame as it is compared."""

    frame: int
    mesh: Array  # [V, 3] canonical vertices, metres
    texture: Array  # [N, 23] raw channels, rotations aligned to a recording's reference


def motions_of(character: Character, paths: Sequence[Path]) -> Iterator[Motion]:
    """Every clip of the files, cut to its most active part; says which files the character cannot follow."""
    for path in paths:
        try:
            loaded = load_motions(path, character.skeleton, mapping=None, rate=RATE, roles=character.roles)
        except InputError as error:
            print(f"left out: {error}")
            continue
        for one in loaded:
            name = path.stem if len(loaded) == 1 else f"{path.stem} {one.clip.name}"
            yield Motion(most_active(replace(one.clip, name=name)), sound=True)


def most_active(clip: Clip, *, seconds: float = LONGEST) -> Clip:
    """The part of a clip, at most so long, in which its joints turn most."""
    length = round(seconds * clip.rate)
    if len(clip) <= length:
        return clip
    between = np.abs(np.einsum("fjc,fjc->fj", clip.rotations[1:], clip.rotations[:-1])).clip(0, 1)
    turned = np.cumsum(np.r_[0.0, (2 * np.arccos(between)).sum(axis=1)])  # from the first frame to each
    start = int(np.argmax(turned[length - 1 :] - turned[: len(turned) - length + 1]))
    return clip.cut(slice(start, start + length))


def broken_rigs(avatar: Avatar, *, seed: int = 0) -> Iterator[Motion]:
    """The avatar's first clip with a joint that spins, one turned by 180 degrees, one that jumps; and random angles."""
    rng, walk = np.random.default_rng(seed), avatar.clips[0]
    spun, turned, jumping = rng.choice(_lively(avatar), 3, replace=False)
    axes = _axes(rng, 3)
    time = np.arange(len(walk))
    yield _broken(walk, "joint that spins", spun, axes[0], 2 * np.pi * SPIN / walk.rate * time)
    yield _broken(walk, "joint turned by 180 degrees", turned, axes[1], np.full(len(walk), np.pi))
    yield _broken(walk, "joint that jumps", jumping, axes[2], np.radians(JUMP) * (time % 2))
    skeleton = avatar.rig.skeleton
    count = (RANDOM_FRAMES, len(skeleton.names))
    angles, axes = rng.uniform(0, np.pi, count), _axes(rng, *count)
    random = rotation.multiply(np.broadcast_to(skeleton.bind_rotations, (*count, 4)), _turns(axes, angles))
    places = np.broadcast_to(skeleton.bind_translations, (*count, 3)).copy()
    yield Motion(Clip("random joint angles", walk.rate, random, places), sound=False)


class Teacher:
    """The simulated teacher of a character."""

    def __init__(self, path: Path | None, *, texels: int, fit: Path | None = None) -> None:
        """Load the character at `path`, or the procedural one, as a bake does, and the corrections that it kept."""
        detail = None if path is None else read_detail((), uv="auto")
        self.character = load_character(path, uv="auto", seed=0, detail=detail)
        bare = replace(self.character, clips=(), source=None)
        self._simulated = SimulatedTeacher(bare, texels=texels)
        if fit is not None and fit.exists():
            self._simulated = self._simulated.corrected(np.load(fit))

    def shown(
        self,
        motion: Motion,
        reference: Array,  # [N, 23] whose hemispheres the rotations are brought to
    ) -> Iterator[Shown]:
        """The frames of a motion that are measured, its cloth in motion since the first frame of the clip."""
        for index, frame in enumerate(self._simulated.frames(motion.clip, frozenset(motion.frames.tolist()))):
            if isinstance(frame, TeacherFrame):
                yield Shown(index, frame.mesh, align_rotations(frame.texture, reference))


def _broken(walk: Clip, name: str, joint: int, axis: Array, angles: Array) -> Motion:
    rotations = walk.rotations.astype(np.float64)
    turns = _turns(np.broadcast_to(axis, (len(walk), 3)), angles)
    rotations[:, joint] = rotation.multiply(rotations[:, joint], turns)
    return Motion(replace(walk, name=name, rotations=rotations), sound=False)


def _lively(avatar: Avatar) -> Array:
    """The joints that move and carry the most skin, the root aside."""
    rig = avatar.rig
    skin = np.bincount(rig.skin_indices.ravel(), rig.skin_weights.ravel(), minlength=len(rig.skeleton.names))
    joints = np.array([joint for joint in avatar.encoding.joints if joint != rig.skeleton.root])
    return joints[np.argsort(-skin[joints], kind="stable")][:LIVELY]


def _axes(rng: np.random.Generator, *count: int) -> Array:
    """Unit vectors [..., 3], uniformly distributed."""
    axes = rng.normal(size=(*count, 3))
    return np.asarray(axes / np.linalg.norm(axes, axis=-1, keepdims=True))


def _turns(axes: Array, angles: Array) -> Array:
    """Quaternions [..., 4] of turns about axes [..., 3] by angles [...], radians."""
    half = np.asarray(angles)[..., None] / 2
    return np.concatenate([np.cos(half), np.sin(half) * axes], axis=-1)
