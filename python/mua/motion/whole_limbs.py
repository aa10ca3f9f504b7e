"""Limbs of which names give only some parts, completed by the lengths along their joints.

"arm_joint_1" to "arm_joint_3" are all an arm by their names; a shoulder, an arm and a wrist leave out the elbow.
"""

import numpy as np

from mua.arrays import Array
from mua.motion.limb_parts import ARM, LEG, Proportions, fork, longest_tail, parts_of
from mua.motion.trunk import degrees
from mua.pose.joint_names import SIDES, Roles
from mua.pose.skeleton import Skeleton

_LIMBS: dict[str, tuple[tuple[str, ...], Proportions]] = {
    "arm": (("shoulder", "upper_arm", "forearm", "hand"), ARM),
    "leg": (("thigh", "shin", "foot", "toe"), LEG),
}


TWISTED = 15.0  # degrees by which joints that only twist a limb lie off its line


def with_whole_limbs(
    skeleton: Skeleton,
    found: Roles,
    poses: Array | None = None,  # [P, J, 3] places of the joints in frames of a motion
) -> tuple[Roles, tuple[str, ...]]:
    """The roles with arms and legs made whole, and the names of these limbs."""
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    bends = at if poses is None else poses
    mended = dict(found)
    limbs = []
    for limb, (parts, usual) in _LIMBS.items():
        for side in SIDES:
            upper = f"{side} {_main(parts)[0]}"
            split = _split(skeleton, at, bends, found, side, parts, usual)
            if split:
                mended = {role: joints for role, joints in mended.items() if role not in split}
                mended |= {role: joints for role, joints in split.items() if joints}
                limbs.append(f"{side} {limb}")
            elif len(found.get(upper, ())) > 1:
                mended[upper] = _without_hip(skeleton, at, bends, found, side, parts, usual)
    return mended, tuple(limbs)


def _without_hip(
    skeleton: Skeleton, at: Array, bends: Array, found: Roles, side: str, parts: tuple[str, ...], usual: Proportions
) -> tuple[int, ...]:
    """The joints of an upper part less those before it, which some rigs call by the same name: LHipJoint, LeftHip."""
    upper, lower, end = (found.get(f"{side} {part}", ()) for part in _main(parts))
    chain = limb_chain(skeleton, at, found, side, parts)
    split = None if chain is None else parts_of(bends, chain, usual, end=end[0] if end else None)
    if split is None or not lower or split[1] != lower[0] or split[0] not in upper[1:]:
        return upper
    first = upper.index(split[0])
    above, at_begin, at_bend = (bends[..., joint, :] for joint in (upper[first - 1], split[0], split[1]))
    return upper[first:] if np.max(degrees(at_begin - above, at_bend - at_begin)) > TWISTED else upper


def _split(
    skeleton: Skeleton, at: Array, bends: Array, found: Roles, side: str, parts: tuple[str, ...], usual: Proportions
) -> dict[str, tuple[int, ...]]:
    """Joints of all parts of a limb, none for those that it lacks; {} where names are enough or lengths say nothing."""
    upper, lower, end = (f"{side} {part}" for part in _main(parts))
    # a second joint of the lower part may be the hand or foot, unless the upper part has as many: twist joints in both
    twisted = end not in found and len(found.get(lower, ())) > max(1, len(found.get(upper, ())))
    if not (upper in found or lower in found) or (upper in found and lower in found and not twisted):
        return {}
    chain = limb_chain(skeleton, at, found, side, parts)
    if chain is None:
        return {}
    known = found[end][0] if end in found else fork(skeleton.parents, at, chain) if usual is ARM else None
    split = parts_of(bends, chain, usual, end=known)
    if split is None:
        return {}
    ends = [chain.index(joint) for joint in split[:3]]
    named = {upper: chain[ends[0] : ends[1]], lower: chain[ends[1] : ends[2]], end: chain[ends[2] : ends[2] + 1]}
    if usual is ARM:
        return {f"{side} shoulder": chain[: ends[0]]} | named
    return named | {f"{side} toe": split[3:]}


def _main(parts: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(part for part in parts if part not in ("shoulder", "toe"))


def limb_chain(
    skeleton: Skeleton, at: Array, found: Roles, side: str, parts: tuple[str, ...]
) -> tuple[int, ...] | None:
    """Joints from where a limb leaves the trunk to its tip; None where its joints are no chain."""
    ours, theirs = (
        sorted({joint for part in parts for joint in found.get(f"{whose} {part}", ())})
        for whose in (side, _other(side))
    )
    if not ours or not theirs:
        return None
    way = [ours[-1], *skeleton.ancestors(ours[-1])]
    trunk = {theirs[-1], *skeleton.ancestors(theirs[-1])}
    below = [joint for joint in way if joint not in trunk]
    if not below or not set(ours) <= set(below):
        return None
    return (*below[:0:-1], *longest_tail(skeleton.parents, at, ours[-1]))


def _other(side: str) -> str:
    return SIDES[1 - SIDES.index(side)]
