"""The motion descriptor: the MLPs' view of a window of poses (mua.pose.encoding; paper, Data Assumption)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.encoding import Normalization, PoseEncoding
from mua.pose.skeleton import Skeleton

STILL = np.radians(0.1)  # standard deviation below which a joint counts as not moving
MOVES = 1e-3  # share of the character's size: standard deviation below which a joint counts as not translated
SCALE_FLOOR = 1e-3  # a millimetre for a person of 1.75 m, or 0.06 degrees: smaller variation is not scaled up
SLIGHT = 0.4  # relative to how far joints turn: one that turns by less than that counts for less


@dataclass(frozen=True, eq=False)
class _Frames:
    """The contribution of each frame to the windows that contain it."""

    position: Array  # [F, 3] world position of the root, metres
    turn: Array  # [F, 4] world rotation of the root relative to bind
    turns: Array  # [F, n, 4] those of the encoded joints
    joints: Array  # [F, 6 n + 3 m] local rotations and translations of the encoded joints


def describe(
    skeleton: Skeleton,
    encoding: PoseEncoding,
    rotations: Array,  # [F, J, 4] local, unit
    translations: Array,  # [F, J, 3] local, metres
    *,
    windows: Array | None = None,  # [N, k] frames of each window, newest first; None: a window ending at every frame
) -> Array:
    """Descriptors [N, D] float64 of windows of a clip; before its first frame, the clip is held still."""
    if windows is None:
        windows = np.maximum(np.arange(len(rotations))[:, None] - np.arange(encoding.window), 0)
    return _gather(encoding, _frames(skeleton, encoding, rotations, translations), windows)


def describe_window(
    skeleton: Skeleton,
    encoding: PoseEncoding,
    rotations: Array,  # [k, J, 4] local, unit, newest first
    translations: Array,  # [k, J, 3] local, metres, newest first
) -> Array:
    """Descriptor [D] float64 of one window: the numbers that `describe` gives for its newest frame."""
    frames = _frames(skeleton, encoding, rotations, translations)
    return np.asarray(_gather(encoding, frames, np.arange(encoding.window)[None])[0])


def choose_joints(
    skeleton: Skeleton,
    clips: Sequence[Clip],
    used: Array,  # [J] bool, joints that move the mesh themselves or through a descendant
) -> tuple[int, ...]:
    """Joints to encode beside the root: those in use whose local rotation varies over all `clips` together."""
    rotations = np.concatenate([clip.rotations for clip in clips])
    aligned = np.where(np.sum(rotations * rotations[:1], axis=-1, keepdims=True) < 0, -rotations, rotations)
    mean = rotation.normalize(aligned.sum(axis=0))
    away = np.linalg.norm(rotation.multiply(rotation.conjugate(mean), rotations)[..., 1:], axis=-1)
    angles = 2 * np.arcsin(np.minimum(away, 1))
    varies = np.sqrt(np.mean(angles**2, axis=0)) > STILL
    return tuple(int(j) for j in np.flatnonzero(varies & used) if j != skeleton.root)


def choose_translated(
    skeleton: Skeleton,
    clips: Sequence[Clip],
    used: Array,  # [J] bool, as for choose_joints
) -> tuple[int, ...]:
    """Joints whose local translation is encoded: those in use, not above the root, where it varies over all `clips`.

    What is above the root moves the whole character, of which the descriptor holds the root's path alone.
    """
    varies = np.concatenate([clip.translations for clip in clips]).std(axis=0).max(axis=-1) > MOVES * skeleton.size
    above = set(skeleton.ancestors(skeleton.root))
    return tuple(int(j) for j in np.flatnonzero(varies & used) if j != skeleton.root and j not in above)


def normalization(
    descriptors: Array,  # [N, D]
    units: Array,  # [D] from `units_of`
    turns: Array | None = None,  # [D] from `turns_of`; None: every column has a scale of its own
) -> Normalization:
    """Mean and scale of descriptors; columns that hardly vary keep a scale of one unit.

    With `turns` the numbers that say how a joint is turned share a scale, so that those across its axis, which hardly
    vary, are not raised to the level of those along it. A joint that turns little is not raised to the level of others
    either: how the surface bends follows the angle, not the angle relative to those of training.
    """
    deviation = descriptors.std(axis=0)
    turned = np.zeros(len(deviation), bool) if turns is None else turns >= 0
    if turns is not None and turned.any():
        counts, squares = np.bincount(turns[turned]), np.bincount(turns[turned], deviation[turned] ** 2)
        shared = np.sqrt(squares[turns[turned]] / counts[turns[turned]])
        deviation[turned] = shared + SLIGHT * np.sqrt(np.mean(deviation[turned] ** 2))
    return Normalization(descriptors.mean(axis=0), np.where(deviation > SCALE_FLOOR * units, deviation, units))


def turns_of(encoding: PoseEncoding) -> Array:
    """The group of each number [D] of a descriptor, as in `groups_of`, and -1 for lengths."""
    lengths = np.array([part.lengths for part in encoding.parts for _ in range(part.width)])
    return np.where(lengths, -1, groups_of(encoding))


def units_of(
    encoding: PoseEncoding,
    size: float,  # size of the figure over that of a person
) -> Array:
    """The unit of each column [D] of a descriptor: lengths scale with the figure, relative to a person."""
    return np.array([size if part.lengths else 1.0 for part in encoding.parts for _ in range(part.width)])


def groups_of(encoding: PoseEncoding) -> Array:
    """The groups of a descriptor's numbers that vary together: the root, a joint in its parent, or it in the world.

    [D] the group of each.
    """
    keys = [(part.joint, part.world) for part in encoding.parts for _ in range(part.width)]
    order = {key: group for group, key in enumerate(dict.fromkeys(keys))}
    return np.array([order[key] for key in keys])


def heading_of(turn: Array) -> Array:
    """The twist about Y [..., 4] of rotations [..., 4]; identity where they have none (swing-twist decomposition)."""
    twist = turn * np.array([1.0, 0, 1, 0])
    length = np.linalg.norm(twist, axis=-1, keepdims=True)
    vanishes = length < np.sqrt(np.finfo(float).eps)
    return np.where(vanishes, [1.0, 0, 0, 0], twist / np.where(vanishes, 1, length))


def _frames(skeleton: Skeleton, encoding: PoseEncoding, rotations: Array, translations: Array) -> _Frames:
    rotations, translations = np.asarray(rotations, dtype=float), np.asarray(translations, dtype=float)
    turned, placed = skeleton.world(rotations, translations)
    bind, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    turns = rotation.multiply(turned, rotation.conjugate(bind))
    local = rotation.to_6d(rotations[:, list(encoding.joints)])
    moved = list(encoding.translated)
    moves = translations[:, moved] - skeleton.bind_translations[moved]
    return _Frames(
        position=placed[:, skeleton.root],
        turn=turns[:, skeleton.root],
        turns=turns[:, list(encoding.joints)],
        joints=np.concatenate([local.reshape(len(rotations), -1), moves.reshape(len(rotations), -1)], axis=-1),
    )


def _gather(encoding: PoseEncoding, frames: _Frames, window: Array) -> Array:
    """Descriptors [N, D] of windows [N, k] of frame indices, newest first."""
    moved = frames.position[window] - frames.position[window[:, :1]]
    turn, turns = frames.turn[window], frames.turns[window[:, 0]]
    if encoding.remove_heading:
        back = rotation.conjugate(heading_of(turn[:, :1]))
        moved, turn = rotation.rotate(back, moved), rotation.multiply(back, turn)
        turns = rotation.multiply(back, turns)
    of_frames = np.concatenate([moved, rotation.to_6d(turn), frames.joints[window]], axis=-1)
    return np.concatenate([rotation.to_6d(turns).reshape(len(window), -1), of_frames.reshape(len(window), -1)], axis=-1)
