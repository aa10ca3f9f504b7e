"""A performance given by hips, trunk, feet on the ground and directions of the arms, turned into joint rotations."""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.skeleton import Skeleton
from mua.teachers.procedural.grid import smoothstep
from mua.teachers.procedural.joints import ARM_DIRECTION, INDEX, PLACES

X, Y, Z = np.eye(3)
SIDES = (("Left", 1.0), ("Right", -1.0))
STRAIGHTEST = 0.9995  # share of a leg's length that a step may use

_HEEL = np.array([0.0, -0.085, -0.05])  # from the ankle, metres
_BALL = PLACES["LeftToeBase"] - PLACES["LeftFoot"]
_BALL_ON_GROUND = np.array([0.0, -0.085, _BALL[2]])


@dataclass(frozen=True, eq=False)
class Foot:
    """Where a foot treads, frame by frame."""

    ground: Array  # [F, 3] the point below the ankle if the foot lay flat, metres
    heading: Array  # [F] radians about Y
    pitch: Array  # [F] radians, positive with the heel up: it rolls over the ball, else over the heel
    toes_flat: Array  # [F] 0..1 how much the toes keep to the ground while the heel is up


@dataclass(frozen=True, eq=False)
class Arm:
    """Directions in the frame of the chest, x outward for either side; need not be unit."""

    upper: Array  # [F, 3]
    fore: Array  # [F, 3]


@dataclass(frozen=True, eq=False)
class Performance:
    """All that a clip shows; angles in radians: lean (about X, forward), twist (Y, to the left), tilt (Z)."""

    hips: Array  # [F, 3] metres
    heading: Array  # [F]
    pelvis: Array  # [F, 3]
    spine: Array  # [F, 3] shared by the three joints of the spine
    head: Array  # [F, 3] shared by neck and head
    feet: tuple[Foot, Foot]  # left, right
    arms: tuple[Arm, Arm]  # left, right


def _turned(angles: Array) -> Array:
    """Rotations [F, 4]: twist after tilt after lean."""
    lean, twist, tilt = np.moveaxis(angles, -1, 0)
    turn = rotation.multiply(rotation.from_axis_angle(Z, tilt), rotation.from_axis_angle(X, lean))
    return rotation.multiply(rotation.from_axis_angle(Y, twist), turn)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))


def _aimed(bone: Array, along: Array, ahead: Array) -> Array:
    """World rotations [F, 4] that turn a `bone` [3] of the bind pose to `along` [F, 3], its front to `ahead` [F, 3]."""

    def frame(d: Array, f: Array) -> Array:
        d = _unit(d)
        side = _unit(np.cross(d, f))
        return np.stack([d, side, np.cross(d, side)], axis=-1)

    return rotation.from_matrix(frame(along, ahead) @ frame(bone, Z).T)


def _knee(hip: Array, ankle: Array, ahead: Array, *, thigh: float, shin: float) -> Array:
    """Knees [F, 3] of legs from `hip` to `ankle` [F, 3] that bend toward `ahead`."""
    reach = ankle - hip
    distance = np.linalg.norm(reach, axis=-1, keepdims=True)
    axis = reach / distance
    foot = (thigh**2 - shin**2 + distance**2) / (2 * distance)
    bend = _unit(ahead - np.sum(ahead * axis, axis=-1, keepdims=True) * axis)
    return np.asarray(hip + foot * axis + np.sqrt(np.maximum(thigh**2 - foot**2, 0)) * bend)


def _ankle(foot: Foot, turn: Array) -> Array:
    """Ankles [F, 3] of feet rolled by their pitch over heel or ball; `turn` [F, 4] is the foot's world rotation."""
    pivot = np.where(foot.pitch[:, None] > 0, _BALL_ON_GROUND, _HEEL)
    yaw = rotation.from_axis_angle(Y, foot.heading)
    above = PLACES["LeftFoot"][1] * Y
    return np.asarray(foot.ground + above + rotation.rotate(yaw, pivot) - rotation.rotate(turn, pivot))


def _tread(local: Array, side: str, foot: Foot, hips: tuple[Array, Array]) -> None:
    """Fill in the leg's rotations in `local` [F, J, 4]; hips given as world rotation [F, 4] and position [F, 3]."""
    names = [side + name for name in ("UpLeg", "Leg", "Foot", "ToeBase")]
    upper, lower = PLACES[names[1]] - PLACES[names[0]], PLACES[names[2]] - PLACES[names[1]]
    thigh, shin = float(np.linalg.norm(upper)), float(np.linalg.norm(lower))
    turn = rotation.multiply(rotation.from_axis_angle(Y, foot.heading), rotation.from_axis_angle(X, foot.pitch))
    hip = hips[1] + rotation.rotate(hips[0], PLACES[names[0]] - PLACES["Hips"])
    reach = _ankle(foot, turn) - hip
    distance = np.linalg.norm(reach, axis=-1, keepdims=True)
    ankle = hip + reach * np.minimum(1, STRAIGHTEST * (thigh + shin) / distance)
    ahead = rotation.rotate(hips[0], Z) + rotation.rotate(rotation.from_axis_angle(Y, foot.heading), Z)
    knee = _knee(hip, ankle, ahead, thigh=thigh, shin=shin)
    worlds = [hips[0], _aimed(upper, knee - hip, ahead), _aimed(lower, ankle - knee, ahead), turn]
    for name, parent, world in zip(names, worlds, worlds[1:], strict=False):
        local[:, INDEX[name]] = rotation.multiply(rotation.conjugate(parent), world)
    local[:, INDEX[names[3]]] = rotation.from_axis_angle(X, -np.maximum(foot.pitch, 0) * foot.toes_flat)


def _gesture(local: Array, side: str, arm: Arm, outward: float) -> None:
    """Fill in the arm's rotations; the collar bone follows a raised arm."""
    flip = np.array([outward, 1, 1])
    bone, upper, fore = ARM_DIRECTION * flip, _unit(arm.upper * flip), _unit(arm.fore * flip)
    raised = 0.35 * smoothstep(-0.5, 1.2, upper[:, 1])
    collar = rotation.from_axis_angle(Z, outward * raised)
    shoulder = rotation.between(bone, rotation.rotate(rotation.conjugate(collar), upper))
    turned = rotation.multiply(collar, shoulder)
    local[:, INDEX[f"{side}Shoulder"]] = collar
    local[:, INDEX[f"{side}Arm"]] = shoulder
    local[:, INDEX[f"{side}ForeArm"]] = rotation.between(bone, rotation.rotate(rotation.conjugate(turned), fore))


def _steady(rotations: Array) -> Array:
    """Rotations [F, J, 4] whose signs do not jump between q and -q."""
    flips = np.where(np.sum(rotations[1:] * rotations[:-1], axis=-1) < 0, -1.0, 1.0)
    rotations[1:] *= np.cumprod(flips, axis=0)[..., None]
    return rotations


def joint_rotations(skeleton: Skeleton, performance: Performance) -> Array:
    """Local rotations [F, J, 4] of a performance; its hips are the root's translation."""
    local = np.tile(skeleton.bind_rotations, (len(performance.hips), 1, 1))
    yaw = rotation.from_axis_angle(Y, performance.heading)
    hips = rotation.multiply(yaw, _turned(performance.pelvis))
    local[:, INDEX["Hips"]] = hips
    for name in ("Spine", "Spine1", "Spine2"):
        local[:, INDEX[name]] = _turned(performance.spine / 3)
    for name in ("Neck", "Head"):
        local[:, INDEX[name]] = _turned(performance.head / 2)
    for (side, outward), foot, arm in zip(SIDES, performance.feet, performance.arms, strict=True):
        _tread(local, side, foot, (hips, performance.hips))
        _gesture(local, side, arm, outward)
    return _steady(local)
