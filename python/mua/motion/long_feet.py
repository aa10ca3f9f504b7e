"""Stand figures on the floor whose feet are long for their legs.

The way of the hips is scaled to the legs, so ankles are as high as the source's, in legs. Long toes then dip below the
floor whenever a heel rises, and where a figure's lowest points make its floor, it hovers wherever it stands. Here its
ankles are put where the source's are, and its feet are turned up until no toe is lower than the source's, in legs.
"""

from dataclasses import replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.contacts import STANDING, UNDER, floor_of, planted
from mua.motion.floor import attached, hips_of, led
from mua.motion.match import Matches
from mua.motion.pair import Pair
from mua.motion.rest_alignment import Rest, Y, rest_of
from mua.motion.source_motion import SourceMotion
from mua.motion.trunk import on_all_fours, unit
from mua.pose.clip import Clip
from mua.pose.joint_names import SIDES
from mua.pose.skeleton import Skeleton

HOVERS = 0.1  # legs from the lowest standing point of the feet to the floor, a median; toes that turn up slide more
Ends = tuple[int, int]  # joint of the target, joint of the source


def put_down(source: SourceMotion, target: Skeleton, clip: Clip, matches: Matches) -> tuple[Clip, tuple[str, ...]]:
    """The clip on the floor, its feet turned up where their toes would be below it, and a note where it hovered."""
    feet = [
        (ankle, toe)
        for side in SIDES
        if (ankle := matches.ends(f"{side} foot")) is not None
        if (toe := matches.ends(f"{side} toe")) is not None and ankle[0] in target.ancestors(toe[0])
    ]
    rest = rest_of(source.skeleton, target, matches)
    pair = Pair.of(source, target, clip, matches)
    if not feet or not hips_of(rest) or on_all_fours(pair.target.rest()):  # an animal stands on its forelegs too
        return clip, ()
    ankles, toes = (list(points) for points in zip(*feet, strict=True))
    lift = _lift(pair, ankles, toes)
    if lift is None:
        return clip, ()
    frames = len(pair.target.at)
    _, at = target.world(clip.rotations, clip.translations)
    clip = replace(clip, translations=led(rest, clip.rotations, at[:, hips_of(rest)].mean(axis=1) + lift * Y))
    wanted = _stand(pair, toes) + _source_heights(pair, toes)
    rotations = clip.rotations.copy()
    turned, at = target.world(clip.rotations[:frames], clip.translations[:frames])
    for foot, height in zip(feet, wanted.T, strict=True):
        _turn_up(rest, rotations, turned, at, foot, height)
    note = f"{clip.name}: feet long for the legs are turned up to stay on the floor (--feet keep turns this off)."
    return replace(clip, rotations=rotations, translations=attached(rest, rotations, clip.translations.copy())), (note,)


def _lift(pair: Pair, ankles: list[Ends], toes: list[Ends]) -> float | None:
    """Metres that put standing ankles where the source's are; None where the figure does not hover."""
    points = [*ankles, *toes]
    above = pair.target.at[:, [joint for joint, _ in points], 1] - _stand(pair, points) - _source_heights(pair, points)
    stands = planted(pair.source.at[:, [joint for _, joint in points]], pair.rate, pair.source.leg)
    standing = stands.any(axis=1)
    heels = stands[:, : len(ankles)]
    if not heels.any():
        return None
    lowest = np.where(stands, above, np.inf).min(axis=1)[standing]
    return -float(np.median(above[:, : len(ankles)][heels])) if np.median(lowest) > HOVERS * pair.target.leg else None


def _stand(pair: Pair, points: list[Ends]) -> Array:
    """How high points of the target's feet are where it stands, [P] metres."""
    rest = pair.target.rest_at
    return np.asarray(rest[[joint for joint, _ in points], 1] - floor_of(rest, under=UNDER))


def _source_heights(pair: Pair, points: list[Ends]) -> Array:
    """How high points of the source's feet are above where they stand, [F, P] metres of the target's size."""
    height = pair.source.at[:, [joint for _, joint in points], 1]
    return np.asarray((height - np.quantile(height, STANDING, axis=0)) * pair.target.leg / pair.source.leg)


def _turn_up(rest: Rest, rotations: Array, turned: Array, at: Array, foot: tuple[Ends, Ends], height: Array) -> None:
    """Turn a foot in `rotations` [F, J, 4] until its toe is at `height` [F] metres or above."""
    (ankle, _), (toe, _) = foot
    bone = at[:, toe] - at[:, ankle]
    length = np.linalg.norm(bone, axis=-1)
    now, wanted = (np.arcsin(np.clip(rise / length, -1, 1)) for rise in (bone[:, 1], height - at[:, ankle, 1]))
    turn = rotation.from_axis_angle(unit(np.cross(bone, Y)), np.maximum(wanted - now, 0))
    own = rotation.multiply(turn, turned[:, ankle])
    parent = int(rest.target.parents[ankle])
    if parent >= 0:
        own = rotation.multiply(rotation.conjugate(turned[:, parent]), own)
    rotations[: len(at), ankle] = rotation.normalize(own)
