"""What facial motion moves of a character: expressions, and joints of eyes that gaze turns.

Range maps: https://github.com/vrm-c/vrm-specification/blob/master/specification/VRMC_vrm-1.0/lookAt.md
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.expression_names import match_expressions
from mua.pose.expression_rules import LOOKS, held_back
from mua.pose.expression_vocabulary import known_expression
from mua.rig.character import Character

_SIDES = ("Left", "Right")
_WAYS = ("Out", "In", "Up", "Down")
_GAZE = tuple(f"eyeLook{way}{side}" for side in _SIDES for way in _WAYS)  # ARKit's


@dataclass(frozen=True, eq=False)
class Eye:
    """A joint that gaze turns, and how far whole weights of gaze turn it."""

    joint: int
    parent: Array  # [4] rotation of its parent in the bind pose, in the world
    reach: Array  # [4] degrees out, in, up and down


@dataclass(frozen=True, eq=False)
class MovedFace:
    """The expressions of a character that facial motion moves, and what else follows it."""

    names: tuple[str, ...] = ()  # E
    rules: Array | None = None  # [E] of the expressions (mua.pose.expression_rules)
    eyes: tuple[Eye, ...] = ()  # left, right; none where expressions show the gaze

    def shares(self, source: Sequence[str]) -> Array:
        """How much [E + gaze, S] the expressions of a source move each expression, and then the eyes."""
        return match_expressions((*self.names, *(_GAZE if self.eyes else ())), source)

    def on(
        self,
        clip: Clip,
        weights: Array,  # [F, E + gaze]
    ) -> Clip:
        """The clip with these weights of its expressions, and its eyes turned by what shows of those of gaze."""
        own, gaze = np.split(weights, [len(self.names)], axis=1)
        clip = replace(clip, expressions=own if own.any() else None)
        if not self.eyes:
            return clip
        _, held = held_back(self.rules, own)
        return turned(clip, self.eyes, gaze * (1 - held["look"][:, None]))


NO_FACE = MovedFace()


def face_of(character: Character) -> MovedFace:
    """What facial motion moves of a character that was read from a file."""
    held = character.expressions
    names, rules = ((), None) if held is None else (held.names, held.rules)
    if character.source is None:
        return MovedFace(names, rules)
    looks, nodes = character.source.scene.face_rules, character.source.nodes.tolist()
    joints = [nodes.index(node) for node in looks.eyes if node in nodes]
    shown = {known_expression(name) for name in names} & {*_GAZE, *LOOKS}
    if len(joints) != len(_SIDES) or shown:
        return MovedFace(names, rules)
    turned, at = character.skeleton.world(character.skeleton.bind_rotations, character.skeleton.bind_translations)
    left, right = sorted(joints, key=lambda joint: -at[joint, 0])  # it faces +Z
    reach = np.array([looks.reach[way] for way in _WAYS])
    eyes = tuple(Eye(joint, turned[character.skeleton.parents[joint]], reach) for joint in (left, right))
    return MovedFace(names, rules, eyes)


def turned(
    clip: Clip,
    eyes: Sequence[Eye],  # left, right
    weights: Array,  # [F, 8] of _GAZE
) -> Clip:
    """The clip with its eyes turned from where they look by weights of gaze."""
    rotations = np.array(clip.rotations)
    for eye, outward, own in zip(eyes, (1, -1), np.split(weights, len(eyes), axis=1), strict=True):
        out, inward, up, down = np.radians(own * eye.reach).T
        yaw = rotation.from_axis_angle(np.array([0.0, 1, 0]), outward * (out - inward))
        pitch = rotation.from_axis_angle(np.array([1.0, 0, 0]), down - up)
        turn = rotation.multiply(yaw, pitch)
        local = rotation.multiply(rotation.multiply(rotation.conjugate(eye.parent), turn), eye.parent)
        rotations[:, eye.joint] = rotation.multiply(local, rotations[:, eye.joint])
    return replace(clip, rotations=rotations)
