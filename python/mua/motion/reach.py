"""Where hands and feet are on the character and where the motion has them, whichever joints were paired.

Limbs of the pairs that were chosen cannot show that a pair is wrong. Here each skeleton shows by itself where its limbs
begin, bend and end: by the names of their parts; where these are unknown, by where fingers fork, where chains end, and
the lengths of bones.
"""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.limb_parts import ARM, LEG, Proportions, ankle, chain_length, fork, parts_of
from mua.motion.trunk import unit
from mua.motion.whole_limbs import limb_chain, with_whole_limbs
from mua.pose.joint_names import SIDES, Roles
from mua.pose.joint_names import roles as find_roles
from mua.pose.skeleton import Skeleton

_LIMBS: dict[str, tuple[tuple[str, ...], tuple[str, str, str], Proportions]] = {
    "hand": (("shoulder", "upper_arm", "forearm", "hand"), ("upper_arm", "forearm", "hand"), ARM),
    "foot": (("thigh", "shin", "foot", "toe"), ("thigh", "shin", "foot"), LEG),
}
WRONG = 0.3  # of a limb's length by which a hand or foot may be elsewhere: 17 degrees of a straight limb


@dataclass(frozen=True)
class Reach:
    """How far a hand or foot is from where the motion has it, seen from where its limb begins."""

    limb: str  # "left hand"
    metres: float  # median over the frames
    share: float  # of the limb's length
    character: tuple[str, str]  # joints between which it is measured
    motion: tuple[str, str]


@dataclass(frozen=True, eq=False)
class Figure:
    """A skeleton with what its joints are, over frames."""

    skeleton: Skeleton
    roles: Roles
    at: Array  # [F, J, 3] metres


def reaches(character: Figure, motion: Figure) -> tuple[Reach, ...]:
    """Every hand and foot that both have, after the one turn about Y that brings the motion nearest."""
    ours, theirs = _limbs(character), _limbs(motion)
    shared = [limb for limb in ours if limb in theirs]
    if not shared:
        return ()
    ways = {limb: np.sum(_bones(character, ours[limb]), axis=0) for limb in shared}
    wanted = {limb: _wanted(_bones(character, ours[limb]), _bones(motion, theirs[limb])) for limb in shared}
    headings = [best_heading(ways[limb], wanted[limb]) for limb in shared]  # of each limb: a wrong one turns none else
    heading = min(headings, key=lambda turn: sum(np.median(_away(ways[limb], wanted[limb], turn)) for limb in shared))
    found = []
    for limb in shared:
        metres = _away(ways[limb], wanted[limb], heading)
        length = np.sum([np.linalg.norm(bone, axis=-1) for bone in _bones(character, ours[limb])], axis=0)
        ends = _ends(character, ours[limb]), _ends(motion, theirs[limb])
        found.append(Reach(limb, float(np.median(metres)), float(np.median(metres / length)), *ends))
    return tuple(found)


def _wanted(character: tuple[Array, Array], motion: tuple[Array, Array]) -> Array:
    """[F, 3] from where a limb begins to where it would end if its bones pointed as those of the motion."""
    lengths = [np.linalg.norm(bone, axis=-1, keepdims=True) for bone in character]
    return np.asarray(sum(length * unit(bone) for length, bone in zip(lengths, motion, strict=True)))


def _away(way: Array, wanted: Array, heading: Array) -> Array:
    """[F] metres."""
    return np.asarray(np.linalg.norm(way - rotation.rotate(heading, wanted), axis=-1))


def _ends(figure: Figure, joints: tuple[int, int, int]) -> tuple[str, str]:
    return figure.skeleton.names[joints[0]], figure.skeleton.names[joints[2]]


def best_heading(target: Array, source: Array) -> Array:
    """The turn about Y [4] that lays vectors of the source [N, 3] nearest to those of the target [N, 3]."""
    sine = np.sum(source[:, 2] * target[:, 0] - source[:, 0] * target[:, 2])
    cosine = np.sum(source[:, 0] * target[:, 0] + source[:, 2] * target[:, 2])
    return rotation.from_axis_angle(np.array([0.0, 1, 0]), np.arctan2(sine, cosine))


def _bones(figure: Figure, joints: tuple[int, int, int]) -> tuple[Array, Array]:
    """[F, 3] each: from where a limb begins to where it bends, and on to its hand or foot."""
    begin, bend, end = (figure.at[:, joint] for joint in joints)
    return bend - begin, end - bend


def _limbs(figure: Figure) -> dict[str, tuple[int, int, int]]:
    """The joints where each limb begins, bends and ends."""
    skeleton = figure.skeleton
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    named = {role: joints[0] for role, joints in with_whole_limbs(skeleton, find_roles(skeleton), figure.at)[0].items()}
    found = {}
    for limb, (parts, ends, usual) in _LIMBS.items():
        chains = [limb_chain(skeleton, at, figure.roles, side, parts) for side in SIDES]
        length = min(len(chain) if chain else 0 for chain in chains)  # what one hand holds makes its chain longer
        for side, chain in zip(SIDES, chains, strict=True):
            known = [named.get(f"{side} {part}") for part in ends]
            joints = _joints(skeleton, at, figure.at, chain[:length], usual, known) if chain and length > 2 else None
            if joints is not None:
                found[f"{side} {limb}"] = joints
    return found


def _joints(
    skeleton: Skeleton, at: Array, bends: Array, chain: tuple[int, ...], usual: Proportions, named: list[int | None]
) -> tuple[int, int, int] | None:
    """The three joints of a limb, some of them by their names."""
    begin, bend, end = (joint if joint in chain else None for joint in named)
    if end is None:
        end = fork(skeleton.parents, at, chain) if usual is ARM else ankle(at, chain)
    split = parts_of(bends, chain, usual, end=end) or (None, None, None)
    begin, bend = begin or split[0], bend or split[1]
    end = end or (chain[-1] if usual is ARM else split[2])
    if begin is None or bend is None or end is None:
        return None
    order = [chain.index(joint) for joint in (begin, bend, end)]
    return (begin, bend, end) if order == sorted(set(order)) and chain_length(at, (begin, bend, end)) > 0 else None
