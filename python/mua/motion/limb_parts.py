"""Where the parts of a limb begin, by the lengths along its chain of joints: in any pose, whatever they are called.

Collar bones, twist joints and fingers make chains of any number of joints. People's proportions distinguish them.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from mua.arrays import Array
from mua.motion.trunk import degrees


@dataclass(frozen=True)
class Proportions:
    """Lengths along a limb where its upper part has the length 1."""

    before: float  # from the trunk to the upper part: a collar bone, or the side of the pelvis
    lower: float
    after: float  # from wrist or ankle to the tip


ARM = Proportions(before=0.3, lower=0.9, after=0.5)
LEG = Proportions(before=0.1, lower=1.0, after=0.4)
SPREAD = Proportions(before=0.5, lower=0.35, after=0.5)  # one standard deviation; of the lower part's logarithm
PASSED = 0.6  # how much less likely, in squared standard deviations, each joint makes a part that is no end of it
BENDS = 2.0  # degrees by which the angle at a joint changes where it is no twist joint: shoulder, elbow, knee
PASSED_BENDING = 6.0  # as PASSED, of a joint that bends
UNLIKELY = 9.0  # squared standard deviations in all
LOW = 0.35  # of a leg: how high an ankle may be above the ground
STANDING = 0.7  # of a leg's length: how high hips are at least above the ground while it stands


def parts_of(
    at: Array,  # [..., J, 3] joints in any pose, or in several
    chain: tuple[int, ...],  # joints from where the limb leaves the trunk to its tip
    usual: Proportions,
    *,
    end: int | None = None,  # joint of `chain` that is the hand or foot, where that is known
) -> tuple[int, ...] | None:
    """The joints of `chain` where upper and lower part and hand or foot begin, then the one after; None if unlikely."""
    poses = at.reshape(-1, *at.shape[-2:])[:, list(chain)]
    bones = np.diff(poses, axis=1)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(bones, axis=-1).mean(axis=0))])
    passing = [PASSED, *np.where(np.ptp(degrees(bones[:, :-1], bones[:, 1:]), axis=0) > BENDS, PASSED_BENDING, PASSED)]
    choices = [ends for ends in combinations(range(len(chain)), 3) if end is None or chain[ends[2]] == end]
    scored = [
        (
            _unlikeliness(along, ends, usual, ends_known=end is not None)
            + sum(passing[joint] for joint in range(ends[0] + 1, ends[2]) if joint != ends[1]),
            ends,
        )
        for ends in choices
    ]
    least, (upper, lower, last) = min(scored, default=(np.inf, (0, 0, 0)))
    return (chain[upper], chain[lower], *chain[last : last + 2]) if least < UNLIKELY else None


def _unlikeliness(along: Array, ends: tuple[int, int, int], usual: Proportions, *, ends_known: bool) -> float:
    """Squared standard deviations by which a split of a chain differs from usual proportions."""
    upper, lower, last = along[list(ends)]
    length = lower - upper
    if length <= 0 or last <= lower:
        return float(np.inf)
    before = (upper / length - usual.before) / SPREAD.before
    ratio = np.log((last - lower) / length / usual.lower) / SPREAD.lower
    after = 0.0 if ends_known else ((along[-1] - last) / length - usual.after) / SPREAD.after
    return float(before**2 + ratio**2 + after**2)


def ankle(at: Array, chain: tuple[int, ...]) -> int | None:
    """The first joint of a leg that is near the ground; None where the leg does not stand."""
    ground, top = at[list(chain), 1].min(), at[chain[0], 1]
    if top - ground < STANDING * chain_length(at, chain):
        return None
    return next((joint for joint in chain[2:] if at[joint, 1] - ground < LOW * (top - ground)), None)


def fork(
    parents: Array,  # [J]
    at: Array,  # [J, 3]
    chain: tuple[int, ...],
) -> int | None:
    """The first joint of a chain from which fingers go out: a hand; None where there is none."""
    reaching = {parent for joint, parent in enumerate(parents.tolist()) if (at[joint] != at[parent]).any()}
    for joint in chain[2:]:
        children = np.flatnonzero(parents == joint).tolist()
        if sum(child in reaching for child in children) > 1:
            return joint
    return None


def longest_tail(parents: Array, at: Array, joint: int) -> tuple[int, ...]:
    """The chain of joints from `joint` on that is longest along its bones."""
    tails = [longest_tail(parents, at, child) for child in np.flatnonzero(parents == joint).tolist()]
    return (joint, *max(tails, key=lambda tail: chain_length(at, (joint, *tail)), default=()))


def chain_length(at: Array, chain: tuple[int, ...]) -> float:
    return float(np.linalg.norm(np.diff(at[list(chain)], axis=0), axis=-1).sum())
