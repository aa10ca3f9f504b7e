"""Two skeletons at rest, and how each joint of one lies in the joint that moves it by what both rest poses show.

The alignment of a target joint brings the target's bind pose to the source's rest pose: the turn of the whole body,
then limb by limb the shortest rotation between the bones' directions, so that a T-pose, an A-pose and legs apart all
mean the same.
"""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.limb_parts import longest_tail
from mua.motion.match import Matches
from mua.motion.trunk import SIDES, nearest_axis, unit
from mua.pose.joint_names import Roles
from mua.pose.skeleton import Skeleton

LIMBS = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shin", "shin": "foot"}  # bones aligned: where they end
CLEARLY = 10  # times nearer to the shin's plane than to the vertical one: a foot that rolls with its leg

IDENTITY = np.array([1.0, 0, 0, 0])
Y = np.array([0.0, 1, 0])


@dataclass(frozen=True, eq=False)
class Rest:
    """Both skeletons at rest in the world, and which source joints move which target joints."""

    target: Skeleton
    target_turned: Array  # [T, 4]
    target_at: Array  # [T, 3] metres
    source: Skeleton
    source_turned: Array  # [S, 4]
    source_at: Array  # [S, 3] metres
    matches: Matches

    def joint(self, role: str) -> int | None:
        """The first matched target joint of a role."""
        return self.matches.joint(role)

    def places(self, role: str) -> Array | None:
        """[2, 3] where a role begins on target and source, None if it is not matched."""
        ends = self.matches.ends(role)
        return None if ends is None else np.stack([self.target_at[ends[0]], self.source_at[ends[1]]])

    def source_places(self) -> dict[str, Array]:
        """Where the matched roles begin on the source [3]."""
        ends = {role: self.matches.ends(role) for role in self.matches.roles}
        return {role: self.source_at[pair[1]] for role, pair in ends.items() if pair is not None}

    def ends(self, role: str, end: str) -> tuple[int, int] | None:
        """The joints of target and source where a bone ends: those of role `end`, else where its chain goes on."""
        matched = self.matches.ends(end)
        if matched is not None:
            return matched
        target = _next(self.target, self.target_at, self.matches.roles, role, end)
        source = _next(self.source, self.source_at, self.matches.source_roles, role, end)
        return None if target is None or source is None else (target, source)

    def middle(self, part: str) -> Array | None:
        """[2, 3] the middle between left and right."""
        left, right = (self.places(f"{side} {part}") for side in SIDES)
        return None if left is None or right is None else (left + right) / 2


def _next(skeleton: Skeleton, at: Array, roles: Roles, role: str, end: str) -> int | None:
    """The joint of role `end`; where there is none, as in arms that end in fingers, the next of the longest chain."""
    if end in roles or role not in roles:
        return next(iter(roles.get(end, ())), None)
    return next(iter(longest_tail(skeleton.parents, at, roles[role][-1])[1:]), None)


def rest_calibrations(rest: Rest, upright: Array) -> dict[int, Array]:
    """The rotation [4] from the target's bind world to the space of the moving joint, of every matched target joint."""
    return {
        joint: rotation.multiply(rotation.conjugate(rest.source_turned[rest.matches.chains[joint][1]]), turn)
        for joint, turn in _alignments(rest, upright).items()
    }


def rest_of(source: Skeleton, target: Skeleton, matches: Matches) -> Rest:
    target_rest = target.world(target.bind_rotations, target.bind_translations)
    source_rest = source.world(source.bind_rotations, source.bind_translations)
    return Rest(target, *target_rest, source, *source_rest, matches=matches)


def body_turn(rest: Rest) -> Array:
    """The rotation [4] from the target's bind to the source's rest pose as whole bodies, identity where unknown."""
    top = next((places for role in ("head", "neck", "spine") if (places := rest.places(role)) is not None), None)
    bottom = middle if (middle := rest.middle("thigh")) is not None else rest.places("hips")
    across = next(
        (pair for part in ("thigh", "upper_arm", "shoulder") if (pair := _across(rest, part)) is not None), None
    )
    if top is None or bottom is None or across is None:
        return IDENTITY
    pairs = [(nearest_axis(up), left) for up, left in zip(top - bottom, across, strict=True)]
    if not all(np.cross(left, up).any() for up, left in pairs):
        return IDENTITY
    frames = [frame(up, left) for up, left in pairs]
    return rotation.multiply(rotation.from_matrix(frames[1]), rotation.conjugate(rotation.from_matrix(frames[0])))


def _across(rest: Rest, part: str) -> Array | None:
    """[2, 3] from right to left."""
    left, right = (rest.places(f"{side} {part}") for side in SIDES)
    return None if left is None or right is None else left - right


def frame(up: Array, left: Array) -> Array:
    """Rotation matrix [3, 3] with columns left, up, forward; `up` [3] is kept, `left` [3] made square to it."""
    forward = unit(np.cross(left, up))
    return np.stack([np.cross(up, forward), up, forward], axis=-1)


def _alignments(rest: Rest, upright: Array) -> dict[int, Array]:
    """A_t [4] of every matched target joint, from the root outwards: each starts from that of the joint above."""
    found: dict[int, Array] = {}
    parts = {joint: role for role, joints in rest.matches.roles.items() for joint in joints}
    for joint in sorted(rest.matches.chains):
        above = int(rest.target.parents[joint])
        while above >= 0 and above not in found:
            above = int(rest.target.parents[above])
        base = found.get(above, upright)
        role = parts.get(joint, "")
        side, _, part = role.rpartition(" ")
        if part == "foot":
            found[joint] = _sole_alignment(rest, side, upright, base)
        elif part == "hand":
            palm = palm_alignment(rest, side) if joint == rest.joint(role) else None
            found[joint] = base if palm is None else palm
        elif part in LIMBS:
            found[joint] = _bone_alignment(rest, role, f"{side} {LIMBS[part]}", base)
        else:
            found[joint] = base
    return found


def _bone_alignment(rest: Rest, role: str, end: str, base: Array) -> Array:
    """`base` [4], then the shortest rotation that lays the target's bone from `role` to `end` along the source's."""
    begins, joints = rest.places(role), rest.ends(role, end)
    if begins is None or joints is None:
        return base
    ends = np.stack([rest.target_at[joints[0]], rest.source_at[joints[1]]])
    lengths = np.linalg.norm(ends - begins, axis=-1)
    if not lengths.all():
        return base
    target_bone, source_bone = (ends - begins) / lengths[:, None]
    return rotation.multiply(rotation.between(rotation.rotate(base, target_bone), source_bone), base)


def _sole_alignment(rest: Rest, side: str, upright: Array, base: Array) -> Array:
    """The rotation [4] between the level soles of target and source at rest."""
    knee, ankle, ball = (rest.places(f"{side} {part}") for part in ("shin", "foot", "toe"))
    toe = rest.joint(f"{side} toe")
    if knee is None or ankle is None or ball is None or toe is None:
        return base
    tips = (
        _first_child(rest.target, rest.target_at, toe),
        _first_child(rest.source, rest.source_at, rest.matches.chains[toe][1]),
    )
    up = np.stack([Y, nearest_axis(rotation.rotate(upright, Y))])
    target_sole, source_sole = (_sole_frame(knee[i], ankle[i], ball[i], tips[i], up[i]) for i in range(2))
    if target_sole is None or source_sole is None:
        return base
    return rotation.multiply(rotation.from_matrix(source_sole), rotation.conjugate(rotation.from_matrix(target_sole)))


def palm_alignment(rest: Rest, side: str) -> Array | None:
    """The rotation [4] between the palms of target and source at rest, by where fingers begin; None where unknown.

    Fingers begin at fixed places of the palm, so that it does not matter which way a rest pose holds it.
    """
    places = [rest.places(f"{side} {part}") for part in ("hand", "index", "middle", "pinky")]
    if any(pair is None for pair in places):
        return None
    target, source = (_palm(*(pair[i] for pair in places if pair is not None)) for i in range(2))
    if target is None or source is None:
        return None
    return rotation.multiply(rotation.from_matrix(source), rotation.conjugate(rotation.from_matrix(target)))


def _palm(wrist: Array, index: Array, middle: Array, pinky: Array) -> Array | None:
    """Columns along the fingers, across the hand and out of its back [3, 3]; None where these places lie in a line."""
    fingers = unit(middle - wrist)
    out = unit(np.cross(fingers, index - pinky))
    return np.stack([fingers, np.cross(out, fingers), out], axis=-1) if out.any() else None


def _first_child(skeleton: Skeleton, at: Array, joint: int) -> Array | None:
    children = np.flatnonzero(skeleton.parents == joint)
    return at[children[0]] if len(children) else None


def _sole_frame(knee: Array, ankle: Array, ball: Array, tip: Array | None, up: Array) -> Array | None:
    """Columns left, up, forward of a sole at rest, which is level along the foot; None where toes point up or nowhere.

    Across the foot it is level too, unless the foot continues a leg that is set apart, as in the zero pose of ASF
    skeletons: there ball and toes lie in one plane with the shin rather than with the vertical.
    """
    toes = ball - ankle if tip is None else tip - ball
    level, rolled = (np.cross(above, toes) for above in (up, knee - ankle))
    if not (level.any() and rolled.any()):
        return None
    level, rolled = unit(level), unit(rolled)
    rolls = CLEARLY * abs(rolled @ (ball - ankle)) < abs(level @ (ball - ankle))
    left = rolled if rolls else level
    forward = unit(np.cross(left, up))
    return np.stack([left, np.cross(forward, left), forward], axis=-1)
