"""How well a clip on a character does what its source does: limbs, facing, floor and feet, measured on joints."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.clip import Clip
from mua.motion.contacts import STANDING, planted, speed
from mua.motion.match import Matches
from mua.motion.resample import resample
from mua.motion.source import SourceMotion
from mua.rig.skeleton import Skeleton

SIDES = ("left", "right")
SEGMENTS = {  # limbs compared: where they begin and end; several roles mean the middle between them
    f"{side} {limb}": ((f"{side} {limb}",), (f"{side} {end}",))
    for side in SIDES
    for limb, end in (("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot"))
} | {"spine": (("left thigh", "right thigh"), ("left upper_arm", "right upper_arm"))}
LIMB_BOUND = 10.0  # degrees of a limb's median from which a sentence says so
FACING_BOUND = 10.0  # degrees between facing and travel, more than the source has, from which a sentence says so
FORWARD = 45.0  # degrees between the source's facing and travel up to which it counts as going forward
MOVING = 0.5  # legs per second of the hips along the floor from which somebody travels
TRAVEL_WINDOW = 0.5  # seconds over which the direction of travel is taken: hips sway from step to step
TRAVELS = 0.5  # seconds of travel that a clip must have to be judged
SUNK = 0.06  # of the leg below the floor
LIFTED = 0.25  # of the leg above the floor
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
    flaws: tuple[str, ...]  # a sentence for everything that looks wrong


def measure_motion(source: SourceMotion, target: Skeleton, clip: Clip, matches: Matches) -> MotionQuality:
    """Compare `clip` on `target` with the `source` that it was made from."""
    pair = _Pair.of(source, target, clip, matches)
    limbs = _limb_angles(pair)
    facing, source_facing = _facing(pair)
    height = _feet_height(pair)
    slide, source_slide = _slide(pair)
    return MotionQuality(
        name=clip.name,
        limb_degrees=max(limbs.values(), default=0.0),
        facing_degrees=facing,
        feet_height=height,
        slide=slide,
        limbs=limbs,
        flaws=(
            *_limb_flaws(clip.name, limbs),
            *_facing_flaws(clip.name, facing, source_facing),
            *_floor_flaws(clip.name, height, pair.leg),
            *_slide_flaws(clip.name, slide, source_slide, pair.leg),
        ),
    )


@dataclass(frozen=True)
class _Pair:
    """Both skeletons in the world, frame by frame."""

    target: Skeleton
    matches: Matches
    rate: float
    turned: Array  # [F, T, 4] target
    at: Array  # [F, T, 3] target, metres
    source_at: Array  # [F, S, 3] metres
    bind_turned: Array  # [T, 4] target
    bind_at: Array  # [T, 3] target, metres

    @classmethod
    def of(cls, source: SourceMotion, target: Skeleton, clip: Clip, matches: Matches) -> "_Pair":
        original = resample(source.clip, clip.rate)
        frames = min(len(clip), len(original))
        turned, at = target.world(clip.rotations[:frames], clip.translations[:frames])
        _, source_at = source.skeleton.world(original.rotations[:frames], original.translations[:frames])
        bind = target.world(target.bind_rotations, target.bind_translations)
        return cls(target, matches, clip.rate, turned, at, source_at, *bind)

    def places(self, roles: tuple[str, ...]) -> tuple[Array, Array] | None:
        """Where roles begin (the middle between several) on target and source, [F, 3] each."""
        ends = [found for role in roles if (found := self.matches.ends(role)) is not None]
        if len(ends) < len(roles):
            return None
        target, source = zip(*ends, strict=True)
        return self.at[:, list(target)].mean(axis=1), self.source_at[:, list(source)].mean(axis=1)

    @property
    def leg(self) -> float:
        """The target's leg in metres; half its height where it has no legs."""
        chain = [self.matches.joint(f"left {part}") for part in ("thigh", "shin", "foot")]
        known = [self.bind_at[joint] for joint in chain if joint is not None]
        if len(known) == len(chain):
            return float(np.linalg.norm(np.diff(known, axis=0), axis=-1).sum())
        return float(np.ptp(self.bind_at[:, 1])) / 2

    def soles(self) -> list[tuple[int, int]]:
        """The joint nearest to the floor of each foot, on target and source."""
        found = [self.matches.ends(f"{side} toe") or self.matches.ends(f"{side} foot") for side in SIDES]
        return [pair for pair in found if pair is not None]


def _limb_angles(pair: _Pair) -> dict[str, float]:
    """Median angle in degrees by limb, after the one turn about Y that brings the source nearest to the target."""
    directions = {}
    for limb, (begin, end) in SEGMENTS.items():
        begins, ends = pair.places(begin), pair.places(end)
        if begins is not None and ends is not None:
            directions[limb] = _unit(ends[0] - begins[0]), _unit(ends[1] - begins[1])
    if not directions:
        return {}
    heading = _best_heading(
        np.concatenate([target for target, _ in directions.values()]),
        np.concatenate([source for _, source in directions.values()]),
    )
    return {
        limb: float(np.median(_degrees(target, rotation.rotate(heading, source))))
        for limb, (target, source) in directions.items()
    }


def _best_heading(target: Array, source: Array) -> Array:
    """The turn about Y [4] that lays directions of the source [N, 3] nearest to those of the target [N, 3]."""
    sine = np.sum(source[:, 2] * target[:, 0] - source[:, 0] * target[:, 2])
    cosine = np.sum(source[:, 0] * target[:, 0] + source[:, 2] * target[:, 2])
    return rotation.from_axis_angle(np.array([0.0, 1, 0]), np.arctan2(sine, cosine))


def _facing(pair: _Pair) -> tuple[float | None, float | None]:
    """Degrees between facing and travel while the source goes forward, on target (its worse end) and source."""
    hips = pair.places(("left thigh", "right thigh")) or pair.places(("hips",))
    if hips is None:
        return None, None
    source_away = _from_travel(_source_facing(pair), hips[1], pair.rate)
    target_travel = _travel(hips[0], pair.rate)
    forward = (np.abs(source_away) < np.radians(FORWARD)) & (np.linalg.norm(target_travel, axis=-1) > MOVING * pair.leg)
    if np.count_nonzero(forward) < TRAVELS * pair.rate:
        return None, None
    worst = max(abs(_middle(_from_travel(facing, hips[0], pair.rate)[forward])) for facing in _target_facings(pair))
    return float(np.degrees(worst)), float(np.degrees(abs(_middle(source_away[forward]))))


def _source_facing(pair: _Pair) -> Array:
    """Where the source faces along the floor [F, 3], by the lines through its hips and shoulders."""
    across = np.zeros((len(pair.source_at), 3))
    for part in ("thigh", "upper_arm"):
        left, right = (pair.places((f"{side} {part}",)) for side in SIDES)
        if left is not None and right is not None:
            across += _unit(left[1] - right[1])
    return np.cross(across, [0.0, 1, 0])


def _target_facings(pair: _Pair) -> list[Array]:
    """Where hips and chest of the target face [F, 3], by what they do to the mesh bound to them."""
    left, right = (pair.matches.joint(f"{side} thigh") for side in SIDES)
    ahead = np.array([0.0, 0, 1])
    if left is not None and right is not None:
        ahead = np.cross(pair.bind_at[left] - pair.bind_at[right], [0.0, 1, 0])
    ends = [pair.matches.roles.get(role, ())[-1:] for role in ("hips", "spine")]
    joints = [joint for end in ends for joint in end if joint in pair.matches.chains]
    since = rotation.multiply(pair.turned[:, joints], rotation.conjugate(pair.bind_turned[joints]))
    return [rotation.rotate(since[:, i], ahead) for i in range(len(joints))]


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


def _feet_height(pair: _Pair) -> float | None:
    soles = [target for target, _ in pair.soles()]
    if not soles:
        return None
    above = pair.at[:, soles, 1] - (pair.bind_at[soles, 1] - _floor(pair.bind_at))
    return float(np.quantile(above.min(axis=1), STANDING))


def _floor(at: Array) -> float:
    """Height of the floor that a pose [J, 3] stands on: 0 where its lowest joint is near to it."""
    lowest = float(at[:, 1].min())
    return 0.0 if abs(lowest) < 0.1 * np.ptp(at[:, 1]) else lowest


def _slide(pair: _Pair) -> tuple[float | None, float | None]:
    """Mean speed of feet while the source's stand: the target's in metres per second, and the source's scaled to it."""
    soles = pair.soles()
    if not soles or len(pair.at) < 2:
        return None, None
    targets, sources = (list(joints) for joints in zip(*soles, strict=True))
    source_leg = _source_leg(pair)
    stands = planted(pair.source_at[:, sources], pair.rate, source_leg)
    if not stands.any():
        return None, None
    target, source = speed(pair.at[:, targets], pair.rate), speed(pair.source_at[:, sources], pair.rate)
    return float(target[stands].mean()), float(source[stands].mean() * pair.leg / source_leg)


def _source_leg(pair: _Pair) -> float:
    places = [pair.places((f"left {part}",)) for part in ("thigh", "shin", "foot")]
    known = [place[1] for place in places if place is not None]
    if len(known) < len(places):
        return pair.leg
    return float(np.linalg.norm(np.diff(known, axis=0), axis=-1).sum(axis=0).mean()) or pair.leg


def _limb_flaws(name: str, limbs: Mapping[str, float]) -> list[str]:
    wrong = {limb.replace("_", " "): angle for limb, angle in limbs.items() if angle > LIMB_BOUND}
    if not wrong:
        return []
    listed = ", ".join(f"{limb} {angle:.0f}" for limb, angle in sorted(wrong.items(), key=lambda item: -item[1]))
    return [f"{name}: limbs point elsewhere than in the motion (degrees: {listed})."]


def _facing_flaws(name: str, facing: float | None, source: float | None) -> list[str]:
    if facing is None or source is None or facing - source <= FACING_BOUND:
        return []
    return [f"{name}: the body faces {facing:.0f} degrees away from where it goes; in the motion it is {source:.0f}."]


def _floor_flaws(name: str, height: float | None, leg: float) -> list[str]:
    if height is None or -SUNK * leg <= height <= LIFTED * leg:
        return []
    where = "below" if height < 0 else "above"
    return [f"{name}: the feet are {abs(height):.2f} m {where} the floor."]


def _slide_flaws(name: str, slide: float | None, source: float | None, leg: float) -> list[str]:
    if slide is None or source is None or slide - source <= SLIDES * leg:
        return []
    return [f"{name}: standing feet slide at {slide:.2f} m/s; in the motion at {source:.2f}."]


def _unit(v: Array) -> Array:
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.where(length > 0, length, 1))


def _degrees(a: Array, b: Array) -> Array:
    """Angles [...] between vectors [..., 3]."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)))
