"""How well a clip on a character does what its source does: limbs, facing, floor and feet, measured on joints."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.contacts import UNDER, floor_of, planted, speed, standing
from mua.motion.head_and_hands import hand_angles, hand_flaws, head_flaws, head_pitch
from mua.motion.match import Matches
from mua.motion.pair import Pair, Side
from mua.motion.reach import WRONG, Figure, Reach, best_heading, reaches
from mua.motion.rest_alignment import IDENTITY
from mua.motion.source_motion import SourceMotion
from mua.motion.trunk import SIDES, degrees, trunk_of, unit
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

SEGMENTS = {  # limbs compared: where they begin and end
    f"{side} {limb}": (f"{side} {limb}", f"{side} {end}")
    for side in SIDES
    for limb, end in (("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot"))
}
Y = np.array([0.0, 1, 0])
LIMB_BOUND = 10.0  # degrees of a limb's median from which a sentence says so
FACING_BOUND = 10.0  # degrees between facing and travel, more than the source has, from which a sentence says so
UPRIGHT = 60.0  # degrees from upright up to which a trunk faces anywhere
FORWARD = 45.0  # degrees between the source's facing and travel up to which it counts as going forward
MOVING = 0.5  # legs per second of the hips along the floor from which somebody travels
TRAVEL_WINDOW = 0.5  # seconds over which the direction of travel is taken: hips sway from step to step
TRAVELS = 0.5  # seconds of travel that a clip must have to be judged
SUNK = 0.06  # leg lengths below the floor from which a sentence says so
LIFTED = 0.25  # leg lengths above the floor from which a sentence says so
SLIDES = 0.1  # legs per second by which standing feet may slide more than in the source


@dataclass(frozen=True)
class MotionQuality:
    """What a clip on a character keeps of its source."""

    name: str
    limb_degrees: float  # angle between a limb on source and target: the median over frames, of the worst limb
    facing_degrees: float | None  # angle between facing and travel on the target; None where it never goes forward
    feet_height: float | None  # metres of the lower foot above where it stands in the bind pose, None without feet
    slide: float | None  # metres per second of the target's feet while the source's stand, None where none stands
    limbs: Mapping[str, float]  # median degrees by limb
    head_degrees: float | None  # how far up the head looks while the body is upright, median; None where unknown
    hands: Mapping[str, float]  # median degrees by hand between where palm and fingers point on source and target
    reach: tuple[Reach, ...]  # how far hands and feet are from where the motion has them
    flaws: tuple[str, ...]  # a sentence for everything that looks wrong

    @property
    def worst_reach(self) -> float | None:
        """The largest distance of a hand or foot, as a share of its limb; None where no limb is known on both sides."""
        return max((limb.share for limb in self.reach), default=None)

    @property
    def worst_hand(self) -> float | None:
        """Degrees of the hand that is turned farther; None where the fingers of both sides do not show it."""
        return max(self.hands.values(), default=None)


def measure_motion(source: SourceMotion, target: Skeleton, clip: Clip, matches: Matches) -> MotionQuality:
    """Compare `clip` on `target` with the `source` that it was made from."""
    pair = Pair.of(source, target, clip, matches)
    heading = _heading(pair)
    limbs, hands = _limb_angles(pair, heading), hand_angles(pair, heading)
    pitch, source_pitch = head_pitch(pair)
    facing = _facing(pair)
    height = _feet_height(pair.target)
    slide, source_slide = _slide(pair)
    reach = reaches(
        Figure(target, matches.roles, pair.target.at), Figure(source.skeleton, matches.source_roles, pair.source.at)
    )
    return MotionQuality(
        name=clip.name,
        limb_degrees=max(limbs.values(), default=0.0),
        facing_degrees=None if facing is None else facing.body,
        feet_height=height,
        slide=slide,
        limbs=limbs,
        head_degrees=pitch,
        hands=hands,
        reach=reach,
        flaws=(
            *_limb_flaws(clip.name, limbs),
            *_reach_flaws(clip.name, reach),
            *head_flaws(clip.name, pitch, source_pitch),
            *hand_flaws(clip.name, hands),
            *_facing_flaws(clip.name, facing),
            *_floor_flaws(clip.name, height, pair.target.leg),
            *_slide_flaws(clip.name, slide, source_slide, pair.target.leg),
        ),
    )


def _heading(pair: Pair) -> Array:
    """The one turn about Y [4] that brings the limbs of the source nearest to those of the target."""
    target, source = _directions(pair.target), _directions(pair.source)
    shared = [limb for limb in target if limb in source]
    if not shared:
        return IDENTITY
    return best_heading(*(np.concatenate([side[limb] for limb in shared]) for side in (target, source)))


def _limb_angles(pair: Pair, heading: Array) -> dict[str, float]:
    """Median angle in degrees by limb, with the source turned by `heading` [4]."""
    target, source = _directions(pair.target), _directions(pair.source)
    return {
        limb: float(np.median(degrees(target[limb], rotation.rotate(heading, source[limb]))))
        for limb in target
        if limb in source
    }


def _directions(side: Side) -> dict[str, Array]:
    """Directions [F, 3] by limb; the trunk's relative to how it stands in its bind pose."""
    found = {}
    for limb, (begin, end) in SEGMENTS.items():
        first, last = side.place(begin), side.place(end)
        if first is not None and last is not None:
            found[limb] = unit(last - first)
    trunk = side.trunk()
    return found if trunk is None else found | {"spine": trunk.up}


@dataclass(frozen=True)
class _Facing:
    """Degrees between facing and travel while the source goes forward."""

    body: float  # of the target, hips and chest together
    worst: float  # of the target's hips or chest, whichever differs more from the source's
    source: float  # of the source's same part


def _facing(pair: Pair) -> _Facing | None:
    """None where the source never goes forward or has no trunk."""
    target_path, source_path, trunk = pair.target.hips(), pair.source.hips(), pair.source.trunk()
    if target_path is None or source_path is None or trunk is None:
        return None
    ahead = {"hips": np.cross(trunk.hips, Y), "spine": np.cross(trunk.chest, Y)}
    away = _from_travel(ahead["hips"] + ahead["spine"], source_path, pair.rate)
    moving = np.linalg.norm(_travel(target_path, pair.rate), axis=-1) > MOVING * pair.target.leg
    upright = trunk.up[:, 1] > np.cos(np.radians(UPRIGHT))
    forward = (np.abs(away) < np.radians(FORWARD)) & moving & upright
    if np.count_nonzero(forward) < TRAVELS * pair.rate:
        return None
    bind = trunk_of(pair.target.rest())
    faced = Y * 0 if bind is None else np.cross(bind.hips, Y)
    faces = {part: rotation.rotate(turned, faced) for part, turned in pair.turned.items()}
    body = _middle(_from_travel(np.sum(list(faces.values()), axis=0), target_path, pair.rate)[forward])
    parts = [
        (
            abs(_middle(_from_travel(faces[part], target_path, pair.rate)[forward])),
            abs(_middle(_from_travel(ahead[part], source_path, pair.rate)[forward])),
        )
        for part in faces
    ]
    worst, source = max(parts, key=lambda angles: abs(angles[0] - angles[1]))
    return _Facing(*(float(np.degrees(angle)) for angle in (abs(body), worst, source)))


def _from_travel(facing: Array, at: Array, rate: float) -> Array:
    """Signed angle about Y [F] from the direction of travel of `at` [F, 3] to `facing` [F, 3], radians."""
    travel = _travel(at, rate)
    sine = travel[:, 2] * facing[:, 0] - travel[:, 0] * facing[:, 2]
    return np.asarray(np.arctan2(sine, travel[:, 0] * facing[:, 0] + travel[:, 2] * facing[:, 2]))


def _travel(at: Array, rate: float) -> Array:
    """Velocity along the floor [F, 3] of a path [F, 3], over a window that holds about a step."""
    frames = len(at)
    half = max(round(TRAVEL_WINDOW * rate / 2), 1)
    first, last = np.maximum(np.arange(frames) - half, 0), np.minimum(np.arange(frames) + half, frames - 1)
    return (at[last] - at[first]) * [1, 0, 1] * (rate / np.maximum(last - first, 1))[:, None]


def _middle(angles: Array) -> float:
    """The mean direction of angles [N], radians."""
    return float(np.arctan2(np.sin(angles).mean(), np.cos(angles).mean()))


def _feet_height(side: Side) -> float | None:
    """Metres of the lower foot above where it stands in the bind pose, in the lowest frames."""
    soles = side.soles()
    if not soles:
        return None
    return standing(side.at[:, soles, 1] - side.rest_at[soles, 1]) + floor_of(side.rest_at, under=UNDER)


def _slide(pair: Pair) -> tuple[float | None, float | None]:
    """Mean speed of feet while the source's stand: the target's in metres per second, and the source's scaled to it."""
    soles = pair.target.soles(), pair.source.soles()
    if not soles[0] or len(pair.target.at) < 2:
        return None, None
    target, source = (side.at[:, joints] for side, joints in zip((pair.target, pair.source), soles, strict=True))
    held = planted(source, pair.rate, pair.source.leg)
    if not held.any():
        return None, None
    scale = pair.target.leg / pair.source.leg
    return float(speed(target, pair.rate)[held].mean()), float(speed(source, pair.rate)[held].mean() * scale)


def _limb_flaws(name: str, limbs: Mapping[str, float]) -> list[str]:
    wrong = {limb.replace("_", " "): angle for limb, angle in limbs.items() if angle > LIMB_BOUND}
    if not wrong:
        return []
    listed = ", ".join(f"{limb} {angle:.0f}" for limb, angle in sorted(wrong.items(), key=lambda item: -item[1]))
    return [f"{name}: limbs point in other directions than in the motion (degrees: {listed})."]


def _reach_flaws(name: str, reach: tuple[Reach, ...]) -> list[str]:
    wrong = [limb for limb in reach if limb.share > WRONG]
    if not wrong:
        return []
    listed = ", ".join(
        f"the {limb.limb} is {limb.metres:.2f} m from where the motion has it "
        f"({' to '.join(limb.character)}; in the motion {' to '.join(limb.motion)})"
        for limb in sorted(wrong, key=lambda limb: -limb.share)
    )
    return [f"{name}: seen from shoulder or hip, {listed}. A pair of joints may be wrong."]


def _facing_flaws(name: str, facing: _Facing | None) -> list[str]:
    if facing is None or abs(facing.worst - facing.source) <= FACING_BOUND:
        return []
    return [
        f"{name}: the body faces {facing.worst:.0f} degrees away from where it walks; "
        f"in the motion it is {facing.source:.0f}."
    ]


def _floor_flaws(name: str, height: float | None, leg: float) -> list[str]:
    if height is None or -SUNK * leg <= height <= LIFTED * leg:
        return []
    where = "below" if height < 0 else "above"
    return [f"{name}: the feet are {abs(height):.2f} m {where} the floor."]


def _slide_flaws(name: str, slide: float | None, source: float | None, leg: float) -> list[str]:
    if slide is None or source is None or slide - source <= SLIDES * leg:
        return []
    return [f"{name}: standing feet slide at {slide:.2f} m/s; in the motion at {source:.2f}."]
