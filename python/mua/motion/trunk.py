"""A trunk by the joints around it: which way is up, and left, whatever a rest pose says."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.joint_names import SIDES

WIDE = 0.1  # of the way between the shoulders: collar bones that begin farther apart than this show left and right
AT_EASE = np.radians(5)  # by which people's shoulder joints are behind their hip joints while they stand upright
HANGING = 60.0  # degrees from straight down within which legs of a standing body point
RAISED = 45.0  # degrees from straight up within which arms of a standing body do not point
MIRRORED = 15.0  # degrees by which a limb may differ from the mirror image of the other
STRAIGHT = {"shin": 20.0, "forearm": 45.0}  # degrees by which knees and elbows of a body at rest may bend
POINTED = 20.0  # degrees between shin and foot below which the foot only continues the leg
LEVEL = 30.0  # degrees from the horizontal within which the trunk of a standing animal lies
DOWN = 30.0  # degrees from straight down within which its legs reach the ground
ALL_FOURS = (("upper_arm", "hand"), ("thigh", "foot"))
Y = np.array([0.0, 1, 0])
LEGS = (("thigh", "shin"), ("shin", "foot"))
ARMS = (("upper_arm", "forearm"), ("forearm", "hand"))
AROUND = (
    "hips",
    "neck",
    "head",
    *(f"{side} {part}" for side in SIDES for part in ("thigh", "shoulder", "upper_arm")),
)


@dataclass(frozen=True, eq=False)
class Trunk:
    """A trunk in the world: directions [..., 3] up, and left at the hips and at the shoulders."""

    up: Array
    hips: Array
    chest: Array


def trunk_of(at: Mapping[str, Array]) -> Trunk | None:
    """Up and left of a trunk by the places [..., 3] of its roles; None where they do not show it."""

    def line(part: str) -> Array | None:
        left, right = (at.get(f"{side} {part}") for side in SIDES)
        return None if left is None or right is None else left - right

    def middle(part: str) -> Array | None:
        left, right = (at.get(f"{side} {part}") for side in SIDES)
        return None if left is None or right is None else (left + right) / 2

    bottom = middle("thigh") if middle("thigh") is not None else at.get("hips")
    tops = (middle("upper_arm"), middle("shoulder"), at.get("neck"), at.get("head"))
    top = next((top for top in tops if top is not None), None)
    hips, arms, collars = line("thigh"), line("upper_arm"), line("shoulder")
    chest = arms if arms is not None else collars
    if arms is not None and collars is not None and _length(collars) > WIDE * _length(arms):
        chest = collars
    hips, chest = (hips if hips is not None else chest), (chest if chest is not None else hips)
    if top is None or bottom is None or hips is None or chest is None:
        return None
    if min(_length(top - bottom), _length(hips), _length(chest)) == 0:
        return None
    return Trunk(unit(top - bottom), unit(hips), unit(chest))


def leaned(trunk: Trunk, angle: float) -> Array:
    """The direction up [..., 3] leaned forward by an angle in radians, about the line through the hips."""
    axis = np.cross(trunk.up, np.cross(trunk.hips, trunk.up))
    return rotation.rotate(rotation.from_axis_angle(unit(axis), angle), trunk.up)


def lean_of(trunk: Trunk) -> float:
    """Radians by which a trunk at rest [3] leans forward from the axis that is up for its body."""
    up = nearest_axis(trunk.up)
    return float(np.arctan2(trunk.up @ unit(np.cross(trunk.hips, up)), trunk.up @ up))


def nearest_axis(v: Array) -> Array:
    """The signed coordinate axis [3] nearest to v [3]: what is up for a body that leans in its rest pose."""
    axis = int(np.argmax(np.abs(v)))
    return np.asarray(np.sign(v[axis]) * np.eye(3)[axis])


def stands(at: Mapping[str, Array]) -> bool:
    """Whether places [3] of roles are those of a body made to stand: legs down and straight, arms not up, sides alike.

    A frame of some motion is none: what its limbs do would pass for what limbs do at rest.
    """
    trunk = trunk_of({role: at[role] for role in AROUND if role in at})
    if trunk is None:
        return False
    bones = {
        (side, begin): unit(at[f"{side} {end}"] - at[f"{side} {begin}"])
        for begin, end in (*LEGS, *ARMS, ("foot", "toe"))
        for side in SIDES
        if f"{side} {begin}" in at and f"{side} {end}" in at
    }
    across = unit(np.cross(trunk.up, np.cross(trunk.hips, trunk.up)))
    for (side, part), bone in bones.items():
        if part in ("thigh", "shin") and degrees(bone, -trunk.up) > HANGING:
            return False
        if part == "upper_arm" and degrees(bone, trunk.up) < RAISED:
            return False
        if part == "foot" and (side, "shin") in bones and degrees(bone, bones[side, "shin"]) < POINTED:
            return False
        above = bones.get((side, {"shin": "thigh", "forearm": "upper_arm"}.get(part, "")))
        if above is not None and degrees(bone, above) > STRAIGHT[part]:
            return False
        other = bones.get(("right", part)) if side == "left" and part != "foot" else None
        if other is not None and degrees(bone, other - 2 * (other @ across) * across) > MIRRORED:
            return False
    return True


def on_all_fours(at: Mapping[str, Array]) -> bool:
    """Whether places [3] of roles are those of an animal that stands: trunk level, all four legs down."""
    trunk = trunk_of({role: at[role] for role in AROUND if role in at})
    if trunk is None or abs(trunk.up[1]) > np.sin(np.radians(LEVEL)):
        return False
    legs = [(at.get(f"{side} {top}"), at.get(f"{side} {end}")) for top, end in ALL_FOURS for side in SIDES]
    known = [(top, end) for top, end in legs if top is not None and end is not None]
    return len(known) == len(legs) and all(degrees(end - top, -Y) < DOWN for top, end in known)


def unit(v: Array) -> Array:
    """Directions [..., 3] of vectors; those without length stay 0."""
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.where(length > 0, length, 1))


def degrees(a: Array, b: Array) -> Array:
    """Angles [...] between vectors [..., 3]."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)))


def _length(v: Array) -> float:
    return float(np.linalg.norm(v, axis=-1).min())
