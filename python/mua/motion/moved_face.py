"""What facial motion moves of a character: expressions, as a VRM holds them back, and joints of eyes that gaze turns.

Rules and range maps: https://github.com/vrm-c/vrm-specification/blob/master/specification/VRMC_vrm-1.0/expressions.md
and lookAt.md beside it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.expression_names import match_expressions
from mua.pose.expression_vocabulary import known_expression
from mua.rig.character import Character
from mua.scene import NO_RULES, FaceRules

_SIDES = ("Left", "Right")
_WAYS = ("Out", "In", "Up", "Down")
_GAZE = tuple(f"eyeLook{way}{side}" for side in _SIDES for way in _WAYS)  # ARKit's
_LOOKS = ("lookUp", "lookDown", "lookLeft", "lookRight")
_KINDS = {"blink": ("blink", "blinkLeft", "blinkRight"), "look": _LOOKS, "mouth": ("aa", "ih", "ou", "ee", "oh")}


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
    rules: FaceRules = NO_RULES
    eyes: tuple[Eye, ...] = ()  # left, right; none where expressions show the gaze

    def shares(self, source: Sequence[str]) -> Array:
        """How much [E + gaze, S] the expressions of a source move each expression, and then the eyes."""
        return match_expressions((*self.names, *(_GAZE if self.eyes else ())), source)

    def on(
        self,
        clip: Clip,
        weights: Array,  # [F, E + gaze]
    ) -> Clip:
        """The clip with these weights of its expressions, and its eyes turned by those of gaze."""
        count = len(self.names)
        shown, factors = held_back(self.rules, self.names, weights[:, :count])
        clip = replace(clip, expressions=shown if shown.any() else None)
        return turned(clip, self.eyes, weights[:, count:] * factors["look"][:, None]) if self.eyes else clip


NO_FACE = MovedFace()


def face_of(character: Character) -> MovedFace:
    """What facial motion moves of a character that was read from a file."""
    names = () if character.expressions is None else character.expressions.names
    if character.source is None:
        return MovedFace(names)
    rules, nodes = character.source.scene.face_rules, character.source.nodes.tolist()
    joints = [nodes.index(node) for node in rules.eyes if node in nodes]
    shown = {known_expression(name) for name in names} & {*_GAZE, *_LOOKS}
    if len(joints) != len(_SIDES) or shown:
        return MovedFace(names, rules)
    turned, at = character.skeleton.world(character.skeleton.bind_rotations, character.skeleton.bind_translations)
    left, right = sorted(joints, key=lambda joint: -at[joint, 0])  # it faces +Z
    reach = np.array([rules.reach[way] for way in _WAYS])
    eyes = tuple(Eye(joint, turned[character.skeleton.parents[joint]], reach) for joint in (left, right))
    return MovedFace(names, rules, eyes)


def held_back(
    rules: FaceRules,
    names: Sequence[str],  # [E]
    weights: Array,  # [F, E] 0 to 1
) -> tuple[Array, dict[str, Array]]:
    """The weights [F, E] that show, and what is left [F] of blinks, looks and mouths under what holds them back."""
    switched = np.array([name in rules.switched for name in names], bool)
    shown = np.where(switched, weights > 0.5, weights).astype(weights.dtype)
    held = {kind: np.zeros(len(weights)) for kind in _KINDS}
    for column, name in enumerate(names):
        for kind, how in rules.overrides.get(name, {}).items():
            if name not in _KINDS[kind]:
                held[kind] += shown[:, column] > 0 if how == "block" else shown[:, column]
    left = {kind: 1 - np.minimum(sums, 1) for kind, sums in held.items()}
    for column, name in enumerate(names):
        for kind in (kind for kind, own in _KINDS.items() if name in own):
            whole = left[kind] == 1
            shown[:, column] *= whole if switched[column] else left[kind]
    return shown, left


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
