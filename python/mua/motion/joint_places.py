"""Roles of joints by their places, where names say nothing: legs reach the floor, arms do not, both in pairs alike.

Answered only where a pose is that of a body that stands upright on one pair of legs: a wrong guess would be worse than
the question.
"""

from collections import Counter
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from mua.arrays import Array
from mua.motion.limb_parts import ARM as ARM_PARTS
from mua.motion.limb_parts import LEG as LEG_PARTS
from mua.motion.limb_parts import ankle, chain_length, fork, longest_tail, parts_of
from mua.motion.trunk import degrees, unit
from mua.pose.skeleton import Skeleton

ON_FLOOR = 0.12  # of the height: how near to the lowest joint a leg ends
ARM = 0.2  # of the height: the least length of an arm
LEG = 0.25  # of the height: the least length of a leg
MIRRORED = 0.08  # of the height by which a joint may miss the mirror image of the other side's
ALIKE = 0.05  # of a limb's length by which the bones of one side may differ from those of the other in all
UPRIGHT = 35.0  # degrees by which the way from hips to chest may lean
POINTS = 0.03  # of the height: feet and knees that point this far show which way the body faces
Y = np.array([0.0, 1, 0])

Parts = tuple[int, ...] | None


@dataclass(frozen=True)
class _Limbs:
    """Two mirrored chains of joints, each from where it leaves the trunk to its tip."""

    trunk: int  # the joint that both hang on
    first: tuple[int, ...]
    second: tuple[int, ...]
    length: float  # metres


def roles_by_place(
    skeleton: Skeleton,
    poses: Array | None = None,  # [P, J, 3] places of the joints in frames of a motion
) -> dict[str, str]:
    """Joint name to role (mua.pose.joint_names.ROLES); empty where the places do not show them."""
    if len(set(skeleton.names)) < len(skeleton.names):
        return {}
    return {skeleton.names[joint]: role for joint, role in sorted(joints_by_place(skeleton, poses).items())}


def joints_by_place(skeleton: Skeleton, poses: Array | None = None) -> dict[int, str]:
    """Joint to role by the bind pose; where that is no person who stands, by most of the poses."""
    _, bind = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    bends = bind[None] if poses is None else poses
    found = _by_pose(skeleton, bind, bends)
    if found or poses is None:
        return found
    votes = Counter(tuple(sorted(_by_pose(skeleton, at, bends).items())) for at in poses)
    votes.pop((), None)
    return dict(votes.most_common(1)[0][0]) if votes else {}


def _by_pose(skeleton: Skeleton, at: Array, bends: Array) -> dict[int, str]:
    """Joint to role by the places [J, 3] in one pose, and by where limbs bend in several [P, J, 3]."""
    height = float(np.ptp(at[:, 1]))
    if height <= 0:
        return {}
    pairs = _pairs(skeleton, at, height)
    floor = at[:, 1].min() + ON_FLOOR * height
    legs = [pair for pair in pairs if at[pair.first[-1], 1] < floor and pair.length > LEG * height]
    hips = {pair.trunk for pair in legs}
    if len(hips) != 1:
        return {}
    leg = max(legs, key=lambda pair: pair.length)
    above = [pair for pair in pairs if _apart(skeleton, pair, leg)]
    arms = [pair for pair in above if at[pair.first[-1], 1] > floor and pair.length > ARM * height]
    if not arms:
        return {}
    arm = max(arms, key=lambda pair: (fork(skeleton.parents, at, pair.first) is not None, pair.length))
    if degrees(unit(at[arm.trunk] - at[leg.trunk]), Y) > UPRIGHT:
        return {}
    return _named(skeleton, at, bends, leg, arm)


def _apart(skeleton: Skeleton, pair: _Limbs, leg: _Limbs) -> bool:
    """Whether a pair hangs neither on the joint that the legs hang on nor on the legs."""
    above = {pair.trunk, *skeleton.ancestors(pair.trunk)}
    return pair.trunk != leg.trunk and not above & {*leg.first, *leg.second}


def _pairs(skeleton: Skeleton, at: Array, height: float) -> list[_Limbs]:
    """Every two branches of one joint that are alike, each followed to its farthest tip."""
    found = []
    for trunk in sorted({parent for parent in skeleton.parents.tolist() if parent >= 0}):
        branches = np.flatnonzero(skeleton.parents == trunk).tolist()
        chains = {branch: longest_tail(skeleton.parents, at, branch) for branch in branches}
        for one, other in combinations(chains, 2):
            first, second = chains[one], chains[other]
            joints = min(len(first), len(second))  # what one hand holds makes its chain longer
            if joints < 3:
                continue
            first, second = first[:joints], second[:joints]
            if _mirrored(at, first, second, MIRRORED * height) or _equal(at, first, second):
                found.append(_Limbs(trunk, first, second, chain_length(at, first)))
    return found


def _equal(at: Array, first: tuple[int, ...], second: tuple[int, ...]) -> bool:
    """Whether two chains have bones of the same lengths."""
    one, other = (np.linalg.norm(np.diff(at[list(chain)], axis=0), axis=-1) for chain in (first, second))
    return bool(np.abs(one - other).sum() < ALIKE * max(one.sum(), other.sum()))


def _mirrored(at: Array, first: tuple[int, ...], second: tuple[int, ...], near: float) -> bool:
    """Whether two chains are mirror images about the vertical plane between them."""
    one, other = at[list(first)], at[list(second)]
    across = (one - other).mean(axis=0) * [1, 0, 1]
    if np.linalg.norm(across) <= near / 4:
        return False
    across, middle = unit(across), (one + other).mean(axis=0) / 2
    image = other - 2 * ((other - middle) @ across)[:, None] * across
    return bool(np.linalg.norm(image - one, axis=-1).max() < near)


def _named(skeleton: Skeleton, at: Array, bends: Array, leg: _Limbs, arm: _Limbs) -> dict[int, str]:
    legs = [parts_of(bends, chain, LEG_PARTS, end=ankle(at, chain)) for chain in (leg.first, leg.second)]
    arms = [
        parts_of(bends, chain, ARM_PARTS, end=fork(skeleton.parents, at, chain)) for chain in (arm.first, arm.second)
    ]
    found: dict[int, str] = {leg.trunk: "hips"}
    ahead = _ahead(at, legs, float(np.ptp(at[:, 1])))
    for parts, names in (
        *((parts, ("thigh", "shin", "foot", "toe")) for parts in legs),
        *((parts, ("upper_arm", "forearm", "hand")) for parts in arms),
    ):
        if parts is None:
            return {}
        left = np.cross(Y, ahead) @ (at[parts[0]] - at[leg.trunk]) > 0
        found |= {joint: f"{'left' if left else 'right'} {name}" for joint, name in zip(parts, names, strict=False)}
    if len({role for role in found.values() if role.endswith(("thigh", "upper_arm"))}) < 4:
        return {}
    below = {leg.trunk, *skeleton.ancestors(leg.trunk)}
    way = [joint for joint in (arm.trunk, *skeleton.ancestors(arm.trunk)) if joint not in below]
    found |= dict.fromkeys(way or [arm.trunk], "spine")
    return found | _neck_and_head(skeleton, at, arm, found)


def _ahead(at: Array, legs: list[Parts], height: float) -> Array:
    """Where the body faces: along its feet, else as its knees bend, else along +Z, as files have it."""
    known = [parts for parts in legs if parts is not None]
    feet = [at[parts[3]] - at[parts[2]] for parts in known if len(parts) > 3]
    knees = [at[parts[1]] - (at[parts[0]] + at[parts[2]]) / 2 for parts in known]
    for shown in (feet, knees):
        along = np.sum(shown, axis=0) * [1, 0, 1] if shown else np.zeros(3)
        if np.linalg.norm(along) > POINTS * height:
            return unit(along)
    return np.array([0.0, 0, 1])


def _neck_and_head(skeleton: Skeleton, at: Array, arm: _Limbs, found: dict[int, str]) -> dict[int, str]:
    """The joints that go up from the arms: the last one that carries another, or the only one, is the head."""
    branches = [
        int(joint)
        for joint in np.flatnonzero(skeleton.parents == arm.trunk)
        if joint not in found and joint not in (arm.first[0], arm.second[0]) and at[joint, 1] > at[arm.trunk, 1]
    ]
    if not branches:
        return {}
    chain = [max(branches, key=lambda joint: float(at[joint, 1]))]
    while len(below := np.flatnonzero(skeleton.parents == chain[-1])) == 1:
        chain.append(int(below[0]))
    if len(chain) > 2:
        chain.pop()  # the end of the skull
    return dict.fromkeys(chain[:-1], "neck") | {chain[-1]: "head"}
