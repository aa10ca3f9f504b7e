"""How each target joint lies in the joint that moves it, by what the posed skeleton does over the frames of a clip.

Rest poses of many exports say nothing: every bone lies along one axis, or the rest is some frame of the motion. What
the joints' places in the world say holds for all of them, because a bone keeps its place in its own joint:

- trunk: up is the way from hips to shoulders while the body is most upright, left runs through hips and shoulders;
- limbs: along the bone, and about the axis on which elbow or knee bends;
- hands: the palm, by where fingers begin;
- feet: a standing sole is level;
- the head is level on average, and the neck between it and the trunk;
- all else (collar bones, palms without fingers): on average as in the bind pose, relative to the part above.
"""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.contacts import planted
from mua.motion.rest_alignment import IDENTITY, Rest, Y, palm_alignment
from mua.motion.trunk import AROUND, AT_EASE, Trunk, degrees, leaned, nearest_axis, trunk_of, unit
from mua.pose.descriptor import heading_of
from mua.pose.joint_names import FINGERS, ROLES

UPRIGHT = 0.75  # quantile of uprightness from which a frame shows how the trunk is at ease
PRIOR = 0.1  # weight of the axis that a straight limb would bend about, against that seen while it bends
UPPER = {"upper_arm": "forearm", "thigh": "shin"}
LOWER = {"forearm": ("upper_arm", "hand"), "shin": ("thigh", "foot")}
LEVEL = 35.0  # degrees: a sole that stands farther from what its bones say stands on something other than the floor
NODDED = 25.0  # degrees: a bone of the head farther from upright than a head is held is no measure of it
LYING = 60.0  # degrees from upright from which a body holds its head anyhow
_CARRIERS = {"hand": "forearm", "foot": "shin"}  # for rigs whose hands and feet hang on nothing but controls
_OUTWARDS = {role: i for i, role in enumerate(ROLES)}


@dataclass(frozen=True, eq=False)
class _Frames:
    """The target's bind pose and the source, frame by frame."""

    rest: Rest
    turned: Array  # [F, S, 4] source
    at: Array  # [F, S, 3] source, metres
    rate: float
    bind: Trunk  # of the target
    trunk: Trunk  # of the source
    upright: Array  # [F] bool

    def own(self, joint: int, v: Array) -> Array:
        """World directions v [F, 3] in the space of the source joint that moves a target joint."""
        return rotation.rotate(rotation.conjugate(self.moving(joint)), v)

    def moving(self, joint: int) -> Array:
        """World rotations [F, 4] of the source joint that moves a target joint."""
        return self.turned[:, self.rest.matches.chains[joint][1]]

    def bone(self, begin: str, end: str) -> tuple[Array, Array] | None:
        """Directions between the places of two roles: the target's in bind [3], the source's [F, 3]."""
        first, second = self.rest.matches.ends(begin), self.rest.ends(begin, end)
        if first is None or second is None:
            return None
        target = self.rest.target_at[second[0]] - self.rest.target_at[first[0]]
        source = self.at[:, second[1]] - self.at[:, first[1]]
        return (unit(target), unit(source)) if target.any() and source.any() else None


def posed_calibrations(
    rest: Rest,
    turned: Array,  # [F, S, 4] world rotations of the source
    at: Array,  # [F, S, 3] world positions of the source, metres
    rate: float,  # frames per second
) -> dict[int, Array]:
    """The rotation [4] from the target's bind world to the space of the moving joint, of every matched target joint.

    Empty where hips and shoulders cannot be recognised.
    """
    bind = trunk_of({role: rest.target_at[ends[0]] for role in AROUND if (ends := rest.matches.ends(role)) is not None})
    trunk = trunk_of({role: at[:, ends[1]] for role in AROUND if (ends := rest.matches.ends(role)) is not None})
    if bind is None or trunk is None:
        return {}
    bind = Trunk(nearest_axis(bind.up), bind.hips, bind.chest)
    trunk = Trunk(leaned(trunk, AT_EASE), trunk.hips, trunk.chest)
    upright = trunk.up[:, 1] >= np.quantile(trunk.up[:, 1], UPRIGHT)
    frames = _Frames(rest, turned, at, rate, bind, trunk, upright)
    found: dict[int, Array] = {}
    parts = {joint: role for role, joints in rest.matches.roles.items() for joint in joints}
    for joint in sorted(rest.matches.chains, key=lambda joint: (_OUTWARDS.get(parts.get(joint, ""), 0), joint)):
        found[joint] = _calibration(frames, joint, parts.get(joint, ""), found)
    return found


def _calibration(frames: _Frames, joint: int, role: str, found: dict[int, Array]) -> Array:
    side, _, part = role.rpartition(" ")
    turn = None
    if role in ("hips", "spine"):
        turn = _trunk_calibration(frames, joint, role)
    elif part in UPPER:
        turn = _upper_calibration(frames, joint, side, part, found)
    elif part in LOWER:
        turn = _lower_calibration(frames, joint, side, part, found)
    elif part == "hand" and joint == frames.rest.joint(role):
        turn = _hand_calibration(frames, joint, side)
    elif part == "foot":
        turn = _foot_calibration(frames, joint, side, found)
    elif role == "neck":
        turn = _neck_calibration(frames, joint, found)
    elif role == "head":
        turn = _head_calibration(frames, joint, found)
    elif part in FINGERS:
        turn = _finger_calibration(frames, joint, role, found)
    return _calibration_as_above(frames, joint, found) if turn is None else turn


def _trunk_calibration(frames: _Frames, joint: int, role: str) -> Array | None:
    """Calibration of a joint of the trunk by up and by left: that of the hips below, that of the shoulders above."""
    chain = frames.rest.matches.roles[role]
    share = 0.0 if role == "hips" else (chain.index(joint) + 1) / len(chain)
    left = (1 - share) * frames.trunk.hips + share * frames.trunk.chest
    up = frames.own(joint, frames.trunk.up)[frames.upright].mean(axis=0)
    across = frames.own(joint, left)[frames.upright].mean(axis=0)
    bind = (1 - share) * frames.bind.hips + share * frames.bind.chest
    return _between(bind, frames.bind.up, across, up)


def _upper_calibration(frames: _Frames, joint: int, side: str, part: str, found: dict[int, Array]) -> Array | None:
    """Calibration of an upper arm or thigh by its bone and by the axis on which elbow or knee bends."""
    bones = frames.bone(f"{side} {part}", f"{side} {UPPER[part]}")
    if bones is None:
        return None
    end = "hand" if part == "upper_arm" else "foot"
    lower = frames.bone(f"{side} {UPPER[part]}", f"{side} {end}")
    at_ease, axis = _at_ease(frames, side, part)
    above = _world(frames, joint, found)
    bent = PRIOR * _carried(rotation.rotate(above, at_ease), bones[1], rotation.rotate(above, axis))
    if lower is not None:
        bent = bent + np.cross(bones[1], lower[1])
    along, across = (frames.own(joint, v).mean(axis=0) for v in (bones[1], bent))
    return _between(bones[0], _carried(at_ease, bones[0], axis), along, across)


def _lower_calibration(frames: _Frames, joint: int, side: str, part: str, found: dict[int, Array]) -> Array | None:
    """Calibration of a forearm or shin, as `_upper_calibration`."""
    upper, end = LOWER[part]
    above, bones = frames.bone(f"{side} {upper}", f"{side} {part}"), frames.bone(f"{side} {part}", f"{side} {end}")
    if above is None or bones is None:
        return None
    at_ease, axis = _at_ease(frames, side, upper)
    axis = _carried(at_ease, above[0], axis)
    seen = rotation.rotate(_world(frames, joint, found), axis)
    bent = np.cross(above[1], bones[1]) + PRIOR * _carried(above[1], bones[1], seen)
    along, across = (frames.own(joint, v).mean(axis=0) for v in (bones[1], bent))
    return _between(bones[0], _carried(above[0], bones[0], axis), along, across)


def _at_ease(frames: _Frames, side: str, part: str) -> tuple[Array, Array]:
    """Where a limb at ease points in the bind pose's world (legs hang, arms are level), and the axis it bends about."""
    if part == "thigh":
        return -frames.bind.up, frames.bind.hips
    outward = frames.bind.chest if side == "left" else -frames.bind.chest
    return outward, -frames.bind.up if side == "left" else frames.bind.up


def _foot_calibration(frames: _Frames, joint: int, side: str, found: dict[int, Array]) -> Array | None:
    """Calibration of a foot by its sole, level while it stands; by the bone to the toe where none is on the floor."""
    bones, ends = frames.bone(f"{side} foot", f"{side} toe"), frames.rest.matches.ends(f"{side} toe")
    if bones is None or ends is None:
        return None
    ahead = frames.own(joint, bones[1]).mean(axis=0)
    across = frames.own(joint, rotation.rotate(_world(frames, joint, found), frames.bind.hips)).mean(axis=0)
    by_bone = _between(bones[0], frames.bind.hips, ahead, across)
    leg = float(np.ptp(frames.at[..., 1], axis=1).max()) / 2
    points = frames.at[:, [frames.rest.matches.chains[joint][0], ends[1]]]
    flat = planted(points, frames.rate, leg).all(axis=1)
    if by_bone is None or not flat.any():
        return by_bone
    up = frames.own(joint, np.broadcast_to(Y, bones[1].shape))[flat].mean(axis=0)
    on_floor = degrees(up, rotation.rotate(by_bone, frames.bind.up)) < LEVEL
    return _between(frames.bind.up, bones[0], up, ahead) if on_floor else by_bone


def _head_calibration(frames: _Frames, joint: int, found: dict[int, Array]) -> Array:
    """Calibration of the head as level and straight ahead on average, or as a bone shows the skull.

    Frames in which the body is most upright do not show how a head is held: a dancer looks down in them.
    """
    base = _level(frames, joint, found)
    ends = np.flatnonzero(frames.rest.source.parents == frames.rest.matches.chains[joint][1])
    if len(ends) != 1:
        return base
    top = unit(frames.rest.source.bind_translations[ends[0]])
    stands = top.any() and degrees(top, rotation.rotate(base, frames.bind.up)) < NODDED
    return _laid(base, frames.bind.up, top) if stands else base


def _neck_calibration(frames: _Frames, joint: int, found: dict[int, Array]) -> Array:
    """Calibration of a neck between what it hangs on and the head."""
    above, level = _calibration_as_above(frames, joint, found), _level(frames, joint, found)
    chain = frames.rest.matches.roles["neck"]
    share = (chain.index(joint) + 1) / (len(chain) + 1)
    level = level if above @ level > 0 else -level
    return rotation.normalize((1 - share) * above + share * level)


def _level(frames: _Frames, joint: int, found: dict[int, Array]) -> Array:
    """Calibration as level and as the part above is turned about the vertical, on average while nobody lies."""
    standing = frames.trunk.up[:, 1] > np.cos(np.radians(LYING))
    if not standing.any():
        return _calibration_as_above(frames, joint, found)
    own = rotation.conjugate(frames.moving(joint))
    return _mean(rotation.multiply(own, heading_of(_world(frames, joint, found)))[standing])


def _hand_calibration(frames: _Frames, joint: int, side: str) -> Array | None:
    """Calibration of a hand by its palm, which lies in the joint of the hand as at rest in every frame."""
    palm = palm_alignment(frames.rest, side)
    resting = frames.rest.source_turned[frames.rest.matches.chains[joint][1]]
    return None if palm is None else rotation.multiply(rotation.conjugate(resting), palm)


def _finger_calibration(frames: _Frames, joint: int, role: str, found: dict[int, Array]) -> Array | None:
    """Calibration of a finger as of the joint above, with its bone laid along the source's."""
    chain = frames.rest.matches.roles[role]
    after = chain.index(joint) + 1
    if after >= len(chain) or chain[after] not in frames.rest.matches.chains:
        return None
    target = frames.rest.target_at[chain[after]] - frames.rest.target_at[joint]
    first, last = (frames.rest.matches.chains[j][0] for j in (joint, chain[after]))
    source = frames.own(joint, frames.at[:, last] - frames.at[:, first]).mean(axis=0)
    if not (target.any() and source.any()):
        return None
    return _laid(_calibration_as_above(frames, joint, found), unit(target), unit(source))


def _calibration_as_above(frames: _Frames, joint: int, found: dict[int, Array]) -> Array:
    """Calibration as in the bind pose relative to the part above, on average over upright frames."""
    own = rotation.conjugate(frames.moving(joint))
    return _mean(rotation.multiply(own, _world(frames, joint, found))[frames.upright])


def _world(frames: _Frames, joint: int, found: dict[int, Array]) -> Array:
    """Rotations [F, 4] from the target's bind world to the source's world that the part above a joint shows."""
    part = next((role for role, joints in frames.rest.matches.roles.items() if joint in joints), "")
    side, _, part = part.rpartition(" ")
    carriers = (frames.rest.joint(f"{side} {_CARRIERS.get(part)}"), frames.rest.joint("hips"))
    chain = [*frames.rest.target.ancestors(joint), *carriers]
    above = next((joint for joint in chain if joint in found), None)
    if above is None:
        return np.tile(IDENTITY, (len(frames.at), 1))
    return rotation.multiply(frames.moving(above), found[above])


def _between(first: Array, second: Array, to_first: Array, to_second: Array) -> Array | None:
    """The rotation [4] that takes `first` to `to_first` and `second` near to `to_second` [3]; None if two are one."""
    sides = np.cross(first, second), np.cross(to_first, to_second)
    if min(np.linalg.norm(sides[0]), np.linalg.norm(sides[1])) < 1e-6:
        return None
    frames = [
        np.stack([unit(along), unit(side), np.cross(unit(along), unit(side))], axis=-1)
        for along, side in zip((first, to_first), sides, strict=True)
    ]
    return rotation.from_matrix(frames[1] @ frames[0].T)


def _laid(turn: Array, target: Array, source: Array) -> Array:
    """`turn` [4], then the shortest rotation after which it takes one direction [3] to the other."""
    return rotation.multiply(rotation.between(rotation.rotate(turn, target), source), turn)


def _carried(begin: Array, end: Array, v: Array) -> Array:
    """Vectors v [..., 3] turned by the shortest rotation from directions `begin` to `end` [..., 3]."""
    return rotation.rotate(rotation.between(begin, end), v)


def _mean(q: Array) -> Array:
    """The rotation [4] nearest to all of q [N, 4] (Markley et al. 2007, https://doi.org/10.2514/1.28949)."""
    return np.asarray(np.linalg.eigh(q.T @ q)[1][:, -1])
