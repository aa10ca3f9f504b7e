"""The figure's clips: walk, turn, reach and dance. All of them loop; the walk travels."""

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton
from mua.teachers.procedural.grid import smoothstep
from mua.teachers.procedural.performance import SIDES, Arm, Foot, Performance, joint_rotations

RATE = 30.0  # frames per second
_STANCE = 0.075  # metres from the middle to a foot
_HIPS = 0.928  # metres, standing with soft knees
_HANGING, _HANGING_FORE = np.array([0.34, -1.0, -0.02]), np.array([0.24, -1.0, 0.22])


def _loop(keys: list[tuple[float, ...]], t: Array) -> Array:
    """Smooth periodic channels [F, n] through keys (time 0..1 ascending from 0, values)."""
    table = np.array([*keys, (1.0, *keys[0][1:])])
    return np.asarray(CubicSpline(table[:, 0], table[:, 1:], bc_type="periodic")(t % 1.0))


def _glide(keys: list[tuple[float, float]], t: Array) -> Array:
    """A channel [F] through keys (time, value) that rests at both ends."""
    table = np.array(keys)
    return np.asarray(PchipInterpolator(table[:, 0], table[:, 1])(t))


def _times(frames: int) -> Array:
    return np.arange(frames) / frames


def _degrees(*channels: Array | float) -> Array:
    """Angles [F, n] in radians from channels in degrees."""
    return np.radians(np.stack(np.broadcast_arrays(*channels), axis=-1).astype(float))


def _walking_foot(phase: Array, travel: Array, *, x: float, stride: float) -> Foot:
    """One foot of a walk; on the ground for the first 60 % of its phase [F] 0..1, `travel` [F] metres of the body."""
    on_ground, half = 0.6, 0.3 * stride
    swing = np.clip((phase - on_ground) / (1 - on_ground), 0, 1)
    ahead = np.where(phase < on_ground, half * (1 - 2 * phase / on_ground), -half + 2 * half * smoothstep(0, 1, swing))
    lift = 0.045 * np.sin(np.pi * swing) ** 2
    pitch = _loop([(0.0, -14), (0.1, 0), (0.25, 0), (0.4, 6), (0.6, 38), (0.72, 34), (0.88, -6)], phase)[:, 0]
    ground = np.stack([np.full_like(phase, x), lift, travel + ahead], axis=-1)
    toes = smoothstep(0.75, 0.6, phase)
    return Foot(ground, np.zeros_like(phase), np.radians(pitch), toes)


def _walk() -> Performance:
    """Three strides of a stroll along +Z, a second each."""
    strides, frames, stride = 3, 90, 0.9
    t = _times(frames)
    phase, travel = (strides * t) % 1.0, stride * strides * t
    wave, twice = 2 * np.pi * phase, 4 * np.pi * phase
    feet = tuple(
        _walking_foot((phase + late) % 1.0, travel, x=side * 0.062, stride=stride)
        for (_, side), late in zip(SIDES, (0.0, 0.5), strict=True)
    )
    arms = []
    for _, side in SIDES:
        swing = np.radians(4 - 24 * side * np.cos(wave - 0.2))
        elbow = swing + np.radians(24 - 12 * side * np.cos(wave - 0.5))
        upper = np.stack([np.full_like(swing, 0.30), -np.cos(swing), np.sin(swing)], axis=-1)
        arms.append(Arm(upper, np.stack([np.full_like(swing, 0.10), -np.cos(elbow), np.sin(elbow)], axis=-1)))
    sway = np.cos(wave - 0.6 * np.pi)  # to the standing leg
    return Performance(
        hips=np.stack([0.022 * sway, 0.902 - 0.011 * np.cos(twice), travel + 0.008 * np.sin(twice)], axis=-1),
        heading=np.zeros(frames),
        pelvis=_degrees(3.0, -7 * np.cos(wave), 3.5 * sway),
        spine=_degrees(1.0, 13 * np.cos(wave), -5 * sway),
        head=_degrees(-3 + np.cos(twice), -6 * np.cos(wave), 1.5 * sway),
        feet=(feet[0], feet[1]),
        arms=(arms[0], arms[1]),
    )


def _stepping_feet(heading: Array, *, steps: int, lift: float, heel: Array) -> tuple[Foot, Foot]:
    """Feet under a body that turns once on the spot: they take turns to follow its heading [F], `steps` in all.

    The right foot sets out with half a step and closes with another; `heel` [F] is the pitch in radians.
    """
    feet = []
    progress = heading / (2 * np.pi) * (steps + 1)
    for (_, side), late in zip(SIDES, (1, 0), strict=True):
        count = (progress - late) / 2
        part = count - np.floor(count)
        reached = np.clip(2 * (np.floor(count) + smoothstep(0, 0.5, part)) - (1 - late), 0, steps)
        follow = reached * 2 * np.pi / steps
        raised = lift * np.sin(np.pi * np.clip(part / 0.5, 0, 1)) ** 2
        out = side * _STANCE
        ground = np.stack([out * np.cos(follow), raised, -out * np.sin(follow)], axis=-1)
        feet.append(Foot(ground, follow + side * np.radians(7), heel, np.ones_like(heading)))
    return feet[0], feet[1]


def _turn() -> Performance:
    """A full turn on the spot in twelve small steps."""
    frames = 120
    t = _times(frames)
    heading = 2 * np.pi * smoothstep(0.06, 0.9, t)
    speed = np.gradient(heading) / np.gradient(heading).max()
    still = np.zeros(frames)
    rhythm = np.sin(heading * 6)
    lag = np.stack([0.12 * speed, still, 0.06 * speed], axis=-1)
    left = Arm(_HANGING + [0.28, 0, 0] * speed[:, None] + lag, _HANGING_FORE + [0.30, 0, 0.1] * speed[:, None] + lag)
    right = Arm(_HANGING + [0.28, 0, 0] * speed[:, None] - lag, _HANGING_FORE + [0.30, 0, 0.2] * speed[:, None])
    return Performance(
        hips=np.stack([0.012 * rhythm * speed, _HIPS - 0.012 * speed * np.abs(rhythm), still], axis=-1),
        heading=heading,
        pelvis=_degrees(1.0, still, 2 * rhythm * speed),
        spine=_degrees(2 * speed, 16 * speed, -3 * rhythm * speed),
        head=_degrees(-2.0, 26 * speed, 0.0),
        feet=_stepping_feet(heading, steps=12, lift=0.045, heel=still),
        arms=(left, right),
    )


def _standing_feet(heels: Array) -> tuple[Foot, Foot]:
    """Feet that stay where they are, heels [F, 2] raised in degrees."""
    feet = []
    for (_, side), heel in zip(SIDES, heels.T, strict=True):
        place = np.tile([side * 0.085, 0.0, 0.0], (len(heel), 1))
        pitch = np.radians(np.maximum(heel, 0))
        feet.append(Foot(place, np.full(len(heel), side * np.radians(8)), pitch, np.ones(len(heel))))
    return feet[0], feet[1]


def _reach() -> Performance:
    """The right hand reaches up high, then the left hand forward and low across the body."""
    t = _times(120)
    high = smoothstep(0.06, 0.24, t) * smoothstep(0.50, 0.34, t)
    low = smoothstep(0.48, 0.68, t) * smoothstep(0.98, 0.80, t)
    h, w = high[:, None], low[:, None]
    right = Arm(
        _HANGING + h * (np.array([0.62, 0.55, 0.55]) - _HANGING) + w * np.array([0.1, 0.1, -0.45]),
        _HANGING_FORE + h * (np.array([0.38, 0.95, 0.45]) - _HANGING_FORE) + w * np.array([0.1, 0.15, -0.25]),
    )
    left = Arm(
        _HANGING + h * np.array([0.25, 0.1, -0.15]) + w * (np.array([-0.05, -0.55, 0.9]) - _HANGING),
        _HANGING_FORE + h * np.array([0.2, 0.1, 0.1]) + w * (np.array([-0.35, -0.35, 0.9]) - _HANGING_FORE),
    )
    return Performance(
        hips=np.stack(
            [-0.035 * high + 0.015 * low, _HIPS + 0.012 * high - 0.065 * low, 0.02 * high - 0.05 * low], axis=-1
        ),
        heading=np.zeros(len(t)),
        pelvis=_degrees(-2 * high + 12 * low, 6 * high - 10 * low, -5 * high + 2 * low),
        spine=_degrees(-8 * high + 24 * low, 14 * high - 24 * low, 9 * high),
        head=_degrees(-20 * high + 2 * low, -12 * high - 8 * low, 3 * high),
        feet=_standing_feet(np.stack([18 * high, 4 * high], axis=-1)),
        arms=(left, right),
    )


def _dance() -> Performance:
    """Two swaying steps, a twirl with the arms up, and back to the first pose."""
    t = _times(120)
    heading = np.radians(_glide([(0, 0), (0.30, 0), (0.76, 360), (1, 360)], t))
    spin = smoothstep(0.28, 0.40, t) * smoothstep(0.84, 0.70, t)
    sway, dip = _loop([(0, 0, 0), (0.09, 1, 1), (0.17, 0.1, 0.2), (0.26, -1, 1), (0.36, 0, 0.3), (0.5, 0, 0),
                       (0.62, 0, 0), (0.78, 0, 0.3), (0.88, 0.3, 0.7)], t).T  # fmt: skip
    still = np.zeros(len(t))
    heel = np.radians(24 * spin)
    arms = []
    for _, side in SIDES:
        lead = np.clip(side * sway, -1, 1)[:, None]
        open_, up = np.array([1.0, -0.35, 0.25]), np.array([1.0, 0.45, 0.25])
        open_fore, up_fore = np.array([0.85, -0.2, 0.45]), np.array([0.25, 1.0, 0.3])
        s = spin[:, None]
        upper = (1 - s) * (open_ + lead * [0, 0.35, 0]) + s * up
        fore = (1 - s) * (open_fore + lead * [0.2, 0.45, -0.1]) + s * up_fore
        arms.append(Arm(upper, fore))
    hips = np.stack([0.075 * sway, _HIPS - 0.045 * dip + 0.03 * spin, still], axis=-1)
    return Performance(
        hips=hips,
        heading=heading,
        pelvis=_degrees(2.0, 10 * sway, -4 * sway),
        spine=_degrees(-3 - 4 * spin, -8 * sway, -12 * sway),
        head=_degrees(-4.0, 10 * sway + 22 * spin * (1 - 2 * smoothstep(0.45, 0.65, t)), 8 * sway),
        feet=_stepping_feet(heading, steps=8, lift=0.03, heel=heel),
        arms=(arms[0], arms[1]),
    )


def build_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """The figure's clips, 3 or 4 seconds each."""
    acts = {"walk": _walk(), "turn": _turn(), "reach": _reach(), "dance": _dance()}
    return tuple(
        Clip(name, RATE, joint_rotations(skeleton, act), skeleton.with_root(act.hips)) for name, act in acts.items()
    )
