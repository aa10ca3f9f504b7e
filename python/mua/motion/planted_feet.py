"""Hold planted feet still: where the source's feet stand, the target's legs are bent so that its feet stand too.

Legs of other proportions carry feet along other paths than the source's, so that feet which stand there slide here.
While a foot of the source stands, the target's toe or ankle is held at one place; between two such places the
correction passes smoothly from one to the other. Thigh and shin follow by the law of cosines in the plane in which
the knee bends anyway; the foot keeps its direction in the world.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.contacts import planted, spans, speed
from mua.motion.floor import attached
from mua.motion.match import Matches
from mua.motion.pair import Pair
from mua.motion.rest_alignment import Rest, rest_of
from mua.motion.source_motion import SourceMotion
from mua.motion.trunk import degrees, unit
from mua.pose.clip import Clip
from mua.pose.joint_names import SIDES
from mua.pose.skeleton import Skeleton

Feet = Literal["auto", "keep", "plant"]

FIRM = 0.15  # legs per second: a source whose standing feet are faster on average slides itself
WORTH = 0.04  # legs per second by which standing feet must slide more than the source's to be held
STRETCHED = 0.999  # of the leg's length: how far a held foot may stretch the leg
ALONG_FLOOR = np.array([1.0, 0, 1])  # a nearly straight leg cannot also change its height without bending visibly
FARTHEST = 0.15  # of the leg: what would have to move farther to stand does not stand
FASTEST = 0.8  # legs per second at which a foot may be brought from one place to the next
VISIBLY = 4.0  # degrees by which limbs may turn, as a median, before sliding feet are the lesser evil
FADE = 0.4  # seconds in which the correction begins before the first standing and ends after the last


@dataclass(frozen=True)
class _Leg:
    """Target joints of a leg, and the point of its foot that is held, on target and source."""

    thigh: int
    shin: int
    foot: int
    held: tuple[tuple[int, int], ...]  # toe before ankle


def plant_feet(
    source: SourceMotion, target: Skeleton, clip: Clip, matches: Matches, *, feet: Feet = "auto"
) -> tuple[Clip, tuple[str, ...]]:
    """The clip with feet held where the source's stand, and a note where it was done.

    feet: "plant" wherever the source's feet stand, "keep" nowhere, "auto" where the source's stand firmly, the
    target's slide, and holding them turns no limb visibly.
    """
    if feet == "keep" or len(clip) < 2:
        return clip, ()
    pair = Pair.of(source, target, clip, matches)
    rest = rest_of(source.skeleton, target, matches)
    legs = [(leg, stands) for leg in _legs(target, matches) if (stands := _stands(pair, leg)).any()]
    if not legs or (feet == "auto" and not any(_worth_it(pair, leg, stands) for leg, stands in legs)):
        return clip, ()
    kept = clip
    for leg, stands in legs:
        clip = _held(rest, clip, leg, stands, pair.target.leg)
    if feet == "auto" and max(_turned(rest, kept, clip, leg) for leg, _ in legs) > VISIBLY:
        return kept, ()
    return clip, (f"{clip.name}: standing feet are held in place (--feet keep turns this off).",)


def _legs(target: Skeleton, matches: Matches) -> list[_Leg]:
    found = []
    for side in SIDES:
        thigh, shin = (matches.joint(f"{side} {part}") for part in ("thigh", "shin"))
        foot, toe = (matches.ends(f"{side} {part}") for part in ("foot", "toe"))
        if thigh is None or shin is None or foot is None or thigh not in target.ancestors(shin):
            continue
        found.append(_Leg(thigh, shin, foot[0], (foot,) if toe is None else (toe, foot)))
    return found


def _stands(pair: Pair, leg: _Leg) -> Array:
    """Whether each held point of the source's foot stands, [F, P] bool."""
    points = [planted(pair.source.at[:, [joint]], pair.rate, pair.source.leg)[:, 0] for _, joint in leg.held]
    return np.stack(points, axis=1)


def _worth_it(pair: Pair, leg: _Leg, stands: Array) -> bool:
    target = speed(pair.target.at[:, [joint for joint, _ in leg.held]], pair.rate)[stands].mean() / pair.target.leg
    source = speed(pair.source.at[:, [joint for _, joint in leg.held]], pair.rate)[stands].mean() / pair.source.leg
    return bool(source < FIRM and target > source + WORTH)


def _turned(rest: Rest, kept: Clip, held: Clip, leg: _Leg) -> float:
    """Degrees by which thigh and shin point elsewhere in the held clip: the median over frames, of the worse one."""
    at, moved = (rest.target.world(clip.rotations, clip.translations)[1] for clip in (kept, held))
    bones = ((leg.thigh, leg.shin), (leg.shin, leg.foot))
    return max(float(np.median(degrees(at[:, b] - at[:, a], moved[:, b] - moved[:, a]))) for a, b in bones)


def _held(rest: Rest, clip: Clip, leg: _Leg, stands: Array, length: float) -> Clip:
    """The clip with one foot held during `stands` [F, points of the foot]."""
    frames = len(stands)
    turned, at = rest.target.world(clip.rotations[:frames], clip.translations[:frames])
    points = at[:, [joint for joint, _ in leg.held]]
    moved = _corrections(points, stands, clip.rate, length)
    rotations = clip.rotations.copy()
    rotations[:frames] = _bent(rest.target, leg, clip.rotations[:frames], turned, at, at[:, leg.foot] + moved)
    return replace(clip, rotations=rotations, translations=attached(rest, rotations, clip.translations.copy()))


def _corrections(points: Array, stands: Array, rate: float, length: float) -> Array:
    """How far a foot moves [F, 3] along the floor so that what stands of its points [F, P, 3] does not move."""
    moved = np.zeros((len(points), 3))
    held: list[tuple[int, int]] = []
    for begin, end in spans(np.any(stands, axis=1)):
        # the toe holds the foot before the ankle; a foot that rolls from one onto the other goes on from where it is
        point = np.where(stands[begin:end, 0], 0, stands.shape[1] - 1)
        steps = np.diff(points[begin:end], axis=0)[np.arange(end - begin - 1), point[1:]]
        back = -np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)]) * ALONG_FLOOR
        back -= (back.max(axis=0) + back.min(axis=0)) / 2
        if np.linalg.norm(back, axis=-1).max() > FARTHEST * length:
            continue
        if held:
            jump = np.linalg.norm(back[0] - moved[held[-1][1] - 1])
            if jump > FASTEST * length / rate * (begin - held[-1][1] + 1):
                continue
        moved[begin:end] = back
        held.append((begin, end))
    return _passed(moved, held, round(FADE * rate)) if held else moved


def _passed(moved: Array, held: list[tuple[int, int]], fade: int) -> Array:
    """Corrections [F, 3] of all frames: those `held`, smooth between them, fading in before and out after them."""
    first, last = held[0][0], held[-1][1] - 1
    keys = [
        (first - fade, np.zeros(3)),
        *((frame, moved[frame]) for begin, end in held for frame in (begin, end - 1)),
        (last + fade, np.zeros(3)),
    ]
    result = moved.copy()
    for (begin, before), (end, after) in zip(keys[::2], keys[1::2], strict=True):
        for frame in range(max(begin + 1, 0), min(end, len(moved))):
            t = (frame - begin) / (end - begin)
            t = t * t * (3 - 2 * t)
            result[frame] = (1 - t) * before + t * after
    return result


def _bent(skeleton: Skeleton, leg: _Leg, local: Array, turned: Array, at: Array, ankle: Array) -> Array:
    """Local rotations [F, J, 4] of a leg that reaches its ankle [F, 3], from those given and their world poses."""
    hip, knee, foot = at[:, leg.thigh], at[:, leg.shin], at[:, leg.foot]
    upper, lower = (np.linalg.norm(v, axis=-1) for v in (knee - hip, foot - knee))
    reach = np.linalg.norm(ankle - hip, axis=-1)
    reach = np.clip(reach, abs(upper - lower) + 1e-6, np.maximum(STRETCHED * (upper + lower), _reach(hip, foot)))
    wanted = np.pi - _angle(upper, lower, reach)
    axis = np.cross(knee - hip, foot - knee)
    now = np.arctan2(np.linalg.norm(axis, axis=-1), np.sum((knee - hip) * (foot - knee), axis=-1))
    fold = rotation.from_axis_angle(unit(axis), wanted - now)
    folded = knee + rotation.rotate(fold, foot - knee)
    swing = rotation.between(unit(folded - hip), unit(ankle - hip))
    since = {leg.thigh: swing, leg.shin: rotation.multiply(swing, fold), leg.foot: None}
    result = local.copy()
    for joint, turn in since.items():
        above = next((j for j in skeleton.ancestors(joint) if j in since), None)
        carried = since[above] if above is not None else None
        parent = int(skeleton.parents[joint])
        before = turned[:, parent] if parent >= 0 else np.broadcast_to(np.array([1.0, 0, 0, 0]), turned[:, joint].shape)
        parent_turned = before if carried is None else rotation.multiply(carried, before)
        own = turned[:, joint] if turn is None else rotation.multiply(turn, turned[:, joint])
        result[:, joint] = rotation.normalize(rotation.multiply(rotation.conjugate(parent_turned), own))
    return result


def _reach(hip: Array, foot: Array) -> Array:
    return np.asarray(np.linalg.norm(foot - hip, axis=-1))


def _angle(a: Array, b: Array, c: Array) -> Array:
    """The angle between sides a and b of a triangle whose third side is c (law of cosines)."""
    return np.arccos(np.clip((a**2 + b**2 - c**2) / (2 * a * b), -1, 1))
