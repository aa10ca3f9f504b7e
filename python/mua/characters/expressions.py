"""The targets of a character's parts as its expressions: one for each name, over the vertices of all parts."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mua.arrays import Array
from mua.characters.messages import listed
from mua.pose.clip import Clip
from mua.pose.expression_names import match_expressions
from mua.rig.charts import areas
from mua.rig.expressions import Expressions
from mua.rig.growth import moved_areas
from mua.scene import Motion, Target

STILL = 1e-5  # of the character's size: a target that moves a vertex less does not move it (0.02 mm on a person)
POINT = 1e-4  # of its area in an expression: a triangle that is smaller at rest has no texel
SHOWN = 1e-4  # of the figure's surface: what an expression brings out is worth a sentence
UNFOLDING = "Pieces that are next to a point at rest have no texels and stay unseen in expressions: "
APART = 1e-4  # of the character's size: vertices at one place whose targets differ by this are two, as on lips


def joined_targets(
    targets: Sequence[Target],  # in the bind pose, of vertices of all parts
    *,
    size: float,
) -> tuple[Expressions | None, tuple[str, ...]]:
    """The targets of equal names as one expression each, and a sentence on those that move nothing."""
    names = [*dict.fromkeys(target.name for target in targets)]
    moving, idle = {}, []
    for name in names:
        own = [target for target in targets if target.name == name]
        vertices, offsets = _summed(own)
        moved = np.abs(offsets).max(axis=1, initial=0) > STILL * size
        if moved.any():
            moving[name] = vertices[moved], offsets[moved]
        else:
            idle.append(name)
    notes = (f"Expressions that move nothing are left out: {listed(idle)}.",) if idle else ()
    if not moving:
        return None, notes
    counts = [len(vertices) for vertices, _ in moving.values()]
    return Expressions(
        names=tuple(moving),
        starts=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        vertices=np.concatenate([vertices for vertices, _ in moving.values()]).astype(np.int32),
        offsets=np.concatenate([offsets for _, offsets in moving.values()]).astype(np.float32),
    ), notes


def _summed(targets: Sequence[Target]) -> tuple[Array, Array]:
    """The vertices [n], ascending, that any of the targets moves, and how far [n, 3] all of them do."""
    vertices, row = np.unique(np.concatenate([target.vertices for target in targets]), return_inverse=True)
    offsets = np.zeros((len(vertices), 3))
    np.add.at(offsets, row, np.concatenate([target.offsets for target in targets]))
    return vertices, offsets


def unfolding(expressions: Expressions, vertices: Array, faces: Array) -> tuple[str, ...]:
    """A sentence on expressions that bring out pieces which are next to a point at rest: cheeks that blush, stars."""
    rest = areas(vertices[faces])
    found = []
    for name, (moved, area) in zip(expressions.names, moved_areas(expressions, vertices, faces), strict=True):
        if area[rest[moved] < POINT * area].sum() > SHOWN * rest.sum():
            found.append(name)
    return (f"{UNFOLDING}{listed(found)}.",) if found else ()


def fingerprints(expressions: Expressions, vertices: int, *, size: float) -> Array:
    """A number [V, 1] below 2^51 for each vertex, equal where all expressions move vertices alike."""
    rng = np.random.default_rng(0)
    factors = rng.integers(1, 2**63, (len(expressions), 3))
    expression = np.repeat(np.arange(len(expressions)), np.diff(expressions.starts))
    steps = np.round(expressions.offsets / (APART * size)).astype(np.int64)
    found = np.zeros(vertices, np.int64)
    np.add.at(found, expressions.vertices, (steps * factors[expression]).sum(axis=1))  # wraps around
    return found[:, None] >> 12


def with_weights(clips: Sequence[Clip], motions: Sequence[Motion], names: Sequence[str]) -> tuple[Clip, ...]:
    """The clips of a scene's motions with the weights of expressions of these names, where a motion moves any."""
    return tuple(replace(c, expressions=_weights(m, names)) for c, m in zip(clips, motions, strict=True))


def moved_expressions(motions: Sequence[Motion]) -> tuple[str, ...]:
    """The names of all expressions that some motion moves."""
    return tuple(dict.fromkeys(name for motion in motions for name in motion.weights))


def _weights(motion: Motion, names: Sequence[str]) -> Array | None:
    """The weights [F, E] of expressions that a motion may call by other names; None where it moves none of them."""
    matrix = match_expressions(names, [*motion.weights])
    if not matrix.any():
        return None
    return np.clip(np.stack([*motion.weights.values()], axis=1) @ matrix.T, 0, 1)
