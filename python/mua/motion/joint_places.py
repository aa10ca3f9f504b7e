"""What joints are by their places, where names say nothing: legs reach the floor, arms do not, both in mirrored pairs.

Asked only of skeletons none of whose limbs is known by name, and answered only where the bind pose is a body that
stands upright on one pair of legs: a wrong guess would be worse than the question.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from mua.arrays import Array
from mua.motion.trunk import degrees, unit
from mua.pose.skeleton import Skeleton

ON_FLOOR = 0.12  # of the height: how near to the lowest joint a leg ends
ARM = 0.2  # of the height: the least length of an arm
LEG = 0.25  # of the height: the least length of a leg
MIRRORED = 0.08  # of the height by which a joint may miss the mirror image of the other side's
LONG = 0.2  # of a limb: bones from this length on are thigh and shin, or upper arm and forearm
UPRIGHT = 35.0  # degrees by which the way from hips to chest may lean
POINTS = 0.03  # of the height: a foot of this length shows which way the body faces
Y = np.array([0.0, 1, 0])


@dataclass(frozen=True)
class _Limbs:
    """Two mirrored chains of joints, each from where it leaves the trunk to its tip."""

    trunk: int  # the joint that both hang on
    first: tuple[int, ...]
    second: tuple[int, ...]
    length: float  # metres


def roles_by_place(skeleton: Skeleton) -> dict[str, str]:
    """Joint name to role (mua.pose.joint_names.ROLES); empty where the places do not tell."""
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    height = float(np.ptp(at[:, 1]))
    if height <= 0 or len(set(skeleton.names)) < len(skeleton.names):
        return {}
    pairs = _pairs(skeleton, at, height)
    floor = at[:, 1].min() + ON_FLOOR * height
    legs = [pair for pair in pairs if at[pair.first[-1], 1] < floor and pair.length > LEG * height]
    hips = {pair.trunk for pair in legs}
    if len(hips) != 1:
        return {}
    leg = max(legs, key=lambda pair: pair.length)
    above = [pair for pair in pairs if pair.trunk != leg.trunk and leg.trunk in skeleton.ancestors(pair.trunk)]
    arms = [pair for pair in above if at[pair.first[-1], 1] > floor and pair.length > ARM * height]
    if not arms:
        return {}
    arm = max(arms, key=lambda pair: pair.length)
    if degrees(unit(at[arm.trunk] - at[leg.trunk]), Y) > UPRIGHT:
        return {}
    return _named(skeleton, at, height, leg, arm)


def _pairs(skeleton: Skeleton, at: Array, height: float) -> list[_Limbs]:
    """Every two mirrored branches of one joint, each followed to its farthest tip."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(skeleton.parents.tolist()):
        children.setdefault(parent, []).append(joint)
    found = []
    for trunk, branches in children.items():
        chains = {branch: _longest(children, at, branch) for branch in branches} if trunk >= 0 else {}
        for one, other in combinations(chains, 2):
            first, second = chains[one], chains[other]
            if min(len(first), len(second)) >= 3 and _mirrored(at, first, second, MIRRORED * height):
                length = float(np.linalg.norm(np.diff(at[list(first)], axis=0), axis=-1).sum())
                found.append(_Limbs(trunk, first, second, length))
    return found


def _longest(children: dict[int, list[int]], at: Array, joint: int) -> tuple[int, ...]:
    """The chain of joints from `joint` on that is longest along its bones."""
    tails = [_longest(children, at, child) for child in children.get(joint, ())]
    if not tails:
        return (joint,)
    return (joint, *max(tails, key=lambda tail: _length(at, (joint, *tail))))


def _length(at: Array, chain: tuple[int, ...]) -> float:
    return float(np.linalg.norm(np.diff(at[list(chain)], axis=0), axis=-1).sum())


def _mirrored(at: Array, first: tuple[int, ...], second: tuple[int, ...], near: float) -> bool:
    """Whether two chains are mirror images about the vertical plane between them."""
    if len(first) != len(second):
        return False
    one, other = at[list(first)], at[list(second)]
    across = (one - other).mean(axis=0) * [1, 0, 1]
    if np.linalg.norm(across) <= near / 4:
        return False
    across, middle = unit(across), (one + other).mean(axis=0) / 2
    image = other - 2 * ((other - middle) @ across)[:, None] * across
    return bool(np.linalg.norm(image - one, axis=-1).max() < near)


def _named(skeleton: Skeleton, at: Array, height: float, leg: _Limbs, arm: _Limbs) -> dict[str, str]:
    legs, arms = ([_segments(at, chain) for chain in (pair.first, pair.second)] for pair in (leg, arm))
    if any(segments is None for segments in (*legs, *arms)):
        return {}
    found: dict[int, str] = {leg.trunk: "hips"}
    ahead = _ahead(at, [segments for segments in legs if segments is not None], height)
    for segments, parts in (
        *((segments, ("thigh", "shin", "foot", "toe")) for segments in legs),
        *((segments, ("upper_arm", "forearm", "hand")) for segments in arms),
    ):
        assert segments is not None
        left = np.cross(Y, ahead) @ (at[segments[0]] - at[leg.trunk]) > 0
        found |= {joint: f"{'left' if left else 'right'} {part}" for joint, part in zip(segments, parts, strict=False)}
    way = [arm.trunk, *skeleton.ancestors(arm.trunk)]
    found |= dict.fromkeys(way[: way.index(leg.trunk)], "spine")
    found |= _neck_and_head(skeleton, at, arm, found)
    return {skeleton.names[joint]: role for joint, role in sorted(found.items())}


def _segments(at: Array, chain: tuple[int, ...]) -> tuple[int, ...] | None:
    """Joints where the first two long bones begin and where the second ends, then the joint after it."""
    length = _length(at, chain)
    bones = np.linalg.norm(np.diff(at[list(chain)], axis=0), axis=-1)
    long = [i for i, bone in enumerate(bones) if bone > LONG * length]
    if len(long) < 2 or long[1] != long[0] + 1:
        return None
    begin = long[0]
    return chain[begin : begin + 4]


def _ahead(at: Array, legs: list[tuple[int, ...]], height: float) -> Array:
    """Where the body faces: along its feet, else along +Z, as files have it."""
    feet = [at[leg[3]] - at[leg[2]] for leg in legs if len(leg) > 3]
    along = np.sum(feet, axis=0) * [1, 0, 1] if feet else np.zeros(3)
    return unit(along) if np.linalg.norm(along) > POINTS * height else np.array([0.0, 0, 1])


def _neck_and_head(skeleton: Skeleton, at: Array, arm: _Limbs, found: dict[int, str]) -> dict[int, str]:
    """What goes up from where the arms are: the last joint that carries another, or the only one, is the head."""
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
